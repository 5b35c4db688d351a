"""Robots' files: M, f and J are MuJoCo's own, friction is that of its pair, and bad files end in one line."""

from __future__ import annotations

import numpy as np
import pytest

from painleve.cli import main
from painleve.errors import InputError
from painleve.mechanics.library import load_scene
from painleve.mechanics.robot_file.read import read_robot
from painleve.mechanics.robot_file.xml_text import root_of_file
from tests.robot_files import ARM, HOPPER, URDF
from tests.tape_values import values_at

mujoco = pytest.importorskip("mujoco", reason="the extra `robots` is not installed")


@pytest.fixture
def hopper(tmp_path):
    path = tmp_path / "small_hopper.xml"
    path.write_text(HOPPER, encoding="utf-8")
    return path


LOOP = '<equality><weld body1="foot" body2="stone"/></equality>'


def imported(path, target, *words):
    assert main(["import", str(path), "-o", str(target), *words]) == 0
    return load_scene(target)


def model_at(text, seed, names):
    """MuJoCo's model and data at a random state, and that state by the scene's names of the coordinates."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    data.qpos[:], data.qvel[:] = rng.uniform(-1, 1, model.nq), rng.uniform(-1, 1, model.nv)
    mujoco.mj_forward(model, data)
    index = [model.joint(name).dofadr[0] for name in names]
    return model, data, index


CASES = {
    "hopper": (HOPPER, ("--body", "foot", "--geom", "foot_geom", "--end", "0", "--planar")),
    "arm": (ARM, ("--body", "forearm", "--geom", "tip")),
    "urdf": (URDF, ("--body", "rod", "--point", "0", "0", "-1", "--planar")),
}


@pytest.mark.parametrize("case", sorted(CASES))
@pytest.mark.parametrize("seed", range(3))
def test_m_f_and_the_jacobian_are_those_of_mujoco(case, seed, tmp_path):
    text, words = CASES[case]
    path = tmp_path / ("robot.urdf" if case == "urdf" else "robot.xml")
    path.write_text(text, encoding="utf-8")
    scene = imported(path, tmp_path / "scene.toml", *words)
    names = [c.name for c in scene.coordinates]
    model, data, index = model_at(text, seed, names)
    point = dict(zip(scene.q, (data.qpos[model.joint(n).qposadr[0]] for n in names), strict=True))
    point |= dict(zip(scene.u, data.qvel[index], strict=True))
    d = scene.dimension
    M = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, M)
    found = np.array(values_at(scene, list(scene.inertia), point)).reshape(d, d)
    assert np.abs(found - M[np.ix_(index, index)]).max() <= 1e-12 * np.abs(M).max()
    force = (data.qfrc_passive - data.qfrc_bias)[index]
    assert np.abs(np.array(values_at(scene, list(scene.force), point)) - force).max() <= 1e-12 * max(
        1, np.abs(force).max()
    )
    tree = scene.tree
    body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, tree.point.body)
    local = np.array([float(x) for x in tree.point.point])
    turn = data.xmat[body].reshape(3, 3)
    normal = np.array([float(x) for x in tree.plane.normal])
    touching = data.xpos[body] + turn @ local - float(tree.point.radius) * normal
    J = np.zeros((3, model.nv))
    mujoco.mj_jac(model, data, J, None, touching, body)
    directions = np.array([normal, *([float(x) for x in t] for t in tree.plane.tangents)])
    w_n = scene.contact.normal
    if w_n is None:
        w_n = [-scene.contact.constraint.diff(x) for x in scene.q]
    W = np.array([values_at(scene, list(w_n), point)] + [values_at(scene, list(t), point) for t in _columns(scene)])
    assert np.abs(W - directions @ J[:, index]).max() <= 1e-12


def _columns(scene):
    H = scene.contact.tangents
    return [H[:, j] for j in range(H.shape[1])]


def test_friction_is_the_larger_of_the_pair_and_priority_goes_first(hopper, tmp_path):
    words = ("--body", "foot", "--geom", "foot_geom", "--end", "1", "--planar")
    assert imported(hopper, tmp_path / "a.toml", *words).parameter("mu").default == "2"
    hopper.write_text(HOPPER.replace('name="floor"', 'name="floor" priority="1"'), encoding="utf-8")
    assert imported(hopper, tmp_path / "b.toml", *words).parameter("mu").default == "1.2"
    words = ("--body", "leg", "--geom", "leg_geom", "--end", "1", "--planar")
    assert imported(hopper, tmp_path / "c.toml", *words).parameter("mu").default == "1.2"


def test_what_is_left_out_is_said(hopper, tmp_path, capsys):
    imported(hopper, tmp_path / "a.toml", "--body", "foot", "--geom", "foot_geom", "--end", "0", "--planar")
    text = (tmp_path / "a.toml").read_text(encoding="utf-8")
    assert "1 actuators" in text
    assert "stone" in text.splitlines()[1]
    assert "left out" in capsys.readouterr().out


def test_an_imported_file_reads_back_as_the_same_mechanism(hopper, tmp_path):
    scene = imported(hopper, tmp_path / "a.toml", "--body", "foot", "--geom", "foot_geom", "--end", "0", "--planar")
    robot = read_robot(hopper, {})
    for body in scene.tree.mechanism.bodies:
        own = robot.mechanism.by_name[body.name]
        assert (body.mass, body.centre, body.position, body.inertia) == (
            own.mass,
            own.centre,
            own.position,
            own.inertia,
        )
        assert [vars(j) for j in body.joints] == [vars(j) for j in own.joints]


def test_a_locked_joint_is_no_coordinate(hopper, tmp_path):
    words = ("--body", "foot", "--geom", "foot_geom", "--end", "0", "--planar", "--lock", "knee=-1/2")
    scene = imported(hopper, tmp_path / "a.toml", *words)
    assert [c.name for c in scene.coordinates] == ["rootx", "rootz", "rooty", "ankle"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--body", "fot", "--geom", "foot_geom"), "did you mean foot"),
        (("--body", "foot", "--geom", "toe"), "no geom 'toe'"),
        (("--body", "foot", "--geom", "foot_geom"), "--end 0 or --end 1"),
        (("--body", "foot", "--point", "0", "0", "__import__('os')"), "--point"),
        (("--body", "foot", "--geom", "foot_geom", "--end", "0", "--plane", "flor"), "no plane 'flor'"),
        (("--body", "foot", "--geom", "foot_geom", "--end", "0", "--lock", "knee=3"), "out of its range"),
        (("--body", "foot", "--geom", "foot_geom", "--end", "0", "--lock", "nee=0"), "no joint 'nee'"),
    ],
)
def test_what_is_not_in_the_file_is_one_line(hopper, tmp_path, capsys, words, said):
    target = tmp_path / "a.toml"
    assert main(["import", str(hopper), "-o", str(target), *words]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert not target.exists()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("<mujoco", "no XML"),
        ('<!DOCTYPE a [<!ENTITY b "c">]><mujoco>&b;</mujoco>', "document type"),
        ("<a>" * 300 + "</a>" * 300, "deep"),
        ("<scene/>", "<scene>"),
        ("<mujoco><worldbody><body><joint/></body></worldbody></mujoco>", "mass"),
        (
            HOPPER.replace("</mujoco>", '<equality><weld body1="foot" body2="stone"/></equality></mujoco>'),
            "closed loops",
        ),
    ],
)
def test_a_broken_or_hostile_file_is_one_line(tmp_path, text, said):
    path = tmp_path / "robot.xml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=said) as refusal:
        read_robot(path, {})
    assert len(str(refusal.value).splitlines()) == 1


def test_a_file_that_is_missing_or_huge_is_refused_before_it_is_read(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        root_of_file(tmp_path / "robot.xml")
    path = tmp_path / "huge.xml"
    with path.open("wb") as file:
        file.truncate(20_000_000)
    with pytest.raises(InputError, match="MB"):
        root_of_file(path)
