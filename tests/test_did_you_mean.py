"""Whoever mistypes a name is told the name that is like it, or where that name belongs, in one line."""

from __future__ import annotations

from pathlib import Path

import pytest
from command_line import assert_refused

from painleve.errors import nearest

ROD = ["slender_rod", "--state", "paradox"]
MOVE = ["--step", "1e-3", "--until", "1e-2"]

TYPED = {
    "a command": (["clasify", *ROD], "no command 'clasify' (did you mean classify?); choose one of scenes, "),
    "a scene": (["classify", "slendr_rod", "--state", "x"], "no scene 'slendr_rod' (did you mean slender_rod?)"),
    "a state": (["classify", "slender_rod", "--state", "paradoks"], "no state 'paradoks' (did you mean paradox?)"),
    "a key": (["classify", "slender_rod", "--state", "tetha=1"], "no state key 'tetha' (did you mean theta?)"),
    "a component": (["classify", *ROD, "u_tetha=1"], "no state key 'u_tetha' (did you mean u_theta?)"),
    "a parameter": (["classify", *ROD, "--set", "gravty=1"], "no parameter 'gravty' (did you mean gravity?)"),
    "a coordinate": (["simulate", "slender_rod", "--q", "x=0", "y=1", "thet=1", *MOVE], "(did you mean theta?)"),
    "a key to go along": (["critical", "slender_rod", "--along", "thet"], "go along (did you mean theta?)"),
    "a swept name": (
        ["sweep", *ROD, "--over", "omga=1,2", "--eps", "1e-2", "-o", "x.h5"],
        "no parameter and no state key 'omga' (did you mean omega?)",
    ),
    "a method": (["distance", *ROD, "--eps", "1e-3", "--method", "optimize"], "(did you mean optimise?)"),
    "a sampler": (["distance", *ROD, "--eps", "1e-3", "--sampler", "kroneker"], "(did you mean kronecker?)"),
    "a scheme": (["simulate", *ROD, *MOVE, "--scheme", "moreau"], "no 'moreau' (did you mean moreau_jean?)"),
    "an option of a scheme": (
        ["simulate", *ROD, *MOVE, "--scheme", "moreau_jean", "--option", "teta=1"],
        "no option 'teta' (did you mean theta?)",
    ),
    "a study": (["study", "theorm1"], "study: no 'theorm1' (did you mean theorem1?)"),
    "an option": (
        ["classify", *ROD, "--jsn"],
        "no option '--jsn' (did you mean --json?); see painleve classify --help",
    ),
    "an option, and a required one is missing": (
        ["distance", *ROD, "--epz", "1e-3"],
        "no option '--epz' (did you mean",
    ),
    "a parameter among the keys": (["classify", *ROD, "mu=2"], "no state key 'mu' (it is a parameter, and given"),
    "a key among the parameters": (["classify", *ROD, "--set", "theta=1"], "no parameter 'theta' (it is a state key"),
    "a key for a state": (
        ["classify", "slender_rod", "--state", "theta"],
        "(it is a state key: give theta=EXPRESSION)",
    ),
    "a file of another kind": (
        ["classify", "robot.xml", "--state", "x"],
        "my_scene.toml; `painleve import` writes one",
    ),
    "a law": (["classify", *ROD, "--law", "coulom"], "did you mean coulomb?"),
    "an axis of a map": (["map", "slender_rod", "--over", "thta=0:1"], "'thta' (did you mean theta?)"),
    "a range of a scan": (["scan", "slender_rod", "--range", "thta=0,1"], "'thta' (did you mean theta?)"),
}


@pytest.mark.parametrize(("words", "said"), TYPED.values(), ids=TYPED)
def test_a_mistyped_name_is_answered_with_the_one_that_was_meant(words, said, capsys, tmp_path: Path, monkeypatch):
    assert said in assert_refused(words, capsys, tmp_path, monkeypatch)


@pytest.mark.parametrize("name", ["", "zzz", "q" * 10_000])
def test_a_name_that_is_like_none_is_answered_with_none(name: str) -> None:
    assert nearest(name, ["theta", "slip", "omega"]) == ""


def test_what_an_option_is_given_is_not_taken_for_an_option(capsys, tmp_path, monkeypatch) -> None:
    said = assert_refused(["classify", *ROD, "--set", "mu=--jsn"], capsys, tmp_path, monkeypatch)
    assert "no option" not in said
