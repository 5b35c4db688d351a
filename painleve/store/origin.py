"""Where a dataset comes from: versions, scene, seed, commit and command, as text attributes."""

from __future__ import annotations

import json
import platform
import shlex
import subprocess
import sys
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from painleve.mechanics.scene import Scene

__all__ = ["PROVENANCE", "provenance"]

PROVENANCE = (
    "painleve_version",
    "git_commit",
    "scene",
    "scene_digest",
    "seed",
    "platform",
    "python_version",
    "library_versions",
    "command",
    "created",
)
LIBRARIES = ("numpy", "scipy", "sympy", "numba", "python-flint", "xarray", "h5netcdf", "h5py")
MOST_COMMAND = 10_000  # characters of a command line that are kept: its values stand in the dataset


def provenance(*, scene: Scene | str, scene_digest: str, seed: int, command: str | None = None) -> dict[str, str]:
    """Where a dataset comes from, as text attributes; `command` defaults to the command line of this process.

    `scene` is the scene, or the names of several. One that was read from a file leaves the file's text as `scene_text`:
    written to a file again, it is the scene of this dataset.
    """
    from_file = {} if isinstance(scene, str) or not scene.text else {"scene_file": scene.file, "scene_text": scene.text}
    versions = {name: metadata.version(name) for name in LIBRARIES}
    line = shlex.join([Path(sys.argv[0]).name, *sys.argv[1:]]) if command is None else command
    attributes = {
        "painleve_version": metadata.version("painleve"),
        "git_commit": _git_commit(),
        "scene": scene if isinstance(scene, str) else scene.name,
        "scene_digest": scene_digest,
        "seed": str(seed),
        "platform": platform.platform(),
        "python_version": platform.python_version(),
        "library_versions": json.dumps(versions, sort_keys=True),
        "command": line if len(line) <= MOST_COMMAND else f"{line[:MOST_COMMAND]} ... ({len(line)} characters)",
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        **from_file,
    }
    return {name: _encodable(text) for name, text in attributes.items()}


def _encodable(text: str) -> str:
    """Bytes of an argument or a file's name that are no text become escapes, as a shell would print them."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _git_commit() -> str:
    """The commit of the checkout that this package is imported from, marked if files differ from it; or "unknown"."""
    root = Path(__file__).parents[2]
    if not (root / ".git").exists():
        return "unknown"
    try:
        commit = _git(root, "rev-parse", "HEAD")
        changed = _git(root, "status", "--porcelain", "--untracked-files=no")
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return f"{commit} with changes" if changed else commit


def _git(root: Path, *arguments: str) -> str:
    run = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, text=True, check=True, timeout=10)
    return run.stdout.strip()
