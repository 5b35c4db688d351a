"""Rounded values of a contact: refused with their distance, or put on the contact where that is asked for."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from command_line import assert_refused
from scipy.optimize import minimize

from painleve.cli import main
from painleve.core.motion_codes import Ending
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import Start, make_start
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state

ROD, ARM = load_scene("slender_rod"), load_scene("two_link_arm")


def rounded(digits: int, **more: object) -> Start:
    """The rod's paradox, rounded after so many digits."""
    theta = math.atan(2.0)
    q = {"x": 0.0, "y": round(math.sin(theta), digits), "theta": round(theta, digits)}
    u = {"x": -1.0 - round(math.sin(theta), digits), "y": round(math.cos(theta), digits), "theta": 1.0}
    return make_start(ROD, q=q, u=u, parameters={"mu": 2}, project=True, **more)


@pytest.mark.parametrize("digits", [3, 4, 5, 6, 7, 9])
def test_a_rounded_contact_is_put_on_the_contact_and_its_velocity_made_tangential(digits: int) -> None:
    start = rounded(digits)
    _, y, theta = start.q
    assert abs(math.sin(theta) - y) <= 1e-13 * 3.0
    assert abs(start.u[1] - math.cos(theta) * start.u[2]) < 1e-15
    off = 10.0**-digits
    assert np.abs(np.array(start.q) - [0.0, math.sin(math.atan(2.0)), math.atan(2.0)]).max() < off
    assert np.abs(np.array(start.u) - [-1.0 - math.sin(theta), math.cos(theta), 1.0]).max() < off
    assert start.projected.startswith("g was ")


def test_a_projected_paradox_is_one_for_the_methods_that_ask_whether_the_tip_touches() -> None:
    exact = simulate(make_state(ROD, "paradox", keys={"omega": 1}), scheme="event_driven", step=1e-3, until=0.1)
    assert exact.ending is Ending.INCONSISTENT
    found = simulate(rounded(6), scheme="event_driven", step=1e-3, until=0.1)
    assert (found.ending, found.steps) == (exact.ending, exact.steps)
    assert found.notes[0] == f"the start was put on the contact: {found.start.projected}"


def test_the_projection_is_the_nearest_contact_in_the_kinetic_metric() -> None:
    """Against a minimiser that is told of the constraint alone."""
    given = {"phi1": 0.1, "phi2": 0.25}
    start = make_start(ARM, q=given, parameters={"depth": 1.96}, project=True)
    M = np.array(start.motion.inertia_at(tuple(given.values()), start.p)).reshape(2, 2)
    centre = np.array(list(given.values()))
    found = minimize(
        lambda q: (q - centre) @ M @ (q - centre),
        centre,
        constraints={"type": "eq", "fun": lambda q: np.cos(q[0]) + np.cos(q[1]) - 1.96},
        method="SLSQP",
        options={"ftol": 1e-16, "maxiter": 200},
    )
    assert np.abs(found.x - centre).max() > 1e-3
    np.testing.assert_allclose(start.q, found.x, atol=1e-7)


def test_the_velocity_taken_away_is_the_normal_one_in_the_kinetic_metric() -> None:
    start = rounded(3)
    given = np.array([-1.0 - 0.894, 0.447, 1.0])
    w, inverse = np.array([0.0, 1.0, -math.cos(start.q[2])]), np.diag([1.0, 1.0, 3.0])
    expected = given - inverse @ w * (w @ given) / (w @ inverse @ w)
    np.testing.assert_allclose(start.u, expected, rtol=1e-14)


def test_what_is_no_rounding_is_not_projected() -> None:
    with pytest.raises(InputError, match=r"g\(q\) = 0\.39\d+ is no rounding of a contact"):
        make_start(ROD, q={"x": 0, "y": "1/2", "theta": 1.1}, project=True)
    with pytest.raises(InputError, match=r"its normal velocity -3 is no rounding of a tangential one"):
        make_start(ROD, q={"x": 0, "y": math.sin(1.1), "theta": 1.1}, u={"y": -3}, project=True)


def test_a_start_off_the_contact_by_rounding_is_refused_with_the_tolerance_and_the_way_out(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ["simulate", "slender_rod", "--q", "x=0", "y=0.894427", "theta=1.10715", "--u", "x=-1", "y=1e-5"]
    words += ["--contact-tolerance", "1e-6", "--step", "1e-3", "--until", "0.01"]
    error = assert_refused(words, capsys, tmp_path, monkeypatch)
    assert "positive beyond rounding" in error
    assert "which a contact tolerance does not change" in error
    assert "--project" in error
    assert main([*words, "--project"]) == 0
    text = capsys.readouterr().out
    off = f"{math.sin(1.10715) - 0.894427:.3g}"
    assert f"the start was put on the contact: g was {off} and the normal velocity 1e-05; moved y by " in text


def test_project_is_for_starts_that_are_given_by_values(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    words = ("simulate", "slender_rod", "--state", "paradox", "--project", "--step", "1e-3", "--until", "0.01")
    assert "a --state is exactly on the contact" in assert_refused(words, capsys, tmp_path, monkeypatch)
