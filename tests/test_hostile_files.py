"""A result file may be damaged, or made by anybody: it is read, or refused in one line; nothing else happens."""

from __future__ import annotations

import os
import random
import struct
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from command_line import assert_refused
from hostile_files import MUTATIONS, mutant

from painleve.asymptotics.sample import SampleOptions
from painleve.cli import main
from painleve.cli.plot import answering_for
from painleve.dynamics.simulate import simulate
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.plotting.draw import DRAWINGS
from painleve.store import contents, load, read, save
from painleve.store.contents import read_contents
from painleve.sweep import map_gamma, map_regimes, sweep_distances, sweep_members
from painleve.sweep.friction_map import map_friction
from painleve.sweep.trajectories import trajectory_dataset

ROD, WORN = load_scene("slender_rod"), load_scene("worn_tip_rod")
FEW = SampleOptions(samples=2048)
STATES = ("sliding", "isolated")
MUTANTS = 12 * len(MUTATIONS)


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """A sound file of every kind."""
    axes = {"theta": np.linspace(0.2, 1.5, 12), "omega": np.linspace(0.0, 6.0, 10)}
    datasets = {
        "distances": sweep_distances(WORN, eps=(1e-1, 1e-2), states=STATES, over={"mu_0": ["1", "2"]}, options=FEW),
        "members": sweep_members(WORN, eps=(1e-1, 1e-2), states=STATES, options=FEW),
        "gamma_map": map_gamma(WORN, states=STATES, points=(15, 9)),
        "regimes": map_regimes(ROD, axes=axes, parameters={"mu": 2}),
        "friction_map": map_friction(ROD, {"theta": np.linspace(0.1, 1.5, 12), "mu": np.linspace(0.5, 2.0, 4)}),
        "trajectory": trajectory_dataset(simulate(make_state(ROD, "stoss"), step=1e-2, until=0.9)),
    }
    folder = tmp_path_factory.mktemp("sound")
    return [save(dataset, folder / f"{name}.h5") for name, dataset in datasets.items()]


@pytest.fixture
def within(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files are looked at in this process: the same function as in a process of its own, and faster."""
    monkeypatch.setattr(read, "_look_at", read_contents)


def test_a_sound_file_of_every_kind_is_drawn(sound: list[Path]) -> None:
    for path in sound:
        dataset = load(path)
        DRAWINGS[dataset.attrs["kind"]](dataset)


@pytest.mark.allow_fp_errors
def test_every_mutated_file_gives_a_figure_or_one_line(sound: list[Path], tmp_path: Path, within: None) -> None:
    drawn, refused = 0, list[str]()
    for seed in range(MUTANTS):
        path, mutation = mutant(sound[seed // len(MUTATIONS) % len(sound)], tmp_path, seed)
        try:
            dataset = load(path)
            with answering_for(path):
                DRAWINGS[dataset.attrs["kind"]](dataset)
            drawn += 1
        except InputError as error:
            refused.append(str(error))
        except Exception as error:
            raise AssertionError(f"mutation {mutation}, seed {seed}, of {path.name}") from error
        path.unlink()
    assert drawn + len(refused) == MUTANTS
    assert min(drawn, len(refused)) > MUTANTS / 10  # to destroy everything, or nothing, would test little
    assert not any("\n" in line or len(line) > 1000 for line in refused)


MUST_BE_REFUSED = (
    *("to_references", "to_enumeration", "bomb", "to_group", "soft_link", "external_link", "circle"),
    *("external_data", "virtual", "reference_attribute", "many_attributes"),
)


@pytest.mark.parametrize("name", MUST_BE_REFUSED)
def test_what_is_no_plain_variable_in_the_file_itself_is_never_used(
    name: str, sound: list[Path], tmp_path: Path, within: None
) -> None:
    first = [mutation.__name__ for mutation in MUTATIONS].index(name)
    for k, source in enumerate(sound):
        path, mutation = mutant(source, tmp_path, first + k * len(MUTATIONS))
        assert mutation == name
        with pytest.raises(InputError):
            load(path)


def test_a_link_to_a_pipe_in_another_file_is_not_followed(
    sound: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the process of its own, as a user meets it."""
    path, _ = mutant(sound[0], tmp_path, [m.__name__ for m in MUTATIONS].index("external_link"))
    began = time.monotonic()
    line = assert_refused(["plot", str(path)], capsys, tmp_path, monkeypatch)
    assert "is a link" in line
    assert time.monotonic() - began < 60.0  # it would wait for ever


def test_a_pipe_a_folder_and_a_device_are_no_files(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for place in (pipe, tmp_path, Path("/dev/zero")):
        with pytest.raises(InputError, match="is not a file"):
            load(place)


@pytest.mark.parametrize("megabytes", [1, 10])
def test_an_attribute_of_many_megabytes_is_refused_at_once(megabytes: int, sound: list[Path], tmp_path: Path) -> None:
    path, _ = mutant(sound[-1], tmp_path, 0)
    with h5py.File(path, "r+") as file:
        file.attrs["scene"] = "x" * (megabytes << 20)
    with pytest.raises(InputError, match="attribute scene is too long"):
        load(path)


def heap(content: bytes) -> int:
    """Where the texts of an HDF5 file begin."""
    return content.index(b"GCOL") + 16


def without_seal(path: Path) -> bytes:
    content = path.read_bytes()
    return content[: content.rindex(b"\npainleve sha256 ")]


def test_a_file_over_which_the_hdf5_library_loops_for_ever_is_refused(sound: list[Path], tmp_path: Path) -> None:
    content = bytearray(without_seal(sound[0]))
    place = heap(content)
    (size,) = struct.unpack_from("<Q", content, place + 8)
    struct.pack_into("<HHIQ", content, place + 16 + (size + 7) // 8 * 8, 0, 0, 0, 0)  # a text of no size at all
    path = tmp_path / "loop.h5"
    path.write_bytes(content)
    with pytest.raises(InputError, match="takes too long"):
        load(path)


def test_a_text_that_claims_gigabytes_is_refused(sound: list[Path], tmp_path: Path) -> None:
    """The library believes the length that stands with a text, and makes room for it."""
    content = bytearray(without_seal(sound[0]))
    with h5py.File(sound[0]) as file:
        place = file["state"].id.get_offset()
    assert struct.unpack_from("<I", content, place)[0] == len(b"sliding")
    struct.pack_into("<I", content, place, 2**32 - 1)
    path = tmp_path / "claims.h5"
    path.write_bytes(content)
    with pytest.raises(InputError):
        load(path)


def test_a_flip_of_any_bit_of_a_sealed_file_is_seen_before_it_is_read(sound: list[Path], tmp_path: Path) -> None:
    content, path = sound[-1].read_bytes(), tmp_path / "flipped.h5"
    end, chance = len(without_seal(sound[-1])), random.Random(7)
    for place in [chance.randrange(end) for _ in range(100)] + [0, end - 1]:
        path.write_bytes(content[:place] + bytes([content[place] ^ (1 << place % 8)]) + content[place + 1 :])
        with pytest.raises(InputError, match="was damaged after it was written"):
            load(path)


def test_a_file_without_a_seal_is_read_as_it_stands(sound: list[Path], tmp_path: Path) -> None:
    """Of an earlier version, or changed on purpose: HDF5 drops the seal of a file that is changed in place."""
    for path in sound:
        bare = tmp_path / path.name
        bare.write_bytes(without_seal(path))
        assert load(bare).identical(load(path))
    bare.write_bytes(sound[-1].read_bytes())
    with h5py.File(bare, "r+") as file:
        file.attrs["title"] = "Another title"
    assert load(bare).attrs["title"] == "Another title"


@pytest.mark.slow
def test_flips_in_a_file_without_a_seal_crash_nothing(sound: list[Path], tmp_path: Path) -> None:
    """Each is looked at by a process of its own, which may crash; this one never does."""
    path, refused = tmp_path / "flipped.h5", 0
    for seed in range(16):
        chance, content = random.Random(seed), bytearray(without_seal(sound[seed % len(sound)]))
        for _ in range(4):
            content[chance.randrange(min(8192, len(content)))] ^= 1 << chance.randrange(8)
        path.write_bytes(content)
        try:
            load(path)
        except InputError:
            refused += 1
    assert refused > 4


def test_values_of_which_nothing_can_be_drawn_give_one_line(
    sound: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    dataset = load(sound[2])
    dataset["own_friction"].values[:] = np.nan
    path = save(dataset, tmp_path / "map.h5")
    line = assert_refused(["plot", str(path)], capsys, tmp_path, monkeypatch)
    assert "no figure can be drawn" in line


def test_a_figure_of_numbers_that_overflow_comes_with_one_line(
    sound: list[Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    dataset = load(sound[1])
    dataset["along"].values[:] = 1e308
    path = save(dataset, tmp_path / "members.h5")
    with np.errstate(all="warn"):
        assert main(["plot", str(path)]) == 0
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "may not show" in said


def test_more_than_half_of_the_memory_is_not_asked_for(
    sound: list[Path], monkeypatch: pytest.MonkeyPatch, within: None
) -> None:
    monkeypatch.setattr(contents, "MOST_OF_MEMORY", 1e-12)
    monkeypatch.setattr(read, "_trusted", set())
    with pytest.raises(InputError, match="more than half of this machine's memory"):
        load(sound[0])
