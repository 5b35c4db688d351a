"""What the contact does along a trajectory: its work, what the scheme loses beside it, and its force over hops."""

from __future__ import annotations

import math

import numpy as np
import pytest
from dynamics_scenes import block, hinged_rod

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change
from painleve.dynamics.hops import force_over_hops, free_steps_of_hops
from painleve.dynamics.schemes import SCHEME_NAMES
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import make_start
from painleve.dynamics.trajectory import Trajectory
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.plotting import draw

ROD = load_scene("slender_rod")
TESTED = ("contact_dynamics", "moreau_jean", "anitescu_potra")  # schemes that test g for contact
MU_C = (math.tan(math.pi / 3) + 4.0 / math.tan(math.pi / 3)) / 3.0
OBLIQUE = make_state(ROD, keys={"theta": "pi/3"}, parameters={"mu": 0.9 * MU_C})


def test_the_work_of_a_sticking_contact_is_zero_and_what_the_scheme_loses_is_of_first_order() -> None:
    """A rod held at rest by a board: nothing moves. A step gives v = h M^-1 f and takes it back, u+ = 0: -v . M v/2."""
    losses = []
    for step in (1e-2, 1e-3, 1e-4):
        start = make_start(hinged_rod(), q={"phi": "pi/6", "s": 0}, parameters={"M_b": 1})
        found = simulate(start, step=step, until=0.1)
        assert (found.branch[1:] == ContactMode.STICK).all()
        assert abs(found.contact_work()).max() < 1e-15
        losses.append(found.splitting_loss()[-1])
        assert losses[-1] == pytest.approx(-0.1 * step * 3.0 * (4.905 / 2.0) ** 2 / 2.0, rel=1e-9)
    np.testing.assert_allclose(np.divide(losses[:-1], losses[1:]), 10.0, rtol=1e-9)


@pytest.mark.parametrize("scheme", [s for s in SCHEME_NAMES if s != "compliant"])
def test_a_sliding_block_loses_its_energy_to_friction(scheme: str) -> None:
    """m v^2/2, until it stands: by friction, to first order in h where the velocity at the end of a step counts."""
    start = make_start(block(), q={"x": 0, "y": 0}, u={"x": 2}, parameters={"mu": 0.25, "weight": 10})
    errors = []
    for step in (1e-2, 1e-3):
        found = simulate(start, scheme=scheme, step=step, until=2.0)
        errors.append(abs(found.contact_work()[-1] + 2.0))
        assert (found.splitting_loss() <= 0.0).all()
    assert errors[1] < 3e-3
    assert errors[1] < 0.2 * errors[0] or errors[0] < 1e-9


def test_a_jump_takes_the_change_of_the_kinetic_energy_and_the_scheme_loses_none_of_it() -> None:
    start = make_start(ROD, q={"x": 0, "y": "3/2", "theta": 1}, u={"x": 2})
    found = simulate(start, step=1e-3, until=0.5)
    (jump,) = found.jumps
    M = np.diag([1.0, 1.0, 1.0 / 3.0])
    gained = (jump.u_plus @ M @ jump.u_plus - jump.u_minus @ M @ jump.u_minus) / 2.0
    work, loss = (np.diff(values)[jump.index - 1] for values in (found.contact_work(), found.splitting_loss()))
    assert work == pytest.approx(gained, rel=1e-12)
    assert loss == 0.0


@pytest.mark.parametrize("scheme", [s for s in SCHEME_NAMES if s != "compliant"])
def test_the_average_force_of_a_hopping_tip_is_that_of_the_slip(scheme: str) -> None:
    """m g/(1 + 3 cos^2 - 3 mu sin cos) at 60 degrees and at the start, although single impulses are up to twice it."""
    found = simulate(OBLIQUE, scheme=scheme, step=1e-4, until=1e-2)
    sine, cosine = math.sin(math.pi / 3), 0.5
    exact = 9.81 / (1.0 + 3.0 * cosine**2 - 3.0 * 0.9 * MU_C * sine * cosine)
    assert exact / 9.81 == pytest.approx(5.7142857)
    force, impulses = found.contact_force(), found.r[:, 0] / 1e-4
    np.testing.assert_allclose(force[1:8], exact, rtol=1e-3)
    assert math.isnan(force[0])
    hopping = scheme in TESTED
    assert bool(found.hops) == hopping
    assert (impulses[1:8].max() > 1.9 * exact) == (impulses[1:8].min() == 0.0) == hopping
    assert any(note.startswith("impulses come in hops") for note in found.notes) == hopping


def test_the_picture_of_a_hopping_tip_says_so() -> None:
    for scheme, says in (("contact_dynamics", True), ("stewart_trinkle", False)):
        data = simulate(OBLIQUE, scheme=scheme, step=1e-4, until=1e-2).to_xarray()
        assert (data.attrs["steps_in_hops"] > 0) == says
        (panel,) = (axis for axis in draw(data).axes if axis.get_ylabel() == "contact force (N)")
        assert ("impulses come in hops" in panel.get_title(loc="left")) == says


def walked(rows: list[tuple[float, float, int, int]], touches: bool) -> np.ndarray:
    """force_over_hops of rows (t, impulse, branch, change), worked out one row after the other."""
    force, since = [math.nan], 0.0 if touches else None
    for i, (t, impulse, branch, change) in enumerate(rows[1:], 1):
        if branch == ContactMode.FREE:
            force.append(0.0)
            continue
        if change != Change.ORDINARY:
            force.append(math.nan)
        else:
            begin = since if since is not None else rows[i - 1][0]
            force = [impulse / (t - begin) if rows[k][0] > begin else f for k, f in enumerate(force)]
            force.append(impulse / (t - begin))
        since = t
    return np.array(force)


def test_the_force_over_hops_is_that_of_a_slow_walk_along_the_rows() -> None:
    random = np.random.default_rng(0)
    for _ in range(200):
        n = int(random.integers(1, 12))
        t = np.concatenate([[0.0], np.cumsum(random.uniform(0.5, 1.5, n))])
        branch = random.choice([0, 0, 1, 3], n + 1)
        change = np.where(branch == 0, 0, random.choice([0, 0, 0, 2, 3], n + 1))
        branch[0] = change[0] = 0
        impulse = np.where(branch == 0, 0.0, random.uniform(0.0, 2.0, n + 1))
        touches = bool(random.integers(2))
        rows = list(zip(t.tolist(), impulse.tolist(), branch.tolist(), change.tolist(), strict=True))
        np.testing.assert_allclose(force_over_hops(t, impulse, branch, change, touches), walked(rows, touches))
        gaps, free = 0, 0
        for k in range(1, n + 1):
            free += branch[k] == 0
            if branch[k] != 0:
                gaps += free if (branch[1:k] != 0).any() and change[k] not in (1, 2) else 0
                free = 0
        assert free_steps_of_hops(branch, change) == gaps


def impulse_balance(found: Trajectory) -> float:
    """The integral of the contact force, where it is known, over the impulses."""
    lasts = ~np.isnan(found.contact_force())
    return float((found.contact_force() * np.diff(found.t, prepend=0.0))[lasts].sum() / found.r[lasts, 0].sum())


@pytest.mark.parametrize("scheme", SCHEME_NAMES)
def test_the_average_force_gives_back_the_impulses(scheme: str) -> None:
    assert impulse_balance(simulate(OBLIQUE, scheme=scheme, step=1e-4, until=1e-2)) == pytest.approx(1.0, rel=1e-9)
