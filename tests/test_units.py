"""Units against formulas: every scene of the library agrees, and what is made to disagree is found and named."""

from __future__ import annotations

import builtins
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
import sympy as sp
from command_line import run_json
from scene_files import TEMPLATE, read

import painleve
from painleve.errors import InputError
from painleve.mechanics.units import dimension
from painleve.mechanics.units.check import Agreement, UnitsCheck, check_units
from painleve.mechanics.units.dimension import Disagreement, read_unit, unit_of

pytest.importorskip("pint")


def open_in(scene_text: str) -> dict[str, tuple[Agreement, str]]:
    found = check_units(read(scene_text))
    return {f.what: (f.agreement, f.sentence) for f in found.open}


@pytest.mark.parametrize("name", painleve.SCENE_NAMES)
def test_the_units_of_a_library_scene_agree(name: str) -> None:
    found = check_units(painleve.load_scene(name))
    assert (found.open, found.agreement) == ((), Agreement.AGREES)
    named = " ".join(f.what for f in found.findings)
    assert all(word in named for word in ("height g", "kinetic energy of", "force of", "placement of", "velocity of"))


def test_the_scene_that_new_scene_writes_agrees() -> None:
    assert check_units(read(TEMPLATE)).agreement is Agreement.AGREES


def test_the_readme_s_own_scene_agrees() -> None:
    readme = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
    (text, *_) = re.findall(r"```toml\n(.*?)```", readme, flags=re.DOTALL)
    assert check_units(read(text)).agreement is Agreement.AGREES


LINK = """
name = "link"
sentence = "a uniform link on a joint, over a floor"
[parameters]
m = { unit = "kg", sentence = "mass", default = 3 }
l = { unit = "m", sentence = "length", default = "2/5" }
c = { unit = "N m s", sentence = "friction in the joint", default = "1/10" }
mu = { unit = "1", sentence = "coefficient of friction", default = "1/2" }
[mechanism]
gravity = [0, 0, "-9.81"]
[[body]]
name = "link"
parent = "world"
position = [0, 0, "l/2"]
mass = "m"
centre = [0, 0, "-l/2"]
inertia = ["m*l**2/12", "m*l**2/12", 0]
[[body.joint]]
name = "hip"
kind = "revolute"
axis = [0, -1, 0]
damping = "c"
force = "-c*u_hip"
[contact]
body = "link"
point = [0, 0, "-l"]
[friction]
kind = "segment"
mu = "mu"
"""


def test_of_a_mechanism_each_field_has_its_unit_and_what_follows_from_them_is_not_asked() -> None:
    found = check_units(read(LINK))
    assert found.agreement is Agreement.AGREES
    named = {f.what for f in found.findings}
    assert {"mass of link", "inertia of link", "damping of hip", "force of hip", "touching point of link"} <= named
    assert not [name for name in named if "kinetic" in name]


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ('mass = "m"', 'mass = "l"', "mass of link"),
        ('"m*l**2/12", "m*l**2/12"', '"m*l**2/12", "m*l/12"', "inertia of link"),
        ('damping = "c"', 'damping = "m"', "damping of hip"),
        ('force = "-c*u_hip', 'force = "-c*hip', "force of hip"),
        ('point = [0, 0, "-l"]', 'point = [0, 0, "-m"]', "touching point of link"),
        ("-c*u_hip", "c*u_hip*sin(t)", "force of hip"),
    ],
)
def test_of_a_mechanism_a_formula_with_another_unit_than_its_field_is_named(old: str, new: str, what: str) -> None:
    found = check_units(read(LINK.replace(old, new)))
    assert [f.what for f in found.findings if f.agreement is Agreement.DISAGREES] == [what]


# --- what does not agree ---------------------------------------------------------------------------------------------

M = 'm = { unit = "kg"'
BROKEN = {
    "a unit that is none": (M, 'm = { unit = "kilo"', "unit of parameter m", "'kilo' is no unit that is known"),
    "a unit in words": (M, 'm = { unit = "as you like"', "unit of parameter m", "is no unit that is known"),
    "a unit with a sum": (M, 'm = { unit = "kg + g"', "unit of parameter m", "'kg + g' is not written as a unit"),
    "a unit that would take for ever": (M, 'm = { unit = "9**9**9**9"', "unit of parameter m", "is not written as"),
    "a mass in metres": (M, 'm = { unit = "m"', "kinetic energy of x", "it has the unit m, and an energy over"),
    "a length in millimetres": ('l = { unit = "m"', 'l = { unit = "mm"', "height g", "are added"),
    "an angle in degrees": (
        'theta = { unit = "rad", sentence = "incl',
        'theta = { unit = "deg", sentence = "incl',
        "height g",
        "is taken of theta, which has the unit 0.0174533",
    ),
    "an energy without its square": (
        "m*(u_x**2 + u_y**2)/2",
        "m*u_x**2/2 + m*l*u_y**2/2",
        "kinetic energy of y",
        "unit kg m",
    ),
    "a potential without gravity": ("m*gravity*y", "m*y", "force of y", "it has the unit kg, and the force of y"),
    "a height that is none": (
        'height = "y - l*sin(theta)"',
        'height = "y*l - l**2*sin(theta)"',
        "height g",
        "it has the unit m^2",
    ),
    "a displacement that is none": (
        '"x - l*cos(theta)"',
        '"x/l - cos(theta)"',
        "tangential displacement 1 with x",
        "unit m^-1",
    ),
    "friction with a unit": ('mu = { unit = "1"', 'mu = { unit = "N"', "friction mu", "and a pure number is 1"),
    "a key of another unit": ('slip = { unit = "m/s"', 'slip = { unit = "m"', "velocity of x", "are added"),
    "a default of another unit": ("m*l**2/3", "m*l/3", "default of I", "it has the unit kg m, and the parameter I"),
}


@pytest.mark.parametrize(("old", "new", "what", "said"), BROKEN.values(), ids=BROKEN)
def test_a_unit_that_does_not_agree_is_named_with_what_it_is_and_what_it_should_be(old, new, what, said) -> None:
    assert old in TEMPLATE
    agreement, sentence = open_in(TEMPLATE.replace(old, new, 1))[what]
    assert agreement is Agreement.DISAGREES
    assert said in sentence


def test_a_number_that_may_hide_a_unit_leaves_a_quantity_unchecked_and_says_so() -> None:
    found = open_in(TEMPLATE.replace("m*gravity*y", "9.81*m*y"))
    assert set(found) == {"force of y"}
    agreement, sentence = found["force of y"]
    assert agreement is Agreement.UNCHECKED
    assert sentence.endswith("only if a number in it has a unit; give that number a name and a unit, as a parameter")


def test_a_small_number_hides_none() -> None:
    assert open_in(TEMPLATE.replace("m*gravity*y", "2*m*y"))["force of y"][0] is Agreement.DISAGREES


def test_a_scene_all_in_millimetres_agrees_with_itself() -> None:
    """The system of units is the scene's own; a picture wants metres."""
    text = TEMPLATE.replace('unit = "m"', 'unit = "mm"').replace('"m/s"', '"mm/s"').replace('"m/s^2"', '"mm/s^2"')
    text = text.replace('"kg m^2"', '"kg mm^2"')
    assert {what for what in open_in(text) if not what.startswith("outline")} == set()


# --- the arithmetic --------------------------------------------------------------------------------------------------

L, T = sp.symbols("L T", positive=True)
OF = {L: read_unit("m"), T: read_unit("s")}


@pytest.mark.parametrize(
    ("formula", "unit"),
    [
        (L / T**2, "m/s^2"),
        (sp.sqrt(L**2 + 4 * L**2), "m"),
        (sp.atan2(L, 2 * L) + sp.pi, "1"),
        (sp.Abs(L) * sp.sign(T), "m"),
        (sp.exp(-T / (T + 1 * T)) * sp.sqrt(L) * sp.sqrt(L**5), "m^3"),
        (sp.Max(L, 2 * L), "m"),
        (0 * L + 5, "1"),
    ],
    ids=str,
)
def test_the_unit_of_a_formula_is_what_dimensional_analysis_gives(formula: sp.Expr, unit: str) -> None:
    assert unit_of(formula, OF, lenient=False).agrees(read_unit(unit))


@pytest.mark.parametrize("formula", [L + T, L + 1, sp.sin(L), sp.exp(T), sp.atan2(L, T), sp.Max(L, T)], ids=str)
def test_a_formula_that_mixes_units_has_none(formula: sp.Expr) -> None:
    with pytest.raises(Disagreement):
        unit_of(formula, OF, lenient=True)


def test_a_unit_agrees_with_itself_in_other_words() -> None:
    for one, other in (
        ("N", "kg m/s^2"),
        ("J", "N m"),
        ("1/rad^2", "1"),
        ("N s/m", "kg/s"),
        ("1/(kg m)", "kg^-1 m^-1"),
    ):
        assert read_unit(one).agrees(read_unit(other))
    assert not read_unit("km").agrees(read_unit("m"))
    assert str(read_unit("km")) == "1000 m"


# --- the command line ------------------------------------------------------------------------------------------------


def test_check_says_what_agrees_and_what_does_not(capsys, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rod.toml").write_text(TEMPLATE.replace('m = { unit = "kg"', 'm = { unit = "kilo"', 1))
    facts = run_json(capsys, "check", "rod.toml", "--state", "sliding")["units"]
    assert facts["status"] == "does not agree"
    assert [x["what"] for x in facts["open"]] == ["unit of parameter m"]
    assert "height g" in facts["agree"]
    assert (
        painleve_prints(capsys, "check", "rod.toml", "--state", "sliding").count("'kilo' is no unit that is known") == 1
    )
    assert run_json(capsys, "check", "slender_rod")["units"]["status"] == "agrees"


def painleve_prints(capsys, *words: str) -> str:
    from painleve.cli import main

    assert main(list(words)) == 0
    return capsys.readouterr().out


@pytest.fixture
def without_pint(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """As if pint were not installed."""
    known = builtins.__import__

    def refusing(name: str, *rest: object, **more: object) -> object:
        if name == "pint":
            raise ImportError(name)
        return known(name, *rest, **more)  # type: ignore[arg-type]

    for function in (dimension._registry, read_unit):
        function.cache_clear()
    monkeypatch.setattr(builtins, "__import__", refusing)
    yield
    for function in (dimension._registry, read_unit):
        function.cache_clear()


@pytest.mark.usefixtures("without_pint")
def test_without_pint_check_does_the_rest_and_says_so_in_one_line(capsys) -> None:
    said = painleve_prints(capsys, "check", "slender_rod", "--state", "sliding")
    assert "units: not checked: pint is not installed; painleve[units] brings it, or pip install pint" in said
    assert "(H1) proved" in said
    with pytest.raises(InputError, match="pint is not installed"):
        check_units(painleve.load_scene("slender_rod"))


def test_what_is_found_is_one_value(capsys) -> None:
    found: UnitsCheck = painleve.check_units(painleve.load_scene("bead"))
    assert found.as_dict() == {"status": "agrees", "agree": [f.what for f in found.findings], "open": []}
