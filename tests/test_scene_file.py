"""A user's own scene: a file says what the library would say, and is usable wherever the name of a scene is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from command_line import assert_refused, run_json
from scene_files import TEMPLATE, read, spatial

import painleve
from painleve.errors import InputError
from painleve.kernels.motion.source import motion_source
from painleve.kernels.rows import rows_of
from painleve.kernels.source import scene_source
from painleve.mechanics.derive import derive
from painleve.mechanics.friction import Disc, Ellipse, NoFriction, Polygon, Segment
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

# --- what a file says ------------------------------------------------------------------------------------------------


@pytest.fixture
def rod(tmp_path: Path) -> Path:
    path = tmp_path / "rod.toml"
    path.write_text(TEMPLATE)
    return path


def test_the_slender_rod_as_a_file_is_the_library_s(rod):
    """M, g, H, f, gamma and the parameters; and the object is the same until the file changes."""
    own, library = load_scene(rod), load_scene("slender_rod")
    assert (own.inertia, own.force, own.contact.constraint) == (
        library.inertia,
        library.force,
        library.contact.constraint,
    )
    assert (own.contact.tangents, own.contact.section, own.velocity) == (
        library.contact.tangents,
        library.contact.section,
        library.velocity,
    )
    assert derive(own).gamma == derive(library).gamma
    assert [(p.name, p.unit, p.range, p.latex) for p in own.parameters] == [
        (p.name, p.unit, p.range, p.latex) for p in library.parameters
    ]
    assert load_scene(rod) is own
    rod.write_text(TEMPLATE.replace("m*l**2/3", "m*l**2/4"))
    assert load_scene(rod).parameter("I").default == "m*l**2/4"


@pytest.mark.parametrize(
    ("name", "given"),
    [
        ("sliding", {}),
        ("paradox", {}),
        ("critical", {}),
        ("critical", {"mu": "1333334/1000000"}),
        ("paradox", {"I": "m"}),
        ("paradox", {"l": "3/2"}),
    ],
)
def test_a_state_of_the_file_is_classified_as_the_library_classifies_it(name, given, rod):
    theirs = {"sliding": "sliding", "paradox": "paradox", "critical": "double_zero"}[name]
    given = {k: v.replace("m", "1") for k, v in given.items()}
    own = painleve.classify(make_state(load_scene(rod), name, parameters=given))
    library = painleve.classify(make_state(load_scene("slender_rod"), theirs, parameters=given))
    assert (own.branch, own.reason) == (library.branch, library.reason)
    assert np.array_equal(own.limit.u_plus, library.limit.u_plus)


def test_the_kernels_of_the_file_are_the_library_s_to_the_letter(rod):
    """Equal source compiles to equal functions: the law S and the motion agree bit for bit."""
    scenes = (load_scene(rod), load_scene("slender_rod"))
    laws = [scene_source(scene, rows_of(derive(scene)), derive(scene).shape) for scene in scenes]
    motions = [motion_source(scene, rows_of(derive(scene))) for scene in scenes]
    for own, library in (laws, motions):
        assert own.replace("scene my_rod,", "scene slender_rod,") == library


MU = sp.Symbol("mu", real=True)
SECTIONS = {
    'kind = "disc"\nmu = "mu"': Disc(mu=MU),
    'kind = "ellipse"\nmu_1 = "mu"\nmu_2 = "mu/2"\nangle = "pi/6"': Ellipse(mu_1=MU, mu_2=MU / 2, angle=sp.pi / 6),
    'kind = "polygon"\nvertices = [["mu", 0], [0, "mu"], ["-mu", 0.0], [0, "-mu"]]': Polygon(
        vertices=((MU, 0), (0, MU), (-MU, 0), (0, -MU))
    ),
}


@pytest.mark.parametrize(("text", "section"), SECTIONS.items(), ids=["disc", "ellipse", "polygon"])
def test_a_scene_in_space_reads_with_every_friction_section(text, section):
    scene, library = read(spatial(text)), load_scene("spatial_rod")
    assert scene.contact.section == section
    assert (scene.inertia, scene.force, scene.contact.constraint) == (
        library.inertia,
        library.force,
        library.contact.constraint,
    )
    assert scene.contact.tangents == library.contact.tangents


def test_the_rod_in_space_as_a_file_has_the_gamma_and_the_critical_friction_of_the_library(rod):
    scene, library = read(spatial('kind = "disc"\nmu = "mu"')), load_scene("spatial_rod")
    assert derive(scene).gamma == derive(library).gamma
    assert derive(scene).critical_friction == derive(library).critical_friction


def test_a_segment_may_be_asymmetric_and_friction_may_be_absent():
    skew = TEMPLATE.replace('mu = "mu"', 'minus = "mu"\nplus = "2*mu"')
    assert read(skew).contact.section == Segment(minus=MU, plus=2 * MU)
    bare = TEMPLATE.replace('kind = "segment"\nmu = "mu"', 'kind = "none"')
    displacement = 'tangential_displacements = "x - l*cos(theta)"'
    assert read(bare.replace(displacement, "")).contact.section == NoFriction()
    with pytest.raises(InputError, match="there is 1 tangential displacement; without friction the contact needs none"):
        read(bare)


def test_the_ways_to_give_inertia_force_and_contact_agree():
    other = (
        TEMPLATE.replace("kinetic_energy = ", "# ")
        .replace("# M = ", "M = ")
        .replace("potential = ", "# ")
        .replace("# force = ", "force = ")
        .replace('height = "y - l*sin(theta)"', 'g = "l*sin(theta) - y"')
    )
    first, second = read(TEMPLATE), read(other)
    assert (first.inertia, first.force, first.contact.constraint) == (
        second.inertia,
        second.force,
        second.contact.constraint,
    )


def test_numbers_of_a_file_are_exact():
    scene = read(TEMPLATE.replace("default = 9.81", "default = 1_0.1e-1"))
    assert make_state(scene, "sliding").parameters["gravity"] == sp.Rational(101, 100)


def test_parameters_that_the_contact_fixes_and_keys_that_are_coordinates_need_one_rule_each():
    text = TEMPLATE.replace("[states.sliding]", '[contact_parameters]\ngravity = "omega + 7"\n\n[states.sliding]')
    state = make_state(read(text), "sliding", keys={"omega": "3"})
    assert state.parameters["gravity"] == 10
    assert state.q[2] == sp.atan(2)


def test_a_state_that_the_mechanics_refuses_names_the_line_of_the_state():
    line = next(i for i, row in enumerate(TEMPLATE.splitlines(), 1) if row == "[states.paradox]")
    off = TEMPLATE.replace('y = "l*sin(theta)"', 'y = "l*sin(theta) + 1/8"')
    with pytest.raises(InputError, match=rf"^rod\.toml, line {line}, states\.paradox: .*off the constraint.*-0\.125"):
        make_state(read(off), "paradox")
    with pytest.raises(InputError, match=r"^rod\.toml: scene my_rod: parameter m = -1 must be positive"):
        make_state(read(TEMPLATE), keys={"theta": 1}, parameters={"m": -1})


# --- usable wherever the name of a scene is --------------------------------------------------------------------------


def test_new_scene_writes_a_file_that_classifies_and_simulates_and_never_replaces_one(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run_json(capsys, "new-scene", "my_rod") == {"file": "my_rod.toml"}
    branches = {"sliding": "none", "paradox": "negative", "critical": "critical_approached"}
    for state, branch in branches.items():
        assert run_json(capsys, "classify", "my_rod.toml", "--state", state)["branch"] == branch
    answer = run_json(capsys, "simulate", "my_rod.toml", "--state", "sliding", "--step", "1e-2", "--until", "0.1")
    assert answer["steps"] == 10
    assert "my_rod" in run_json(capsys, "scenes", "my_rod.toml")
    before = Path("my_rod.toml").read_bytes()
    assert "exists" in assert_refused(["new-scene", "my_rod"], capsys, tmp_path, monkeypatch)
    assert Path("my_rod.toml").read_bytes() == before
    for words in (["lambda"], ["../x"], ["a b"], ["x", "-o", "x.txt"], ["x", "-o", "no/x.toml"]):
        assert_refused(["new-scene", *words], capsys, tmp_path, monkeypatch)


def test_a_dataset_keeps_the_text_of_its_scene_from_which_the_scene_is_read_again(rod, tmp_path, capsys):
    words = ["simulate", str(rod), "--state", "sliding", "--step", "1e-2", "--until", "0.1"]
    run_json(capsys, *words, "-o", str(tmp_path / "motion.h5"))
    rod.unlink()
    dataset = painleve.load(tmp_path / "motion.h5")
    assert run_json(capsys, "plot", str(tmp_path / "motion.h5"))["file"] == str(tmp_path / "motion.png")
    (tmp_path / "again.toml").write_text(dataset.attrs["scene_text"])
    assert dataset.attrs["scene_file"] == str(rod)
    assert load_scene(tmp_path / "again.toml").inertia == load_scene("slender_rod").inertia


@pytest.mark.parametrize(("table", "name", "before"), [("parameters", "theta", "gravity"), ("keys", "mu", "slip")])
def test_a_name_that_is_declared_twice_is_refused_on_the_second_line(table, name, before):
    again = f'{name} = {{ unit = "1", sentence = "again", default = 1 }}'
    text = TEMPLATE.replace(f"{before} = {{", f"{again}\n{before} = {{")
    line = text.splitlines().index(again) + 1
    with pytest.raises(InputError, match=rf"^rod\.toml, line {line}, {table}\.{name}: this name is declared twice"):
        read(text)
