"""What a session or a notebook shows of a result: one short line that says what it is of and what was found."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import pytest

import painleve
from painleve.sets import Cloud, hausdorff
from painleve.sweep.scan import scan_friction

LONGEST = 200
ROD = "slender_rod"


@cache
def state(name: str = "paradox", scene: str = ROD):
    return painleve.make_state(painleve.load_scene(scene), name)


@cache
def classification(name: str = "paradox"):
    return painleve.classify(state(name))


@cache
def limit(name: str = "paradox", scene: str = ROD):
    return painleve.limit_set(state(name, scene))


@cache
def enclosed(eps: float = 1e-3):
    return painleve.distance(limit(), eps, "certify")


@cache
def hypotheses():
    return painleve.check_hypotheses(state())


def units():
    pytest.importorskip("pint")
    return painleve.check_units(painleve.load_scene(ROD))


@cache
def one_step():
    return painleve.coulomb_solutions(painleve.load_scene(ROD), state().q, state().u, parameters={"mu": 2})


@cache
def jumps():
    return painleve.limit_set(state(), law="coulomb")


@cache
def critical():
    return painleve.critical_states(painleve.load_scene(ROD), "theta", parameters={"mu": 2})


@cache
def evidence(eps: float = 1e-3):
    return painleve.collect(classification(), eps, lambda _, radius: enclosed(radius))


RESULTS: dict[str, tuple[Callable[[], object], str]] = {
    "Scene": (lambda: painleve.load_scene(ROD), "Scene('slender_rod')"),
    "State": (state, "State('slender_rod', 'paradox')"),
    "Derivation": (lambda: painleve.derive(painleve.load_scene(ROD)), "Derivation('slender_rod', d = 3, k = 1)"),
    "LimitSet": (limit, "LimitSet('slender_rod', 'paradox', pair)"),
    "Signed": (lambda: limit().gamma, "Signed(negative, -0.8)"),
    "Classification": (classification, "Classification('slender_rod', 'paradox', negative)"),
    "Neighbours": (lambda: classification("critical").neighbours, "Neighbours(approached)"),
    "HypothesesCheck": (
        hypotheses,
        "HypothesesCheck('slender_rod', 'paradox', H1 proved, H2 proved, H3 proved, H4 proved, H'4 proved: "
        "Theorem 1 applies)",
    ),
    "Hypothesis": (lambda: hypotheses()["H1"], "Hypothesis(H1, proved)"),
    "UnitsCheck": (units, "UnitsCheck('slender_rod', 24 quantities: agrees)"),
    "CriticalStates": (
        critical,
        "CriticalStates('slender_rod', along 'theta'; zeros of gamma: 2, extrema of mu_c: 1, unresolved: 0)",
    ),
    "CriticalState": (
        lambda: critical().least,
        "CriticalState(exact, at 1.10715, mu_c = 1.33333, approached)",
    ),
    "CoulombSolutions": (one_step, "CoulombSolutions(open, stick: complete)"),
    "CoulombSolution": (lambda: one_step().solutions[1], "CoulombSolution(stick, impulse = (..., ...))"),
    "CoulombLimitSet": (
        jumps,
        "CoulombLimitSet('slender_rod', 'paradox', finite: open, stick)",
    ),
    "CoulombJump": (lambda: jumps().jumps[1], "CoulombJump(stick)"),
    "Distance": (
        enclosed,
        "Distance('slender_rod', 'paradox', eps = 0.001, certify: e(A_eps, A) in [...] (...), e(A, A_eps) = 0 (exact))",
    ),
    "Attained": (lambda: enclosed().excess_A_Aeps, "Attained(= 0 (exact))"),
    "Member": (
        lambda: enclosed().excess_Aeps_A.member,
        "Member(stick, S - u- = (..., ..., ...), dist(S, A) in [...] (...))",
    ),
    "Witness": (
        lambda: painleve.find_witness(limit(), 1.0, 1e-3, within=1e-4),
        "Witness(fraction = 1, eps = 0.001, distance in [...] (...))",
    ),
    "Witness, none": (
        lambda: painleve.find_witness(limit("isolated", "minimal"), 0.5, 1e-3, within=1e-4),
        "Witness(fraction = 0.5, eps = 0.001, none found)",
    ),
    "Family": (
        lambda: painleve.find_family(limit(), 1e-3, within=1e-4),
        "Family(e(A, A_eps) ≤ ... (upper bound))",
    ),
    "Rate": (lambda: painleve.rate(limit()), "Rate('slender_rod', 'paradox', 1.6930333 eps, sticking)"),
    "Evidence": (
        evidence,
        "Evidence(eps = 0.001, e(A_eps, A) in [...] (...), e(A, A_eps) = 0 (exact), by witnesses ≤ ... (upper bound))",
    ),
    "Verdict": (
        lambda: painleve.judge(classification(), [evidence(1e-2), evidence()]),
        "Verdict(negative, proved, slope 1)",
    ),
    "Scan": (
        lambda: scan_friction(painleve.load_scene(ROD), ranges={"theta": ("1/10", "3/2")}, points=1000),
        "Scan('slender_rod', 1000 points: mu_c ≤ 1.33333, paradoxical ... ± ...)",
    ),
    "Hausdorff": (
        lambda: hausdorff(Cloud([[0.0, 0.0, 0.0]]), limit().point_set),
        "Hausdorff(forward ≥ ... (lower bound), backward ≤ ... (upper bound))",
    ),
}


@pytest.mark.parametrize(("make", "line"), RESULTS.values(), ids=RESULTS)
def test_a_result_shows_itself_in_one_short_line(make: Callable[[], object], line: str) -> None:
    shown = repr(make())
    assert re.fullmatch(re.escape(line).replace(re.escape("..."), r"[^\n]+"), shown), shown
    assert len(shown) <= LONGEST


def test_every_public_function_that_finds_something_is_shown_above() -> None:
    """What is not: functions that draw, load or save, and the motions, whose results have tests of their own."""
    elsewhere = {"draw", "load", "make_scene", "make_start", "run_ensemble", "save", "save_figure", "simulate"}
    elsewhere |= {"sweep_distances", "trajectory_dataset"}
    functions = {name for name in painleve.__all__ if name[0].islower()} - elsewhere
    with open(__file__, encoding="utf-8") as file:
        text = file.read()
    assert {name for name in functions if f"painleve.{name}(" not in text} == set()
