"""The command line keeps its contract with scripts, and answers bad input with one line and status 2."""

import math
import subprocess
import sys
from pathlib import Path

import pytest
import sympy as sp
from command_line import assert_refused, run_json
from planar_scenes import SCENE_NAMES
from scene_files import TEMPLATE

from painleve.cli import main
from painleve.mechanics.library import load_scene

NAMED = [(scene, state.name) for scene in SCENE_NAMES for state in load_scene(scene).states]


@pytest.mark.parametrize(("scene", "state"), NAMED)
def test_classify_answers_with_the_keys_and_values_that_scripts_rely_on(scene, state, capsys):
    answer = run_json(capsys, "classify", scene, "--state", state)
    kinds = {"none": "point", "negative": "pair", "critical_approached": "segment", "critical_isolated": "segment"}
    assert answer["limit_set"] == kinds[answer["branch"]]
    assert len(answer["u_minus"]) == len(answer["u_tilde"]) == load_scene(scene).dimension
    assert math.copysign(1, answer["gamma"]) == {"none": 1, "negative": -1}.get(answer["branch"], 1)


def test_classify_names_the_law_and_answers_for_coulomb_s_where_the_two_differ(capsys):
    """A slip 60 degrees off the rod: law (7) jumps, Coulomb's law does not; straight on both stick."""
    turned = ["classify", "spatial_rod", "--state", "theta=atan(2)", "slip=1", "heading=60*pi/180", "--set", "mu=2"]
    assert run_json(capsys, *turned)["branch"] == "negative"
    coulomb = run_json(capsys, *turned, "--law", "coulomb")
    assert (coulomb["law"], [s["kind"] for s in coulomb["solutions"]]) == ("coulomb", ["open"])
    assert main(turned) == 0
    assert "law        projection, the paper's (7); in space not Coulomb's" in capsys.readouterr().out
    assert main([*turned, "--law", "coulomb"]) == 0
    assert "Coulomb's law admits no jump" in capsys.readouterr().out


@pytest.mark.parametrize("state", ["paradox", "critical", "sliding"])
def test_in_the_plane_coulomb_s_right_velocities_are_those_of_the_projection(state, capsys):
    projection = run_json(capsys, "classify", "slender_rod", "--state", state)
    coulomb = run_json(capsys, "classify", "slender_rod", "--state", state, "--law", "coulomb")
    found = {s["kind"]: s for s in coulomb["solutions"]}
    assert coulomb["u_minus"] == projection["u_minus"] == found["open"]["velocity"]
    jumps = projection["limit_set"] != "point"
    assert ("stick" in found) == jumps
    assert not jumps or found["stick"]["velocity"] == pytest.approx(projection["u_tilde"], abs=1e-15)
    assert (coulomb["kind"] == "family") == (projection["limit_set"] == "segment")


@pytest.mark.parametrize("name", ["robot.xml", "models/robot.xml", "robot.urdf"])
def test_a_robot_s_file_is_refused_by_what_is_read(name, capsys, tmp_path, monkeypatch):
    line = assert_refused(["classify", name, "--state", "a"], capsys, tmp_path, monkeypatch)
    assert "of files, those in TOML are read" in line


@pytest.mark.parametrize(
    ("arguments", "branch"),
    [
        (["--set", "mu=4/3"], "critical_approached"),
        (["--set", "mu=1333333/1000000"], "none"),
        (["--set", "mu=1333334/1000000"], "negative"),
        (["slip=1", "--set", "mu=2"], "none"),
    ],
)
def test_classify_parts_frictions_that_differ_by_a_millionth_and_the_senses_of_slip(arguments, branch, capsys):
    answer = run_json(capsys, "classify", "slender_rod", "--state", "theta=atan(2)", *arguments)
    assert answer["branch"] == branch


def test_a_spin_moves_the_centre_so_that_the_velocity_stays_tangential(capsys):
    state = ["theta=atan(2)", "slip=-1", "omega=3"]
    answer = run_json(capsys, "classify", "slender_rod", "--state", *state, "--set", "mu=2")
    u_x, u_y, omega = answer["u_minus"]
    assert omega == 3
    assert u_y == pytest.approx(3 / math.sqrt(5), rel=1e-15)
    assert u_x + omega * 2 / math.sqrt(5) == pytest.approx(-1, rel=1e-14)


def test_distance_answers_with_one_sided_bounds_and_counts_that_add_up(capsys):
    words = ("distance", "slender_rod", "--state", "paradox", "--eps", "1e-3", "--samples", "1e4")
    answer = run_json(capsys, *words)
    assert answer["method"] == "sample"
    assert answer["eps"] == 1e-3
    assert answer["excess_Aeps_A"]["upper"] is None
    assert answer["excess_A_Aeps"]["lower"] is None
    assert answer["hausdorff"] == {"lower": answer["excess_Aeps_A"]["lower"], "upper": None}
    assert sum(answer["counts"].values()) == 10_000
    assert run_json(capsys, *words, "--threads", "1") == answer


def test_the_hard_critical_state_is_not_misjudged_although_its_sample_sees_nothing(capsys):
    words = ("distance", "slender_rod", "--state", "double_zero", "--eps", "1e-6", "--samples", "1e4")
    answer = run_json(capsys, *words)
    assert answer["excess_A_Aeps"]["upper"] > 0.1  # the sample's own bound: true, and useless
    assert answer["witnessed"]["upper"] < 1e-9


@pytest.mark.parametrize("method", ["optimise", "certify"])
@pytest.mark.parametrize(("scene", "state"), [("slender_rod", "double_zero"), ("worn_tip_rod", "isolated")])
def test_the_rate_is_what_the_distance_divided_by_eps_tends_to(scene, state, method, capsys):
    constant = run_json(capsys, "rate", scene, "--state", state)["C"]
    answer = run_json(capsys, "distance", scene, "--state", state, "--eps", "1e-9", "--method", method)
    assert answer["method"] == method
    assert answer["excess_Aeps_A"]["lower"] / 1e-9 == pytest.approx(constant, rel=2e-6)
    upper = answer["excess_Aeps_A"]["upper"]
    assert upper is None if method == "optimise" else upper / 1e-9 == pytest.approx(constant, rel=2e-6)


def test_a_certified_sweep_proves_what_a_sampled_one_leaves_consistent(tmp_path, capsys):
    words = ["sweep", "slender_rod", "--state", "paradox", "--eps", "1e-2", "1e-4", "-o", str(tmp_path / "sweep.h5")]
    for method, status in (("sample", "consistent"), ("certify", "proved")):
        (verdict,) = run_json(capsys, *words, "--method", method)["verdicts"]
        assert (verdict["branch"], verdict["status"]) == ("negative", status)


BAD = [
    ["classify", "no_such_scene", "--state", "paradox"],
    ["classify", "slender_rod", "--state", "no_such_state"],
    ["classify", "slender_rod"],
    ["classify", "slender_rod", "--state", "paradox", "critical"],
    ["classify", "slender_rod", "--state", "slip=-1"],
    ["classify", "slender_rod", "--state", "paradox", "--set", "mu=-1"],
    ["classify", "slender_rod", "--state", "paradox", "--set", "mu=nan"],
    ["classify", "slender_rod", "--state", "paradox", "--set", "mu"],
    ["classify", "slender_rod", "--state", "paradox", "--set", "nu=1"],
    ["classify", "slender_rod", "--state", "theta=atan(2)", "y=1"],
    ["classify", "slender_rod", "--state", "theta=atan(2)", "u_y=1"],
    ["classify", "slender_rod", "--state", "theta=__import__('os').system('echo pwned')"],
    ["classify", "slender_rod", "--state", "theta=9**9**9**9"],
    ["classify", "slender_rod", "--state", "theta=1/0"],
    ["classify", "slender_rod", "--state", "paradox", "--set", "m=0"],
    ["classify", "two_link_arm", "--state", "phi1=0", "phi2=0"],
    ["distance", "slender_rod", "--state", "paradox"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "0"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "-1e-3"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "nan"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "inf"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "1e-300"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "1e300", "--method", "certify"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "1e-3", "--method", "guess"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "1e-3", "--sampler", "dice"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "1e-3", "--samples", "0"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "1e-3", "--samples", "1.5"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "1e-3", "--seed", "-1"],
    ["distance", "slender_rod", "--state", "paradox", "--eps", "1e-3", "--width", "0.1"],
    ["sweep", "slender_rod", "--state", "paradox", "--eps", "1e-3", "-o", "no/such/folder/x.h5"],
    ["sweep", "slender_rod", "--state", "paradox", "--eps", "1e-3", "-o", "."],
    ["sweep", "slender_rod", "--state", "paradox", "--eps", "1e-3", "--over", "mu", "-o", "x.h5"],
    ["sweep", "slender_rod", "--state", "paradox", "--eps", "1e-3", "--over", "nu=1,2", "-o", "x.h5"],
    ["study", "no_such_study"],
    ["derive", "slender_rod", "--latex", "--json"],
    ["no_such_command"],
    [],
]


@pytest.mark.parametrize("words", BAD, ids=" ".join)
def test_bad_input_gives_one_line_on_stderr_status_2_and_no_file(words, capsys, tmp_path, monkeypatch):
    assert_refused(words, capsys, tmp_path, monkeypatch)


def test_the_error_for_a_state_off_the_constraint_says_by_how_much(capsys):
    main(["classify", "slender_rod", "--state", "theta=atan(2)", "y=1"])
    assert f"{2 / math.sqrt(5) - 1:.6g}" in capsys.readouterr().err


def test_a_scene_without_named_states_is_asked_for_its_keys_alone(capsys, tmp_path, monkeypatch):
    (tmp_path / "my_rod.toml").write_text(TEMPLATE[: TEMPLATE.index("[states.")], encoding="utf-8")
    line = assert_refused(["classify", "my_rod.toml"], capsys, tmp_path, monkeypatch)
    assert line == "painleve: --state is needed: theta=EXPR slip=EXPR omega=EXPR\n"


def test_degrees_are_pointed_out_and_a_full_turn_is_not(capsys):
    assert main(["classify", "slender_rod", "--state", "theta=60°"]) == 2
    assert "60*pi/180" in capsys.readouterr().err
    assert main(["classify", "slender_rod", "--state", "theta=60"]) == 0
    assert capsys.readouterr().err.startswith("painleve: note: theta = 60 is in radians")
    assert main(["classify", "slender_rod", "--state", "theta=2*pi - 1"]) == 0
    assert capsys.readouterr().err == ""


def test_the_text_of_the_rate_names_the_scene_the_state_and_what_c_is(capsys):
    assert main(["rate", "slender_rod", "--state", "paradox"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "slender_rod, paradox: d_H(A, A_eps) = C eps + o(eps) with A = {u-, u_tilde}"
    exact = sp.sqrt(sp.sqrt(105) / 10 + sp.Rational(221, 120))
    assert float(lines[1].split()[1].rstrip(",")) == pytest.approx(float(exact), rel=1e-13)
    assert lines[2] == f"  closed form  {exact}"


def test_a_sweep_says_of_a_point_that_failed_why(tmp_path, capsys):
    words = ["sweep", "slender_rod", "--state", "paradox", "--eps", "1e-2", "--samples", "100", "--over", "mu=2,-2"]
    assert main([*words, "-o", str(tmp_path / "x.h5")]) == 0
    assert "paradox mu=-2: failed: scene slender_rod: parameter mu = -2 must be" in capsys.readouterr().out


def test_listing_the_studies_imports_none_of_them():
    code = "import sys, painleve.cli as cli; cli.main(['study']); print([m for m in sys.modules if 'study_' in m])"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "Theorem 1, branch by branch" in answer.stdout
    assert answer.stdout.splitlines()[-1] == "[]"


COMMANDS = [
    "scenes",
    "new-scene",
    "derive",
    "check",
    "classify",
    "distance",
    "rate",
    "sweep",
    "study",
    "plot",
    "simulate",
    "ensemble",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_helps_with_an_example(command, capsys):
    with pytest.raises(SystemExit) as stopped:
        main([command, "--help"])
    assert stopped.value.code == 0
    assert "example: painleve " + command in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize("scene", ["slender_rod", "worn_tip_rod", "two_link_arm", "ellipse", "minimal", "bead"])
def test_a_derivation_is_printed_in_all_three_forms(scene, capsys):
    name, sentence, latex = (
        ("critical_friction", "critical friction", r"\mu_c(q) = ")
        if load_scene(scene).contact.section.dimension
        else ("gamma", "negative in the paradox", r"\gamma(q) = ")
    )
    assert name in run_json(capsys, "derive", scene)["formulas"]
    assert main(["derive", scene]) == 0
    assert sentence in capsys.readouterr().out
    assert main(["derive", scene, "--latex"]) == 0
    assert latex in capsys.readouterr().out


def test_a_command_line_in_a_fresh_process_needs_no_heavy_imports_to_help():
    heavy = ("sympy", "numba", "xarray", "matplotlib")
    code = f"import sys, painleve.cli; print([m for m in {heavy} if m in sys.modules])"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"


def test_a_sweep_is_written_whole_and_reads_back_with_xarray_alone(tmp_path, capsys):
    import xarray

    target = tmp_path / "sweep.h5"
    words = ["sweep", "slender_rod", "--state", "theta=atan(2)", "--over", "mu=1,4/3,2", "--eps", "1e-1", "1e-2"]
    answer = run_json(capsys, *words, "--samples", "2000", "-o", str(target))
    assert Path(answer["file"]) == target
    with xarray.open_dataset(target, engine="h5netcdf") as dataset:
        assert dataset.sizes["mu"] == 3
        assert dataset.sizes["eps"] == 2
