"""What the repository promises about itself: lock, set-up commands and version agree, and no text names a machine."""

from __future__ import annotations

import re
import subprocess
import tomllib
from pathlib import Path

import numpy as np
import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
FOLDERS = (".ci", "data/reference", "docs", "notebooks", "painleve", "studies", "tests")
METADATA = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
LOCK = (ROOT / "requirements.lock").read_text(encoding="utf-8")
MUTANTS_LOCK = (ROOT / "mutants.lock").read_text(encoding="utf-8")
ROBOTS_LOCK = (ROOT / "robots.lock").read_text(encoding="utf-8")

# The only places that a text here may send a reader to.
PUBLISHERS = {"arxiv.org", "doi.org"}


def texts() -> dict[str, str]:
    """The project's text files by their path, without what the tools make beside them."""
    paths = [path for path in ROOT.iterdir() if path.is_file() and path.name != ".git"]  # a work tree's is a file
    paths += [path for folder in FOLDERS for path in (ROOT / folder).rglob("*") if path.is_file()]
    found = {}
    for path in paths:
        if not {"__pycache__", ".ipynb_checkpoints"} & set(path.parts):
            try:
                found[path.relative_to(ROOT).as_posix()] = path.read_text(encoding="utf-8")
            except UnicodeDecodeError:
                continue
    return found


def direct_requirements() -> list[Requirement]:
    project = METADATA["project"]
    extras = [requirements for extra, requirements in project["optional-dependencies"].items() if extra != "robots"]
    lists = [project["dependencies"], *extras, METADATA["build-system"]["requires"]]
    return [Requirement(line) for requirements in lists for line in requirements]


def locked_versions(name: str, lock: str = LOCK) -> list[str]:
    pins = re.findall(r"^([A-Za-z0-9._-]+)==([^ ;\\]+)", lock, flags=re.MULTILINE)
    return [version for pinned, version in pins if canonicalize_name(pinned) == canonicalize_name(name)]


def makefile_phony_targets() -> list[str]:
    (line,) = re.findall(r"^\.PHONY: (.+)$", (ROOT / "Makefile").read_text(encoding="utf-8"), flags=re.MULTILINE)
    return line.split()


def readme_setup_commands() -> list[str]:
    section = (ROOT / "README.md").read_text(encoding="utf-8").split("## Set-up\n")[1].split("\n## ")[0]
    return [line for block in re.findall(r"```sh\n(.*?)```", section, flags=re.DOTALL) for line in block.splitlines()]


@pytest.mark.parametrize("requirement", direct_requirements(), ids=str)
def test_every_direct_dependency_is_locked_within_its_bounds(requirement: Requirement) -> None:
    versions = locked_versions(requirement.name)
    assert versions
    assert all(requirement.specifier.contains(version) for version in versions)


@pytest.mark.parametrize(
    ("group", "lock", "shared"),
    [("mutants", MUTANTS_LOCK, ("pytest", "packaging", "pluggy")), ("robots", ROBOTS_LOCK, ("numpy",))],
    ids=["mutants", "robots"],
)
def test_what_is_installed_on_demand_is_locked_and_shares_its_versions(group: str, lock: str, shared: tuple) -> None:
    for line in METADATA["dependency-groups"][group]:
        requirement = Requirement(line)
        versions = locked_versions(requirement.name, lock)
        assert versions
        assert all(requirement.specifier.contains(version) for version in versions)
    for name in shared:
        assert locked_versions(name, lock) == locked_versions(name)


def test_the_extra_for_robots_is_what_its_tests_install() -> None:
    assert METADATA["project"]["optional-dependencies"]["robots"] == METADATA["dependency-groups"]["robots"]


@pytest.mark.parametrize("lock", [LOCK, MUTANTS_LOCK, ROBOTS_LOCK], ids=["requirements", "mutants", "robots"])
def test_every_locked_version_has_a_hash(lock: str) -> None:
    entries = re.split(r"^(?=[A-Za-z0-9])", lock, flags=re.MULTILINE)[1:]
    assert len(entries) > 5
    assert [entry.split()[0] for entry in entries if "--hash=sha256:" not in entry] == []


@pytest.mark.parametrize("lock", [LOCK, MUTANTS_LOCK, ROBOTS_LOCK], ids=["requirements", "mutants", "robots"])
def test_a_lock_names_no_address_and_no_path(lock: str) -> None:
    assert re.findall(r"[a-z+]+://\S*|--(?:extra-)?index-url|--find-links|(?<![\w.])/\S+", lock) == []


def test_no_text_sends_a_reader_anywhere_but_to_publishers() -> None:
    strangers = {
        (path, host)
        for path, text in texts().items()
        for host in re.findall(r"https?://([\w.-]+)", text)
        if host not in PUBLISHERS
    }
    assert strangers == set()


def test_no_text_names_a_folder_of_one_machine() -> None:
    folder = re.compile(r"(?<![\w.*}])/(?:work|root|home|Users|tmp|opt)/\w")
    assert {path: folder.findall(text) for path, text in texts().items() if folder.search(text)} == {}


def test_the_readme_sets_up_with_two_commands_that_make_knows_and_ci_runs() -> None:
    commands = readme_setup_commands()
    assert commands == ["make study", "make test"]
    assert {command.removeprefix("make ") for command in commands} <= set(makefile_phony_targets())
    ci_lines = (ROOT / ".ci/run").read_text(encoding="utf-8").splitlines()
    expected = ["make test", "make test-slow", "make test-robots", "make study STUDY_FLAGS=--quick"]
    assert [line for line in ci_lines if line.startswith("make ")] == expected


def test_every_test_is_run_by_one_of_the_two_targets_that_ci_runs() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    runs = re.findall(r"-m pytest (.+)$", makefile, flags=re.MULTILINE)
    of_all = [found for run in runs if (found := re.findall(r'-m ("not slow"|slow) tests', run))]
    assert of_all == [['"not slow"'], ["slow"]]


def test_make_help_says_a_sentence_about_every_target() -> None:
    run = subprocess.run(["make", "--no-print-directory"], cwd=ROOT, capture_output=True, text=True, check=True)
    described = [line.split(maxsplit=2) for line in run.stdout.splitlines()]
    assert [target for _, target, _ in described] == makefile_phony_targets()
    assert all(len(sentence.split()) >= 3 for _, _, sentence in described)


def test_the_citation_has_the_version_of_the_package() -> None:
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.findall(r"^version: (.+)$", citation, flags=re.MULTILINE) == [METADATA["project"]["version"]]


@pytest.mark.parametrize(
    ("dividend", "divisor"), [(1.0, 0.0), (0.0, 0.0), (1e300, 1e-300)], ids=["by zero", "invalid", "overflow"]
)
def test_a_floating_point_error_raises_in_a_test(dividend: float, divisor: float) -> None:
    with pytest.raises(FloatingPointError):
        np.float64(dividend) / np.float64(divisor)


@pytest.mark.allow_fp_errors
@pytest.mark.filterwarnings("ignore:divide by zero:RuntimeWarning")
def test_a_test_that_asks_for_it_may_divide_by_zero() -> None:
    assert np.float64(1.0) / np.float64(0.0) == np.inf
