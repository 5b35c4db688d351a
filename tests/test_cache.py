"""What stands in the cache never changes a result: damaged, planted by another user, or on a disk that is full."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import pytest
from command_line import run_json
from numba.core.registry import cpu_target
from small_disk import NOBODY, need_root, small_disk

from painleve._jit import CACHE, old_folders
from painleve._jit.code_cache import DIGEST_BYTES, CodeCache
from painleve._jit.folder import CacheFolder, choose_folder
from painleve._jit.old_folders import DAY, remove_old_folders

PLUS = """
from painleve._jit import jit

@jit
def helper(x):
    return 2.0 * x

@jit
def f(x):
    return helper(x) + 1.0
"""
RUN = """
import os, sys
{before}
from painleve.kernels.files import load_generated
module, _, path = load_generated("tiny", {text!r})
print(module.f(3.0))
print(path)
"""


def run(text: str, cache: Path | None, *, before: str = "", **environment: str) -> tuple[float, Path, list[str]]:
    """(value of the generated function at 3, its file, lines on stderr) in a process with its own cache."""
    kept = {k: v for k, v in os.environ.items() if k not in {"PAINLEVE_CACHE_DIR", "XDG_CACHE_HOME", "HOME", "TMPDIR"}}
    if cache is not None:
        kept["PAINLEVE_CACHE_DIR"] = str(cache)
    code = RUN.format(before=before, text=text)
    done = subprocess.run(
        [sys.executable, "-c", code], check=False, capture_output=True, text=True, env={**kept, **environment}
    )
    assert done.returncode == 0, done.stderr
    value, path = done.stdout.splitlines()
    return float(value), Path(path), done.stderr.splitlines()


@pytest.fixture(scope="module")
def filled(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache that a process left."""
    cache = tmp_path_factory.mktemp("filled") / "cache"
    assert run(PLUS, cache)[::2] == (7.0, [])
    return cache


@pytest.fixture
def cache(filled: Path, tmp_path: Path) -> Path:
    """A copy of it, to damage."""
    return Path(shutil.copytree(filled, tmp_path / "cache"))


def files(folder: Path, ending: str) -> list[Path]:
    return sorted(p for p in folder.rglob(f"*{ending}"))


def test_a_second_process_finds_all_that_the_first_one_compiled(cache: Path) -> None:
    (path,) = files(cache, ".py")
    assert path.read_text() == PLUS
    kept = {p: p.stat().st_mtime_ns for p in files(cache, ".nbc")}
    assert len(kept) == 2
    assert run(PLUS, cache) == (7.0, path, [])
    assert {p: p.stat().st_mtime_ns for p in files(cache, ".nbc")} == kept
    assert {p.stat().st_mode & 0o777 for p in (cache, path.parent)} == {0o700}


def test_a_changed_sign_in_a_generated_file_changes_no_result_and_is_said_and_repaired(cache: Path) -> None:
    (path,) = files(cache, ".py")
    path.write_text(PLUS.replace("+", "-"))
    value, _, said = run(PLUS, cache)
    assert value == 7.0
    assert len(said) == 1
    assert "changed or damaged" in said[0]
    assert path.read_text() == PLUS


def test_a_changed_sign_in_a_scene_of_the_library_leaves_its_distance_as_it_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ("distance", "slender_rod", "--state", "paradox", "--eps", "1e-2", "--samples", "1e4")
    expected = run_json(capsys, *words)
    assert CACHE.path is not None
    shutil.copytree(CACHE.path, tmp_path / CACHE.path.name)
    for path in files(tmp_path, ".py"):
        if path.name.startswith("scene_slender_rod_"):
            path.write_text(path.read_text().replace(" + ", " - "))
    code = "import sys; from painleve.cli import main; sys.exit(main())"
    environment = {**os.environ, "PAINLEVE_CACHE_DIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code, *words, "--json"], check=False, capture_output=True, text=True, env=environment
    )
    assert json.loads(done.stdout) == expected
    assert done.stderr.count("\n") == 1
    assert "changed or damaged" in done.stderr


def test_damaged_compiled_code_is_compiled_anew_with_one_line(cache: Path) -> None:
    sound = {path: path.read_bytes() for path in files(cache, ".nbc")}
    first, second = sound
    first.write_bytes(sound[first][: len(sound[first]) // 2])
    second.write_bytes(sound[second][:-9] + b"?" + sound[second][-8:])
    value, _, said = run(PLUS, cache)
    assert value == 7.0
    assert len(said) == 1
    assert "damaged" in said[0]
    assert files(cache, ".nbc") == [first, second]
    for path in sound:
        again = path.read_bytes()
        assert hashlib.sha256(again[DIGEST_BYTES:]).digest() == again[:DIGEST_BYTES]


def doubled(x: float) -> float:
    return 2.0 * x


def make_cache(folder: Path, function: Callable[..., Any] = doubled) -> tuple[CodeCache, Any]:
    """A cache that holds a compiled function for one float, and that float's signature."""
    folder.mkdir(mode=0o700, exist_ok=True)
    dispatcher = numba.njit(function)
    dispatcher._cache = cache = CodeCache(function, CacheFolder(folder))
    dispatcher(1.0)
    return cache, (numba.float64,)


def test_a_flip_of_any_bit_is_seen_before_anything_is_unpickled(tmp_path: Path) -> None:
    cache, signature = make_cache(tmp_path / "c")
    (path,) = files(tmp_path, ".nbc")
    content = path.read_bytes()
    target = cpu_target.target_context
    assert cache.load_overload(signature, target) is not None
    for place in {*range(0, len(content), 97), 0, DIGEST_BYTES - 1, DIGEST_BYTES, len(content) - 1}:
        path.write_bytes(content[:place] + bytes([content[place] ^ (1 << place % 8)]) + content[place + 1 :])
        assert cache.load_overload(signature, target) is None
    for size in (0, 1, DIGEST_BYTES - 1, DIGEST_BYTES, DIGEST_BYTES + 1, len(content) - 1):
        path.write_bytes(content[:size])
        assert cache.load_overload(signature, target) is None


def test_the_same_name_in_an_edited_file_is_another_function(tmp_path: Path) -> None:
    """A module that is edited and loaded again in one process does not get the code of its old text."""
    source, names = tmp_path / "edited.py", set()
    for text in (PLUS, PLUS.replace("+", "-")):
        source.write_text(text)
        module: dict[str, Any] = {"__name__": "edited"}
        exec(compile(text, str(source), "exec"), module)
        cache = CodeCache(module["f"].py_func, CacheFolder(tmp_path))
        names.add(cache._name((numba.float64,), cpu_target.target_context.codegen()))
    assert len(names) == 2


class Trap:
    """Unpickled, it makes a folder."""

    def __init__(self, place: Path) -> None:
        self.place = place

    def __reduce__(self) -> tuple[Callable[..., object], tuple[str]]:
        return os.mkdir, (str(self.place),)


def plant(cache: Path, place: Path) -> None:
    """In the place of all compiled code, a trap with the right digest, which makes a folder when it is loaded."""
    payload = pickle.dumps(Trap(place))
    for path in files(cache, ".nbc"):
        path.write_bytes(hashlib.sha256(payload).digest() + payload)


def test_the_trap_of_these_tests_is_one(tmp_path: Path) -> None:
    cache, signature = make_cache(tmp_path / "c")
    plant(tmp_path / "c", tmp_path / "sprung")
    with pytest.raises(TypeError):
        cache.load_overload(signature, cpu_target.target_context)
    assert (tmp_path / "sprung").exists()


@pytest.mark.parametrize("whose", ["root", "digest folder", "files"])
def test_what_another_user_planted_is_not_run(whose: str, cache: Path, tmp_path: Path) -> None:
    need_root()
    plant(cache, tmp_path / "sprung")
    (source,) = files(cache, ".py")
    for given in {"root": [cache], "digest folder": [source.parent], "files": files(cache, ".nbc")}[whose]:
        os.chown(given, NOBODY, NOBODY)
    value, _, said = run(PLUS, cache, HOME=str(tmp_path / "home"))
    assert value == 7.0
    assert len(said) == 1
    assert "belongs to another user" in said[0]
    assert not (tmp_path / "sprung").exists()


def test_a_second_user_who_prepares_the_cache_folder_gets_nothing_run_and_nothing_to_read(tmp_path: Path) -> None:
    need_root()
    with tempfile.TemporaryDirectory() as shared:  # beside the tests' own folders, which are closed to others
        os.chmod(shared, 0o777)
        cache = Path(shared) / "cache"
        script = f"umask 0; mkdir '{cache}'"
        subprocess.run(["su", "nobody", "-s", "/bin/sh", "-c", script], cwd="/", check=True)
        assert cache.stat().st_uid == NOBODY
        value, place, said = run(PLUS, cache, HOME=str(tmp_path / "home"))
        assert list(cache.iterdir()) == []
    assert value == 7.0
    assert place.is_relative_to(tmp_path / "home")
    assert len(said) == 1


@pytest.fixture
def choose(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[[], tuple[Path | None, str]]:
    """Chooses a folder, with the root `tmp_path/cache` asked for; returns it and what was said."""
    monkeypatch.setenv("PAINLEVE_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)

    def chosen() -> tuple[Path | None, str]:
        return choose_folder("0" * 16).path, capsys.readouterr().err

    return chosen


@pytest.mark.parametrize("mode", [0o777, 0o770, 0o1777, 0o702])
@pytest.mark.parametrize("which", ["root", "digest folder"])
def test_a_folder_in_which_others_may_write_is_passed_over_for_a_private_one(
    mode: int, which: str, tmp_path: Path, choose: Callable[[], tuple[Path | None, str]]
) -> None:
    path, said = choose()
    assert path == tmp_path / "cache" / ("0" * 16)
    assert said == ""
    os.chmod(path if which == "digest folder" else path.parent, mode)
    found, said = choose()
    assert found == tmp_path / "home" / ".cache" / "painleve" / ("0" * 16)
    assert said.count("\n") == 1
    assert "others may write" in said
    assert str(found.parent) in said
    assert {p.stat().st_mode & 0o777 for p in (found, found.parent)} == {0o700}


def test_folders_are_closed_to_others_under_any_mask(
    tmp_path: Path, choose: Callable[[], tuple[Path | None, str]]
) -> None:
    mask = os.umask(0)
    try:
        path, _ = choose()
    finally:
        os.umask(mask)
    assert path is not None
    assert {p.stat().st_mode & 0o777 for p in (path, path.parent)} == {0o700}


def test_a_symbolic_link_in_the_place_of_the_folder_is_not_followed(
    tmp_path: Path, choose: Callable[[], tuple[Path | None, str]]
) -> None:
    (tmp_path / "elsewhere").mkdir(mode=0o700)
    (tmp_path / "cache").mkdir(mode=0o700)
    (tmp_path / "cache" / ("0" * 16)).symlink_to(tmp_path / "elsewhere")
    path, said = choose()
    assert path is not None
    assert path.is_relative_to(tmp_path / "home")
    assert said.count("\n") == 1


def test_a_pipe_in_the_place_of_compiled_code_stops_nobody(tmp_path: Path) -> None:
    cache, signature = make_cache(tmp_path / "c")
    (path,) = files(tmp_path, ".nbc")
    path.unlink()
    os.mkfifo(path)
    assert cache.load_overload(signature, cpu_target.target_context) is None


def test_a_full_disk_under_the_cache_costs_time_and_no_answer(tmp_path: Path) -> None:
    with small_disk(tmp_path / "disk", 12) as disk:
        value, _, said = run(PLUS, disk / "cache")
        left = [path for path in disk.rglob("*") if path.is_file() and path.suffix == ".part"]
    assert value == 7.0
    assert len(said) == 1
    assert str(disk / "cache") in said[0]
    assert "No space left on device" in said[0]
    assert left == []


def test_a_limit_on_the_size_of_files_costs_time_and_no_answer(tmp_path: Path) -> None:
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))"
    value, _, said = run(PLUS, tmp_path, before=limit)
    assert value == 7.0
    assert len(said) == 1
    assert "File too large" in said[0]


def test_without_a_home_and_an_entry_in_the_list_of_users_the_cache_is_beside_the_temporary_files(
    tmp_path: Path,
) -> None:
    need_root()
    stranger = "os.setresuid(54321, 0, 0)"  # Path.home() asks for the real user
    value, path, said = run(PLUS, None, before=stranger, TMPDIR=str(tmp_path))
    assert (value, said) == (7.0, [])
    assert path.parents[1] == tmp_path / "painleve-0"
    os.chmod(tmp_path / "painleve-0", 0o777)
    value, path, said = run(PLUS, None, before=stranger, TMPDIR=str(tmp_path))
    assert value == 7.0
    assert path == Path(path.name)
    assert len(said) == 1
    assert "compiled code is not kept" in said[0]


def test_without_a_compiler_the_kernels_are_plain_python(tmp_path: Path) -> None:
    assert run(PLUS, tmp_path, NUMBA_DISABLE_JIT="1")[0] == 7.0
    assert files(tmp_path, ".nbc") == []


def make_folder(root: Path, name: str, days: float, size: int = 10) -> Path:
    """A folder of compiled code that was last used that many days ago."""
    folder = root / name
    (folder / "core_0").mkdir(parents=True)
    (folder / "core_0" / "law.nbc").write_bytes(bytes(size))
    used = time.time() - days * DAY
    os.utime(folder, (used, used))
    return folder


def removed(root: Path, keep: str) -> None:
    handle = os.open(root, os.O_RDONLY)
    try:
        remove_old_folders(root, handle, keep=keep)
    finally:
        os.close(handle)


def test_folders_that_nobody_used_for_two_months_go_and_nothing_else(tmp_path: Path) -> None:
    outside = make_folder(tmp_path, "outside", 100)
    root = tmp_path / "root"
    current, recent, old = (make_folder(root, c * 16, days) for c, days in (("a", 99), ("b", 59), ("c", 61)))
    strange = make_folder(root, "my_results", 99)
    link = root / ("d" * 16)
    link.symlink_to(outside)
    os.utime(link, (0, 0), follow_symlinks=False)
    (root / ("e" * 16)).write_text("a file")
    os.utime(root / ("e" * 16), (0, 0))
    removed(root, current.name)
    assert not old.exists()
    assert sorted(root.iterdir()) == sorted([current, recent, strange, link, root / ("e" * 16)])
    assert (outside / "core_0" / "law.nbc").exists()


def test_folders_of_another_user_stay(tmp_path: Path) -> None:
    need_root()
    foreign = make_folder(tmp_path, "f" * 16, 99)
    os.chown(foreign, NOBODY, NOBODY)
    removed(tmp_path, "0" * 16)
    assert foreign.exists()


def test_beyond_a_size_the_folders_used_last_stay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(old_folders, "MOST_BYTES", 1000)
    folders = [make_folder(tmp_path, f"{k:016x}", days, 400) for k, days in enumerate((0, 3, 2, 5, 0.5))]
    removed(tmp_path, folders[0].name)
    assert sorted(tmp_path.iterdir()) == [folders[0], folders[4]]  # 400 and 400; the next would be 1200
    removed(tmp_path, folders[0].name)
    assert sorted(tmp_path.iterdir()) == [folders[0], folders[4]]


def test_a_new_version_of_the_sources_takes_old_folders_away(tmp_path: Path) -> None:
    tmp_path.chmod(0o700)
    old = make_folder(tmp_path, "0" * 16, 99)
    run(PLUS, tmp_path)
    assert not old.exists()
