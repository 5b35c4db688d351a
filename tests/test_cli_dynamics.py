"""`simulate` and `ensemble` keep their contract with scripts, and answer bad input with one line and status 2."""

import math
from dataclasses import replace

import numpy as np
import pytest
from command_line import assert_refused, run_json
from planar_scenes import SCENE_NAMES

import painleve.dynamics.fixed_step as fixed_step
from painleve.cli import main
from painleve.core.motion_codes import MemberOutcome
from painleve.dynamics.simulate import simulate
from painleve.dynamics.start import Start
from painleve.kernels.motion.compiled import make_motion
from painleve.mechanics.library import load_scene
from painleve.mechanics.state import make_state
from painleve.store import load

STOSS = ("slender_rod", "--state", "stoss")
SLIDING = ("slender_rod", "--state", "sliding")
SHORT = ("--step", "1e-2", "--until", "0.1")
FALL = ("slender_rod", "--q", "x=0", "y=3", "theta=pi/2", "--u", "x=1/2")


def test_simulate_answers_with_the_keys_that_scripts_rely_on(capsys):
    answer = run_json(capsys, "simulate", *STOSS, "--step", "1e-3", "--until", "0.9")
    assert answer["status"] == "reached_end"
    assert answer["steps"] == 900
    assert answer["coordinates"] == ["x", "y", "theta"]
    (jump,) = answer["jumps"]
    assert set(jump) == {"time", "kind", "gamma"}
    assert jump["kind"] == "jump_without_collision"
    assert set(answer["proposition1"]) == {"membership", "dissipation", "norm_bound"}
    assert max(answer["proposition1"].values()) < 1e-12
    found = simulate(make_state(load_scene("slender_rod"), "stoss"), step=1e-3, until=0.9)
    assert jump["time"] == found.jumps[0].time
    assert answer["final"]["q"] == found.q[-1].tolist()
    assert answer["final"]["u"] == found.u[-1].tolist()


def test_a_rod_in_free_fall_is_where_the_steps_of_the_scheme_put_it(capsys):
    answer = run_json(capsys, "simulate", *FALL, "--set", "gravity=10", "--step", "0.125", "--until", "0.5")
    # q moves with the old velocity: y = 3 - 10 h^2 (0 + 1 + 2 + 3), exactly in binary
    assert answer["final"]["q"] == [0.25, 3 - 10 * 0.125**2 * 6, math.pi / 2]
    assert answer["final"]["u"] == [0.5, -5.0, 0.0]
    assert answer["jumps"] == []


def test_the_margins_of_proposition_1_are_those_of_its_own_scheme_alone(capsys):
    assert run_json(capsys, "simulate", *SLIDING, *SHORT, "--scheme", "moreau_jean")["proposition1"] is None


@pytest.mark.parametrize("scene", SCENE_NAMES)
def test_the_text_of_simulate_names_every_coordinate_and_margin(scene, capsys):
    assert main(["simulate", scene, "--state", "sliding", *SHORT]) == 0
    text = capsys.readouterr().out
    for word in ("membership", "dissipation", "norm_bound", *(c.name for c in load_scene(scene).coordinates)):
        assert word in text


def test_options_of_the_scheme_change_what_it_does(capsys):
    words = ("simulate", *FALL, *SHORT, "--scheme", "moreau_jean")
    heights = [run_json(capsys, *words, "--option", f"theta={theta}")["final"]["q"][1] for theta in ("0", "1/2", "1")]
    exact, lag = 3 - 9.81 * 0.1**2 / 2, 9.81 * 0.1 * 1e-2 / 2  # the theta-method errs by (1/2 - theta) g h t
    assert np.array(heights) == pytest.approx([exact + lag, exact, exact - lag], abs=1e-13)
    assert run_json(capsys, *words)["final"]["q"][1] == heights[1]


def test_ctrl_c_keeps_what_there_is_in_the_answer_and_in_the_file(capsys, monkeypatch, tmp_path):
    motion = make_motion(load_scene("slender_rod"))
    chunks = []

    def run(*arguments: object) -> tuple[int, int, int]:
        chunks.append(arguments)
        if len(chunks) == 3:
            raise KeyboardInterrupt
        return motion.run(*arguments)

    monkeypatch.setattr(Start, "motion", replace(motion, run=run))
    monkeypatch.setattr(fixed_step, "CHUNK", 20)
    target = tmp_path / "part.h5"
    answer = run_json(capsys, "simulate", *SLIDING, "--step", "1e-3", "--until", "0.1", "-o", str(target))
    assert answer["status"] == "interrupted"
    assert answer["steps"] == 40
    assert load(target).sizes["time"] == 41
    assert load(target).attrs["status"] == "interrupted"


def test_ensemble_lists_every_outcome_and_the_fractions_add_up(capsys):
    words = ("ensemble", *STOSS, "--step", "1e-3", "--count", "200", "--window", "0.1", "--until", "0.9")
    answer = run_json(capsys, *words)
    assert set(answer["fractions"]) == {o.label for o in MemberOutcome if o is not MemberOutcome.NOT_RUN}
    assert sum(answer["fractions"].values()) == pytest.approx(1.0, abs=1e-15)
    assert answer["fractions"]["flight"] == 0
    assert 0.8 < answer["jump_time"]["min"] <= answer["jump_time"]["median"] <= answer["jump_time"]["max"] < 0.84
    assert run_json(capsys, *words, "--threads", "1") == answer


def test_the_text_of_ensemble_names_the_scene_the_state_and_what_its_numbers_are(capsys):
    assert main(["ensemble", *SLIDING, *SHORT, "--count", "20", "--spread", "0.5"]) == 0
    first, second = capsys.readouterr().out.splitlines()
    assert first.startswith("slender_rod, sliding: 20 trajectories; ")
    assert "1.0000 of them; 95% interval of the probability [0.8389, 1.0000]" in second


def test_an_ensemble_without_jumps_has_no_jump_time(capsys):
    answer = run_json(capsys, "ensemble", *SLIDING, *SHORT, "--count", "20", "--spread", "0.5")
    assert answer["jump_time"] is None
    assert answer["fractions"]["jump"] == 0


def test_an_ensemble_over_balls_starts_elsewhere_than_at_their_centre(capsys):
    words = ("ensemble", "slender_rod", "--state", "paradox", *SHORT, "--count", "400")
    centre = run_json(capsys, *words, "--spread", "0")["fractions"]
    around = run_json(capsys, *words, "--ball", "1e-3")["fractions"]
    assert max(centre.values()) == 1
    assert max(around.values()) < 1


MANY = ("ensemble", *SLIDING, *SHORT)
BAD = [
    ["simulate", *SLIDING, "--step", "0", "--until", "1"],
    ["simulate", *SLIDING, "--step", "-1e-3", "--until", "1"],
    ["simulate", *SLIDING, "--step", "nan", "--until", "1"],
    ["simulate", *SLIDING, "--step", "1e-3", "--until", "-1"],
    ["simulate", *SLIDING, "--step", "1e-3", "--until", "inf"],
    ["simulate", *SLIDING, "--step", "1e-9", "--until", "1"],
    ["simulate", *SLIDING, "--step", "1e-300", "--until", "1e300"],
    ["simulate", *SLIDING, "--step", "1e300", "--until", "1e301"],
    ["simulate", *SLIDING, "--step", "1e308", "--until", "1e308"],
    ["simulate", *SLIDING, "--step", "1e-3"],
    ["simulate", "slender_rod", *SHORT],
    ["simulate", "no_such_scene", "--state", "sliding", *SHORT],
    ["simulate", "slender_rod", "--q", "x=0", "y=1/2", "theta=pi/2", *SHORT],
    ["simulate", "slender_rod", "--q", "x=0", "y=2", *SHORT],
    ["simulate", "slender_rod", "--q", "x=0", "y=2", "theta=1", "--u", "z=1", *SHORT],
    ["simulate", "slender_rod", "--q", "x=0", "y=2", "theta=__import__('os').system('echo pwned')", *SHORT],
    ["simulate", *FALL, "--state", "sliding", *SHORT],
    ["simulate", *SLIDING, *SHORT, "--scheme", "leapfrog"],
    ["simulate", *SLIDING, *SHORT, "--contact-tolerance", "-1e-9"],
    ["simulate", *SLIDING, *SHORT, "--scheme", "stewart_trinkle", "--contact-tolerance", "1e-9"],
    ["simulate", *SLIDING, *SHORT, "--option", "theta=1/2"],
    ["simulate", *SLIDING, *SHORT, "--option", "theta"],
    ["simulate", *SLIDING, *SHORT, "--scheme", "moreau_jean", "--option", "theta=2"],
    ["simulate", *SLIDING, *SHORT, "--scheme", "moreau_jean", "--option", "theta=half"],
    ["simulate", *SLIDING, *SHORT, "--scheme", "compliant", "--option", "stiffness=-1"],
    ["simulate", *SLIDING, *SHORT, "--scheme", "event_driven", "--option", "rtol=-1"],
    ["simulate", *SLIDING, *SHORT, "--scheme", "event_driven", "--option", "atol=0"],
    ["simulate", *SLIDING, *SHORT, "--scheme", "event_driven", "--option", "rtol=1/10^14"],
    ["simulate", *SLIDING, *SHORT, "-o", "no/such/folder/x.h5"],
    ["simulate", *SLIDING, *SHORT, "-o", "."],
    ["simulate", *SLIDING, "--step", "1e300", "--until", "1e301", "-o", "x.h5"],
    [*MANY, "--count", "0", "--spread", "1"],
    [*MANY, "--count", "-5", "--spread", "1"],
    [*MANY, "--count", "1.5", "--spread", "1"],
    [*MANY, "--count", "10"],
    [*MANY, "--count", "10", "--spread", "1", "--ball", "1"],
    [*MANY, "--count", "10", "--spread", "-1"],
    [*MANY, "--count", "10", "--ball", "nan"],
    [*MANY, "--count", "10", "--window", "1"],
    [*MANY, "--count", "10", "--spread", "1", "--seed", "-1"],
    [*MANY, "--count", "10", "--spread", "1", "--threads", "0"],
    [*MANY, "--count", "10", "--spread", "1", "--scheme", "event_driven"],
    [*MANY, "--count", "10", "--spread", "1", "--scheme", "moreau_jean", "--option", "theta=-1"],
    [*MANY, "--count", "10", "--spread", "1", "--contact-tolerance", "-1"],
    ["ensemble", *SLIDING, "--step", "0", "--until", "1", "--count", "10", "--spread", "1"],
    ["ensemble", *SLIDING, "--step", "1e-3", "--until", "-1", "--count", "10", "--spread", "1"],
    ["plot", "no_such_file.h5"],
    ["plot", "no_such_file.h5", "--animate"],
]


@pytest.mark.allow_fp_errors
@pytest.mark.parametrize("words", BAD, ids=" ".join)
def test_bad_input_gives_one_line_on_stderr_status_2_and_no_file(words, capsys, tmp_path, monkeypatch):
    assert_refused(words, capsys, tmp_path, monkeypatch)
