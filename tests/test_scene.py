"""Scenes that are wrong are refused in one line that names the symbol or the shape; right ones carry their units."""

from __future__ import annotations

import pytest
import sympy as sp

from painleve.errors import InputError
from painleve.mechanics.friction import Segment
from painleve.mechanics.library import SCENE_NAMES, load_scene
from painleve.mechanics.scene import Coordinate, NamedState, Parameter, Scene, StateKey, make_scene

X, Y = (Coordinate(name=n, unit="m", sentence=f"coordinate {n}") for n in ("x", "y"))
MU = Parameter(name="mu", unit="1", sentence="coefficient of friction", default="1/2", range="nonnegative")
KEY = StateKey(name="slip", unit="m/s", sentence="tangential speed")
x, y, mu, u_x, u_y = X.symbol, Y.symbol, MU.symbol, X.velocity, Y.velocity
zeta = sp.Symbol("zeta", real=True)


def extra(name: str) -> Parameter:
    return Parameter(name=name, unit="1", sentence="another", default="1")


def block(**changes: object) -> Scene:
    """A block on a floor, with something changed."""
    parts: dict[str, object] = {
        "name": "block",
        "sentence": "a block",
        "source": "a test",
        "coordinates": (X, Y),
        "parameters": (MU,),
        "inertia": sp.eye(2),
        "constraint": -y,
        "tangential_displacements": (x,),
        "friction": Segment(minus=mu, plus=mu),
        "keys": (KEY,),
    }
    return make_scene(**(parts | changes))


def energy(expression: sp.Expr) -> dict[str, object]:
    return {"inertia": None, "kinetic_energy": expression}


WRONG = {
    "undeclared in M": ({"inertia": sp.diag(zeta, 1)}, "undeclared symbol zeta in M"),
    "a velocity in M": ({"inertia": sp.Matrix([[1, u_x], [u_x, 1]])}, "undeclared symbol u_x in M"),
    "undeclared in g": ({"constraint": zeta - y}, "undeclared symbol zeta in g"),
    "undeclared in H": ({"tangential_displacements": (zeta * x,)}, "undeclared symbol zeta in H"),
    "undeclared in the force": ({"force": sp.Matrix([zeta, 0])}, "undeclared symbol zeta in f"),
    "undeclared in the potential": ({"potential": zeta * y}, "undeclared symbol zeta in f"),
    "undeclared in the friction": ({"friction": Segment(minus=mu, plus=zeta)}, "undeclared symbol zeta in the fr"),
    "undeclared in a rule": ({"placement": {"x": zeta}}, "undeclared symbol zeta in a state key's rule"),
    "a name with other assumptions": ({"constraint": -sp.Symbol("y")}, "build formulas from the `symbol`"),
    "a rule for nothing": ({"velocity": {"z": mu}}, "gives z, which is not one of x, y"),
    "a rule for no parameter": ({"contact_parameters": {"depth": mu}}, "gives depth, which is not one of mu"),
    "M not symmetric": ({"inertia": sp.Matrix([[1, 2], [x, 4]])}, r"M\[x, y\] = 2 but M\[y, x\] = x"),
    "M too large": ({"inertia": sp.eye(3)}, r"M has shape \(3, 3\); 2 coordinates need \(2, 2\)"),
    "M not square": ({"inertia": sp.ones(1, 2)}, r"M has shape \(1, 2\); 2 coordinates need \(2, 2\)"),
    "force too long": ({"force": sp.ones(3, 1)}, r"the force has shape \(3, 1\); it needs \(2, 1\)"),
    "force and potential": ({"force": sp.zeros(2, 1), "potential": y}, "give a potential or a force, not both"),
    "M and energy": ({"kinetic_energy": u_x**2 + u_y**2}, "give either the kinetic energy or the inertia"),
    "neither M nor energy": ({"inertia": None}, "give either the kinetic energy or the inertia"),
    "a linear term": (energy(u_x**2 + u_y**2 + u_x), "not a quadratic form in the velocities u_x, u_y; left over: u_x"),
    "a constant term": (energy(u_x**2 + u_y**2 + mu), "not a quadratic form .* left over: mu"),
    "a fourth power": (energy(u_x**4 + u_y**2), "not a quadratic form"),
    "a root": (energy(sp.sqrt(u_x**2 + u_y**2)), "not a quadratic form"),
    "two coordinates of one name": ({"coordinates": (X, X)}, "x is declared twice"),
    "two parameters of one name": ({"parameters": (MU, MU)}, "mu is declared twice"),
    "a parameter named like a coordinate": ({"parameters": (MU, extra("x"))}, "x is declared twice"),
    "a parameter named like a velocity": ({"parameters": (MU, extra("u_x"))}, "u_x is declared twice"),
    "a parameter named like the time": ({"parameters": (MU, extra("t"))}, "t is declared twice"),
    "two keys of one name": ({"keys": (KEY, KEY)}, "slip is declared twice"),
    "a key named like a parameter": (
        {"keys": (StateKey(name="mu", unit="1", sentence="a key"),)},
        "mu is declared twice",
    ),
    "two states of one name": (
        {"states": [NamedState(name="rest", sentence="at rest", keys={}, parameters={})] * 2},
        "rest is declared",
    ),
    "no constraint": ({"constraint": mu}, "g does not depend on any coordinate"),
    "friction without displacement": ({"tangential_displacements": ()}, "0 tangential displacements with a segment"),
    "displacement without friction": ({"friction": None}, "1 tangential displacements with no friction section"),
    "two displacements": ({"tangential_displacements": (x, y)}, "2 tangential displacements with a segment"),
}


@pytest.mark.parametrize(("changes", "message"), WRONG.values(), ids=WRONG.keys())
def test_a_wrong_scene_is_refused_in_one_line_that_names_what_is_at_fault(changes, message):
    with pytest.raises(InputError, match=rf"^scene block: .*{message}") as caught:
        block(**changes)
    assert str(caught.value).isprintable()


def test_the_block_itself_is_accepted_so_each_refusal_has_one_cause():
    scene = block()
    assert (scene.dimension, scene.contact.section.dimension) == (2, 1)
    assert scene.contact.tangents == sp.Matrix([1, 0])
    assert block(friction=None, tangential_displacements=()).contact.section.dimension == 0


def test_a_formula_given_as_text_is_never_run():
    """sympify of text would evaluate it."""
    for changes in ({"constraint": "print(1)"}, {"tangential_displacements": ("x",)}):
        with pytest.raises(sp.SympifyError):
            block(**changes)
    with pytest.raises(sp.SympifyError):
        Segment(minus="mu", plus="mu")


def test_plain_numbers_are_coefficients_of_friction():
    assert block(friction=Segment(minus=0, plus=2)).contact.section == Segment(minus=sp.Integer(0), plus=sp.Integer(2))


def test_the_energy_of_a_skew_written_quadratic_form_gives_the_symmetric_inertia():
    """M = Hessian of the energy: (u_x + 3 u_y)^2/2 + u_x u_y(1 + cos x)."""
    scene = block(**energy((u_x + 3 * u_y) ** 2 / 2 + u_y**2 / 2 + u_x * u_y * sp.cos(x)))
    assert scene.inertia == sp.Matrix([[1, 3 + sp.cos(x)], [3 + sp.cos(x), 10]])


def test_the_gyroscopic_force_does_the_work_that_changes_the_kinetic_energy_of_a_force_free_motion():
    """With no applied force u.(f - dM/dt u/2) = 0: the energy u.M u/2 is kept."""
    scene = block(inertia=sp.Matrix([[2 + sp.sin(y), x * y], [x * y, 3 + x**2]]))
    u = sp.Matrix(scene.u)
    rate = sum((scene.inertia.diff(q) * v for q, v in zip(scene.q, scene.u, strict=True)), sp.zeros(2, 2))
    assert sp.expand((u.T * (scene.force + rate * u / 2))[0]) == 0
    assert scene.force != sp.zeros(2, 1)


@pytest.mark.parametrize("name", SCENE_NAMES)
def test_every_symbol_of_the_library_carries_a_sentence_and_a_unit(name):
    scene = load_scene(name)
    for thing in (*scene.coordinates, *scene.parameters, *scene.keys):
        assert len(thing.sentence.split()) >= 1
        assert thing.unit
    for state in scene.states:
        assert state.sentence
    assert scene.sentence
    assert scene.source


def test_an_unknown_scene_parameter_or_state_is_answered_with_what_there_is():
    rod = load_scene("slender_rod")
    with pytest.raises(InputError, match=r"no scene 'rod'.*slender_rod, worn_tip_rod, two_link_arm"):
        load_scene("rod")
    with pytest.raises(InputError, match="no parameter 'nu'; it has m, l, I, mu, gravity"):
        rod.parameter("nu")
    with pytest.raises(InputError, match="no state 'x'; named states: sliding, paradox, critical, double_zero"):
        rod.state("x")
