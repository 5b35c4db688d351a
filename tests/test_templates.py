"""The templates of a scene's motion: what runs as it stands, without a compiler, is what is compiled."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import plain_law
import plain_motion
import pytest

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change, FixedStep, MemberOutcome
from painleve.kernels.compiled import make_kernels
from painleve.kernels.motion import sample
from painleve.kernels.motion.compiled import make_motion
from painleve.kernels.templates import write_out

AIMED_AT = set(MemberOutcome) - {MemberOutcome.FAILED, MemberOutcome.NOT_RUN}


def test_the_sample_is_what_is_written_for_its_scene() -> None:
    motion = make_motion(plain_motion.parabola())
    assert (motion.scene.dimension, len(motion.rows.names)) == (sample.D, sample.ROWS)
    random = np.random.default_rng(1)
    for _ in range(50):
        t, q, u, p = float(random.normal()), *(tuple(random.normal(size=n).tolist()) for n in (2, 2, 4))
        arguments = {"rows_at": (q, p), "force_at": (t, q, u, p), "motion_at": (t, q, u, p)}
        arguments |= {"inertia_at": (q, p), "drift_at": (q, u, p), "depths_at": (q, p)}
        for name, values in arguments.items():
            assert getattr(sample, name).py_func(*values) == getattr(motion, name)(*values), name


def test_every_scheme_steps_in_plain_python_as_it_does_compiled_bit_for_bit(tmp_path: Path) -> None:
    program, file = Path(plain_motion.__file__), tmp_path / "plain.npz"
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, program, file], env=environment, check=True)
    compiled = plain_motion.everything(plain=False)
    with np.load(file) as plain:
        assert set(plain) == set(compiled)
        for name, column in compiled.items():
            if name.startswith("block_on_ellipse"):  # Python's math.hypot is rounded better than the compiler's
                np.testing.assert_allclose(plain[name], column, rtol=1e-13, atol=1e-13)
            else:
                assert column.tobytes() == plain[name].tobytes(), name
    for column, codes in (("branch", ContactMode), ("change", Change), ("outcome", AIMED_AT)):
        seen = np.concatenate([values for name, values in compiled.items() if name.endswith(f" {column}")])
        assert set(seen.tolist()) == set(codes)
    assert {name.split()[1] for name in compiled if name.startswith("parabola")} == {s.name for s in FixedStep}


def test_samples_are_drawn_in_plain_python_as_compiled_bit_for_bit(tmp_path: Path) -> None:
    program, file = Path(plain_law.__file__), tmp_path / "plain.npz"
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, program, file], env=environment, check=True)
    kernels = make_kernels(plain_motion.parabola())
    compiled = plain_law.everything(kernels.rows_at, kernels.sample_lane)
    with np.load(file) as plain:
        assert set(plain) == set(compiled)
        for name, column in compiled.items():
            assert column.tobytes() == plain[name].tobytes(), name
    counts = {name: column for name, column in compiled.items() if name.endswith(" counts")}
    codes = (ContactMode.FREE, ContactMode.STICK, ContactMode.SLIP_PLUS)
    assert all(column[code] > 0 for column in counts.values() for code in codes)


def module(path: Path, text: str) -> ModuleType:
    """A module as it stands in a file."""
    path.write_text(text, encoding="utf-8")
    found = ModuleType(f"room.{path.stem}")
    found.__file__ = str(path)
    exec(compile(text, path, "exec"), found.__dict__)
    return found


def test_a_template_is_written_out_with_the_numbers_of_the_scene_and_its_tuples(tmp_path: Path) -> None:
    text = (
        '"""Words."""\nimport math\nD, N = 2, 7\ndef f(x):\n    return tuple(math.sqrt(x[j] + N) for j in range(D))\n'
    )
    written = write_out("room", [module(tmp_path / "a.py", text)], {"D": 3, "N": 4}, ["one = 1"])
    assert "tuple" not in written
    namespace: dict[str, object] = {}
    exec(written, namespace)
    assert namespace["f"]([0, 5, 12]) == (2.0, 3.0, 4.0)
    assert namespace["one"] == 1


def test_two_templates_may_not_mean_different_things_by_one_name(tmp_path: Path) -> None:
    same = [module(tmp_path / f"{name}.py", "LIMIT = 50\n") for name in ("a", "b")]
    assert write_out("room", same, {}, []).count("LIMIT = 50") == 1
    other = module(tmp_path / "c.py", "LIMIT = 60\n")
    with pytest.raises(ValueError, match=r"room\.c: another template defines LIMIT differently"):
        write_out("room", [*same, other], {}, [])
