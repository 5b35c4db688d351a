"""What tests of the command line share: a command's answer as JSON, and what bad input must come to."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from painleve.cli import main


def run_json(capsys: pytest.CaptureFixture[str], *words: str) -> Any:
    """What a command that succeeds prints with --json."""
    assert main([*words, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def assert_refused(
    words: Sequence[str], capsys: pytest.CaptureFixture[str], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> str:
    """Run in a folder: status 2, one line on stderr, nothing else, no file. Returns the line."""
    monkeypatch.chdir(folder)
    before = sorted(folder.iterdir())
    assert main(list(words)) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("painleve: ")
    assert captured.err.count("\n") == 1
    assert sorted(folder.iterdir()) == before
    return captured.err
