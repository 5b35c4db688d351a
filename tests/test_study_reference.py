"""The study of published facts: its data, its comparisons, its routes against other ones, and its quick run."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
import xarray as xr

from painleve.core.sections.segment import solutions
from painleve.dynamics.genot_brogliato import find_friction, singular_point
from painleve.dynamics.modes import ContactPoint, Mode
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import make_start
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.sweep import map_regimes
from studies.parts import Report
from studies.reference.compare import FactStatus, FoundValue, compare
from studies.reference.contact import regime, step_solutions
from studies.reference.dataset import as_dataset
from studies.reference.facts import Fact, FactKind, load_facts
from studies.reference.report import report
from studies.reference.rod import eigenvalue_ratio
from studies.reference.routes import ROUTES, reproduce
from studies.reference.slip import ArcEnd, derive_slip, make_flow

ROOT = Path(__file__).parents[1]
FACTS = load_facts(ROOT / "data" / "reference" / "facts.toml")
NUMBERS = [fact for fact in FACTS if fact.kind is not FactKind.LABEL]
HEAD = '[source.a]\nauthors = "A. Author"\nyear = 2000\nread = "abstract"\n\n'
ENTRY = {
    "id": '"f"',
    "statement": '"a sum"',
    "kind": '"exact"',
    "value": '"1 + 1"',
    "basis": '"abstract"',
    "source": '"a"',
    "says": '"so it is"',
}


@cache
def found_for(fact: str) -> FoundValue:
    """By its route, in the quick form."""
    return ROUTES[fact](True, 0)


def entry(**changes: str | None) -> str:
    fields = {**ENTRY, **changes}
    return "[[fact]]\n" + "".join(f"{name} = {value}\n" for name, value in fields.items() if value is not None)


def read(tmp_path: Path, text: str) -> tuple[Fact, ...]:
    path = tmp_path / "facts.toml"
    path.write_text(text, encoding="utf-8")
    return load_facts(path)


def test_every_fact_has_a_route_and_every_route_a_fact() -> None:
    assert [fact.id for fact in FACTS] == list(ROUTES)


def test_a_sound_file_is_read_as_it_is_written(tmp_path: Path) -> None:
    (fact,) = read(tmp_path, HEAD + entry())
    assert (fact.expression, fact.source.citation) == (2, "A. Author (2000): ")


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("", "lacks source, fact"),
        ("x =", "cannot be read"),
        (HEAD + entry(says=None), "fact 1: lacks says"),
        (HEAD + entry(colour='"red"'), "no field 'colour'"),
        (HEAD + entry(value="2"), "value must be text"),
        (HEAD + entry(value='""'), "value must be text, and not empty"),
        (HEAD + entry(value='"__import__(1)"'), "fact f: value"),
        (HEAD + entry(value='"x"'), "'x' is not declared"),
        (HEAD + entry(kind='"guess"'), "kind = 'guess'; choose one of exact, formula, decimal, label"),
        (HEAD + entry(kind='"decimal"', value='"4/3"'), "not a decimal number"),
        (HEAD + entry(kind='"formula"'), "a formula needs them"),
        (HEAD + entry(symbols='["x"]'), "symbols go with a formula"),
        (HEAD + entry(kind='"formula"', symbols='["x", "y"]', value='"2*x"'), "does not depend on y"),
        (HEAD + entry(kind='"formula"', symbols="[1]"), "a list of names"),
        (HEAD + entry(source='"b"'), "no source 'b'"),
        (HEAD + entry() + entry(), "f is stated twice"),
        (HEAD.replace("2000", '"2000"') + entry(), "source a: year must be a whole number"),
        (HEAD.replace("read", 'doi = "doi.org/x"\nread') + entry(), "doi = 'doi.org/x'"),
        (HEAD.replace("read", 'arxiv = "math/0"\nread') + entry(), "arxiv = 'math/0'"),
        ("source = 3\nfact = []", "source must be a table"),
    ],
)
def test_a_fact_that_is_half_stated_is_refused_in_one_line(tmp_path: Path, text: str, named: str) -> None:
    with pytest.raises(InputError) as refused:
        read(tmp_path, text)
    assert named in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_fact_without_a_route_is_refused() -> None:
    with pytest.raises(InputError, match="no route"):
        reproduce([replace(FACTS[0], id="unheard_of")])


@pytest.mark.parametrize("fact", NUMBERS, ids=lambda fact: fact.id)
def test_a_number_is_reproduced_and_a_misprint_of_it_found_out(fact: Fact) -> None:
    found = found_for(fact.id)
    assert compare(fact, found).status is FactStatus.REPRODUCED
    if fact.kind is FactKind.DECIMAL:
        misprint = f"{float(fact.value) + 10.0**-fact.decimals:.{fact.decimals}f}"
    else:
        misprint = f"({fact.value})*(1 + 1/10**30)"
    assert compare(replace(fact, value=misprint), found).status is FactStatus.DIFFERS


def test_a_decimal_is_reproduced_only_if_both_ends_of_the_error_round_to_it() -> None:
    fact = next(fact for fact in FACTS if fact.id == "stoss_time")
    for value, error, status in (
        (0.8145501, 1e-9, FactStatus.REPRODUCED),
        (0.8145549, 1e-7, FactStatus.REPRODUCED),
        (0.8145549, 2e-7, FactStatus.DIFFERS),
        (0.8145551, 1e-9, FactStatus.DIFFERS),
        (math.nan, 0.0, FactStatus.DIFFERS),
    ):
        assert compare(fact, FoundValue(value=value, error=error, route="")).status is status


def test_routes_that_disagree_reproduce_nothing_and_an_obstacle_is_no_agreement() -> None:
    fact = FACTS[0]
    for gap, status in ((1e-13, FactStatus.REPRODUCED), (1e-11, FactStatus.DIFFERS), (math.nan, FactStatus.DIFFERS)):
        assert compare(fact, FoundValue(value=sp.Rational(4, 3), route="", gap=gap)).status is status
    blocked = FoundValue(value=sp.Rational(4, 3), route="", obstacle="another model")
    assert compare(fact, blocked).status is FactStatus.NOT_REPRODUCIBLE


@pytest.mark.parametrize(
    ("theta", "omega", "mu", "alpha"), [(0.6, 0.5, 0.4, 3.0), (1.2, -2.0, 2.0, 1.0), (0.3, 4.0, 5.0, 6.0)]
)
def test_newtons_equations_give_the_force_and_the_turn_of_the_compiled_contact(
    theta: float, omega: float, mu: float, alpha: float
) -> None:
    start = make_start(
        load_scene("slender_rod"),
        q={"x": 0, "y": math.sin(theta), "theta": theta},
        u={"x": -5.0 - omega * math.sin(theta), "y": omega * math.cos(theta), "theta": omega},
        parameters={"mu": mu, "I": 1.0 / alpha},
    )
    point = ContactPoint.at(start, 0.0, np.array(start.q), np.array(start.u))
    force = point.force(Mode.SLIP_PLUS)
    turn = (np.array(point.acceleration) + point.response(*force))[2]
    values = {"m": 1.0, "l": 1.0, "alpha": alpha, "mu": mu, "gravity": 9.81, "theta": theta, "omega": omega}
    slip = derive_slip()
    push, edge, turning = (
        float(e.subs({sp.Symbol(name, positive=True): value for name, value in values.items()}))
        for e in (slip.push, slip.edge, slip.turn)
    )
    assert push / edge == pytest.approx(force[0], rel=1e-12)
    assert turning / edge == pytest.approx(turn, rel=1e-12)
    assert math.copysign(1.0, edge) == math.copysign(1.0, point.edge(Mode.SLIP_PLUS))


@pytest.mark.parametrize("alpha", [0.5, 3.0, 6.0])
@pytest.mark.parametrize("ratio", [0.3, 1.0, 1.9])
def test_the_eigenvalue_ratio_is_that_of_the_points_which_the_ensembles_slide_into(alpha: float, ratio: float) -> None:
    point = singular_point(find_friction(ratio, alpha=alpha), alpha=alpha)
    values = {sp.Symbol("alpha", positive=True): alpha, sp.Symbol("t", positive=True): math.tan(point.theta)}
    assert float(eigenvalue_ratio().subs(values)) == pytest.approx(ratio, rel=1e-12)


def test_event_driven_integration_of_all_coordinates_ends_glockers_slip_at_the_same_time() -> None:
    run = simulate(make_state(load_scene("slender_rod"), "stoss"), scheme="event_driven", step=0.1, until=1.0)
    flow = make_flow(5 / 3, gravity=10.0)
    arc = flow.arc(math.radians(31.0), 0.0)
    assert arc.end is ArcEnd.EDGE
    assert run.t[-1] == pytest.approx(arc.t[-1] + arc.distance[-1] / arc.omega[-1], abs=1e-8)


def test_a_slip_below_mu_C_lifts_off_where_its_free_acceleration_vanishes() -> None:
    flow = make_flow(1.45)
    theta = flow.edges[0] - 0.1
    arc = flow.arc(theta, flow.rate_for(theta, 0.5))
    assert arc.end is ArcEnd.LIFT_OFF
    assert arc.beta[0] == pytest.approx(-0.5, rel=1e-12)
    assert arc.omega[-1] ** 2 * math.sin(arc.theta[-1]) == pytest.approx(9.81, rel=1e-10)


@pytest.mark.parametrize(("degrees", "omega"), [(31.0, 0.0), (31.0, 0.1), (85.0, -1.0)])
def test_a_slip_that_the_friction_turns_back_ends_at_rest(degrees: float, omega: float) -> None:
    arc = make_flow(1.45).arc(math.radians(degrees), omega)
    assert arc.end is ArcEnd.TURNS_BACK
    assert arc.omega[-1] == pytest.approx(0.0, abs=1e-12)
    assert (arc.distance > 0.0).all()


def test_solutions_of_a_step_are_as_many_as_the_compiled_schemes_count() -> None:
    rng = np.random.default_rng(5)
    several = 0
    for theta, mu in zip(rng.uniform(0.1, 3.0, 40), rng.uniform(0.0, 4.0, 40), strict=True):
        start = make_start(
            load_scene("slender_rod"), q={"x": 0, "y": math.sin(theta), "theta": theta}, parameters={"mu": mu}
        )
        at = start.motion.rows.parts
        a, (b,), (C,) = start.rows[at.a], start.rows[at.b], start.rows[at.C]
        v = rng.normal(size=(50, 2))
        counted = [solutions(start.rows, 3, v_n, v_t) for v_n, v_t in v]
        assert step_solutions(np.array([[a, b], [b, C]]), mu, v).tolist() == counted
        several += sum(n > 1 for n in counted)
    assert several > 20


def test_regimes_are_those_of_the_map_of_regimes() -> None:
    drawn = map_regimes(
        load_scene("slender_rod"),
        axes={"theta": np.linspace(0.2, 1.5, 9), "omega": np.linspace(-5.0, 5.0, 8)},
        parameters={"mu": 2},
    )
    meanings = drawn["regime"].attrs["flag_meanings"].split()
    seen = set()
    for p, beta, code in zip(
        drawn["slip_compliance"].values.flat,
        drawn["free_acceleration"].values.flat,
        drawn["regime"].values.flat,
        strict=True,
    ):
        assert regime(p, beta).replace("-", "_") == meanings[code]
        seen.add(meanings[code])
    assert len(seen) == 4


@pytest.fixture(scope="module")
def drawn() -> xr.Dataset:
    return as_dataset([compare(fact, found_for(fact.id)) for fact in FACTS], command="test")


@pytest.fixture(scope="module")
def told(drawn: xr.Dataset) -> Report:
    return report({"reference": drawn})


def test_all_facts_are_reproduced_but_the_one_with_two_contacts(told: Report) -> None:
    facts: Any = told.data["facts"]
    statuses = {row["id"]: row["status"] for row in facts}
    assert statuses.pop("stewart_rest") == "not reproducible"
    assert set(statuses.values()) == {"reproduced"}
    assert told.status == f"{len(FACTS)} published facts: {len(FACTS) - 1} reproduced, 1 not reproducible."


def test_the_printout_has_every_published_value_with_its_status_and_source(told: Report) -> None:
    lines = told.table.splitlines()
    for fact in FACTS:
        (line,) = [x for x in lines if x.startswith(fact.statement + " ") and f" {fact.value} " in x]
        assert ("not reproducible" if fact.id == "stewart_rest" else "reproduced") in line
        assert any(fact.source.citation in x for x in lines)


def test_the_published_marks_of_the_figure_lie_on_the_derived_curves(drawn: xr.Dataset) -> None:
    uniform = drawn["critical_friction"].sel(alpha=3.0)
    # the grid's least value is no less than the minimum, and a half step beside it at most
    least, step = drawn["critical_friction"].min("theta"), float(np.diff(drawn["theta"])[0])
    assert ((least >= drawn["least_friction"]) & (least <= drawn["least_friction"] * (1.0 + 2.0 * step**2))).all()
    for side in range(2):
        at_edge = uniform.interp(theta=drawn["edges"][side].values)
        assert at_edge.values == pytest.approx(drawn["edge_friction"].values, rel=1e-3)
    assert float(uniform.interp(theta=math.pi / 3)) == pytest.approx(float(drawn["sixty_degrees_friction"]), rel=1e-3)


def test_the_drawn_force_grows_without_bound_above_mu_C_alone(drawn: xr.Dataset) -> None:
    near = drawn["slip_force"].where(drawn["distance"] < 1e-8, drop=True)
    above = drawn["slip_friction"] > drawn["singular_friction"]
    assert np.isnan(near.where(~above, drop=True)).all()
    arrived = near.where(above, drop=True).dropna("slip", how="all")
    assert arrived.sizes["slip"] > 10
    assert (arrived.isel(distance=-1) > 2.0 * arrived.isel(distance=0)).all()
