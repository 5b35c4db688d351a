"""Contact quantities in floats, maps of friction and scans: against closed forms, dense algebra and brute force."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
import sympy as sp

from painleve.cli import main
from painleve.errors import InputError
from painleve.kernels.contact_numbers import make_contact_numbers
from painleve.mechanics.derive import derive
from painleve.mechanics.library import load_scene
from painleve.mechanics.scene_file import read_scene
from painleve.mechanics.state import make_state
from painleve.sweep.configurations import make_configurations
from painleve.sweep.friction_map import frictions, map_friction
from painleve.sweep.scan import scan_friction
from tests.tape_values import values_at

CHAIN = """
name = "chain"
sentence = "a planar chain of {n} equal links, its end on the floor"
[parameters]
mu = {{ unit = "1", sentence = "friction", default = 1, range = "nonnegative" }}
[mechanism]
gravity = [0, 0, "-9.81"]
{bodies}
[contact]
body = "link{n}"
point = [0, 0, -1]
plane = {{ tangent = [1, 0, 0] }}
[friction]
kind = "segment"
mu = "mu"
"""
LINK = """
[[body]]
name = "link{i}"
parent = "{parent}"
position = [0, 0, {z}]
mass = 1
centre = [0, 0, "-1/2"]
inertia = ["1/12", "1/12", 0]
[[body.joint]]
name = "q{i}"
kind = "revolute"
axis = [0, -1, 0]
limits = ["-3/2", "3/2"]
"""


def chain(tmp_path, n):
    links = "".join(LINK.format(i=i, parent=f"link{i - 1}" if i > 1 else "world", z=-(i > 1)) for i in range(1, n + 1))
    path = tmp_path / f"chain{n}.toml"
    path.write_text(CHAIN.format(n=n, bodies=links), encoding="utf-8")
    return read_scene(path)


def chain_by_hand(q):
    """M, w_n and H of the chain by its absolute angles from the downward vertical, and those from the joints'."""
    n, angles = len(q), np.cumsum(q)
    reach = np.tril(np.ones((n, n)))
    M = np.zeros((n, n))
    for k in range(n):
        lengths = np.where(np.arange(n) < k, 1.0, np.where(np.arange(n) == k, 0.5, 0.0))
        J = np.array([lengths * np.cos(angles), lengths * np.sin(angles)]) @ reach
        M += J.T @ J + np.outer(reach[k], reach[k]) / 12.0
    return M, np.sin(angles) @ reach, np.cos(angles) @ reach


@pytest.mark.parametrize("n", [2, 4, 7])
def test_a_chain_of_many_links_has_the_quantities_of_dense_algebra(tmp_path, n):
    scene = chain(tmp_path, n)
    assert bool(scene.definitions.steps) == (n > 3)
    numbers = make_contact_numbers(scene)
    q = np.random.default_rng(n).uniform(-1, 1, (20, n))
    table = numbers.at(q, np.full((20, 1), 1.0))
    for i in range(20):
        M, w_n, H = chain_by_hand(q[i])
        Y = np.linalg.solve(M, w_n)
        assert table["a"][i] == pytest.approx(w_n @ Y, rel=1e-12)
        assert table["b_1"][i] == pytest.approx(H @ Y, rel=1e-11, abs=1e-13)
        assert table["squared"][i] == pytest.approx(w_n @ w_n, rel=1e-13)
        assert table["least"][i] == pytest.approx(w_n @ Y - abs(H @ Y), rel=1e-11, abs=1e-12)
        assert 0.0 < table["pivot"][i] <= np.diag(M).max()


def test_a_short_chain_is_a_scene_like_any_other_and_a_long_one_says_what_it_cannot(tmp_path):
    assert derive(chain(tmp_path, 2)).a.free_symbols
    with pytest.raises(InputError, match="would fill pages"):
        derive(chain(tmp_path, 4))


@pytest.mark.parametrize("name", ["slender_rod", "two_link_arm", "spatial_rod", "spatial_rod_ellipse", "minimal"])
def test_contact_numbers_are_the_closed_forms(name):
    scene = load_scene(name)
    state = make_state(scene, scene.states[0].name)
    d, numbers = derive(scene), make_contact_numbers(scene)
    q = np.array([[state.number(x) for x in state.q]])
    p = np.array([[state.number(state.parameters[x.name]) for x in scene.parameters]])
    table = numbers.at(q, p)
    assert table["a"][0] == pytest.approx(state.number(d.a), rel=1e-13)
    for j in range(scene.contact.section.dimension):
        assert table[f"b_{j + 1}"][0] == pytest.approx(state.number(d.couplings[j]), rel=1e-12, abs=1e-14)
    gamma = table["least"][0] / table["squared"][0]
    assert gamma == pytest.approx(state.number(d.gamma), rel=1e-12, abs=1e-14)


def test_a_matrix_that_is_not_positive_definite_is_not_admitted():
    scene = load_scene("minimal")
    numbers = make_contact_numbers(scene)
    configurations = make_configurations(scene, ["x", "y"], scene.states[0].name)
    q, _, p = configurations([np.array([0.0, 3.0]), np.array([0.0, 0.0])])
    symbols = (*scene.q, *scene.p)
    points = [dict(zip(symbols, np.concatenate(at), strict=True)) for at in zip(q, p, strict=True)]
    M = np.array([values_at(scene, list(scene.inertia), point) for point in points])
    definite = [np.all(np.linalg.eigvalsh(m.reshape(2, 2)) > 0) for m in M]
    assert definite == [True, False]
    assert frictions(numbers, q, p).admitted.tolist() == definite


def test_the_map_of_the_rod_is_its_closed_form_by_the_sense_of_the_slip():
    theta = np.linspace(0.2, 1.5, 27)
    found = map_friction(load_scene("slender_rod"), {"theta": theta, "mu": np.array([1.0, 2.0])}, state="paradox")
    expected = (np.tan(theta) + 4.0 / np.tan(theta)) / 3.0
    assert found["critical_friction_minus"].values[:, 0] == pytest.approx(expected, rel=1e-12)
    assert np.isinf(found["critical_friction_plus"].values).all()
    assert ((found["gamma_negative_minus"].values == 2) == (np.array([1.0, 2.0]) > expected[:, None])).all()
    assert (found["gamma_negative_plus"].values == 1).all()
    mirrored = map_friction(load_scene("slender_rod"), {"theta": math.pi - theta}, state="paradox")
    assert mirrored["critical_friction_plus"].values == pytest.approx(expected, rel=1e-12)


def test_the_scan_of_the_rod_finds_four_thirds_and_the_share_of_its_band():
    found = scan_friction(
        load_scene("slender_rod"), ranges={"theta": ("0.1", "1.5")}, parameters={"mu": 2}, points=4096
    )
    assert found.least["plus"] is None
    assert found.least["minus"].upper == pytest.approx(4.0 / 3.0, rel=1e-14)
    assert found.least["minus"].at["theta"] == pytest.approx(math.atan(2.0), abs=1e-6)
    low, high = (math.atan((6.0 + sign * math.sqrt(20.0)) / 2.0) for sign in (-1, 1))
    share = (high - low) / 1.4
    assert abs(found.negative["minus"].value - share) <= 4.0 * found.negative["minus"].error + 1e-3
    assert found.paradoxical == found.negative["minus"]


def test_the_scan_of_a_long_chain_is_not_above_brute_force(tmp_path):
    scene = chain(tmp_path, 4)
    found = scan_friction(scene, points=2048)
    assert set(found.ranges) == {"q1", "q2", "q3", "q4"}
    q = np.random.default_rng(5).uniform(-1.5, 1.5, (20_000, 4))
    brute = frictions(make_contact_numbers(scene), q, np.ones((20_000, 1)))
    for sense in ("plus", "minus"):
        assert found.least[sense].upper <= brute.critical[sense].min()
        at = np.array([[found.least[sense].at[f"q{i}"] for i in range(1, 5)]])
        assert (
            frictions(make_contact_numbers(scene), at, np.ones((1, 1))).critical[sense][0] == found.least[sense].upper
        )


def test_configurations_in_which_another_point_is_lower_are_left_out(tmp_path):
    text = (tmp_path / "x.toml", chain(tmp_path, 2).text)
    text[0].write_text(
        text[1].replace("[friction]", '[[contact.other]]\nbody = "link1"\npoint = [0, 0, -1]\n[friction]')
    )
    scene = read_scene(text[0])
    configurations = make_configurations(scene, ["q1", "q2"])
    q, _, p = configurations([np.array([0.0, 0.0]), np.array([0.5, 2.5])])  # the second one turns the end up
    numbers = make_contact_numbers(scene)
    assert frictions(numbers, q, p).admitted.tolist() == [True, False]
    assert frictions(numbers, q, p, others_above=False).admitted.tolist() == [True, True]


def test_map_and_scan_on_the_command_line(tmp_path, capsys):
    target = tmp_path / "rod.png"
    assert main(["map", "slender_rod", "--over", "theta=0.2:1.5:30", "mu=0:2:20", "-o", str(target), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["minus"]["least_on_grid"] >= 4.0 / 3.0
    assert target.stat().st_size > 1000
    assert main(["plot", str(target.with_suffix(".h5")), "-o", str(tmp_path / "again.png")]) == 0
    capsys.readouterr()
    assert main(["scan", "slender_rod", "--range", "theta=0.1,3/2", "--points", "512", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["mu_c"]["lower"] is None
    assert found["mu_c"]["upper"] == pytest.approx(4.0 / 3.0)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("map", "slender_rod", "--over", "thet=0:1"), "did you mean theta"),
        (("map", "slender_rod", "--over", "theta=1:0"), "is empty"),
        (("map", "slender_rod", "--over", "theta=0:1:1e9"), "number of points"),
        (("map", "slender_rod", "--over", "theta=0:1", "mu=0:1", "m=1:2"), "one or two axes"),
        (("map", "bead", "--over", "x=0:1"), "friction"),
        (("scan", "slender_rod"), "--range"),
        (("scan", "slender_rod", "--range", "theta=0"), "LOW,HIGH"),
        (("scan", "slender_rod", "--range", "theta=0,1", "--state", "theta=1"), "cannot vary"),
    ],
)
def test_bad_words_are_one_line(words, said, capsys):
    assert main(list(words)) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


def test_symbols_of_a_mechanism_s_masses_stay_symbols(tmp_path):
    path = tmp_path / "chain.toml"
    text = (
        chain(tmp_path, 2)
        .text.replace("mass = 1\n", 'mass = "m"\n')
        .replace("[mechanism]", 'm = { unit = "kg", sentence = "mass of a link", default = 1 }\n[mechanism]')
    )
    path.write_text(text, encoding="utf-8")
    scene = read_scene(path)
    m = sp.Symbol("m", positive=True)
    assert scene.inertia.subs(m, 1) == chain(tmp_path, 2).inertia
