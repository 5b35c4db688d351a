"""What `simulate` and `ensemble` share: a start, a scheme, a step and a time."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from painleve.cli.common import add_scene, add_state, assignments, read_state, real
from painleve.errors import InputError

if TYPE_CHECKING:
    from painleve.dynamics.start import Start
    from painleve.mechanics.state import State

__all__ = ["add_motion", "read_options", "read_start"]


def add_motion(parser: argparse.ArgumentParser) -> None:
    add_scene(parser)
    add_state(parser)
    for name, what in (("q", "coordinates, all of them"), ("u", "velocities, 0 unless given")):
        parser.add_argument(
            f"--{name}", nargs="+", action="extend", default=[], metavar="NAME=EXPR", help=f"start from these {what}"
        )
    parser.add_argument(
        "--scheme",
        default="contact_dynamics",
        metavar="NAME",
        help="default contact_dynamics, the paper's; a wrong name lists them all",
    )
    parser.add_argument(
        "--option",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME=NUMBER",
        dest="scheme_options",
        help="options of the scheme, such as theta=1/2",
    )
    parser.add_argument(
        "--contact-tolerance",
        type=real,
        default=0.0,
        metavar="D",
        help="contact where g >= -D (default 0, the paper's strict test)",
    )
    parser.add_argument(
        "--project",
        action="store_true",
        help="--q and --u are rounded values of a contact: start from that contact, and say how far it is",
    )
    parser.add_argument(
        "--step", type=real, required=True, metavar="H", help="step size [s]; the last step ends at the final time"
    )
    parser.add_argument("--until", type=real, required=True, metavar="T", help="final time [s]")


def read_start(options: argparse.Namespace) -> Start | State:
    """The exact state, or the start given by --q and --u."""
    from painleve.dynamics.start import make_start
    from painleve.mechanics.library import load_scene

    if not options.q and not options.u:
        if options.project:
            raise InputError("--project: a --state is exactly on the contact; --project is for --q and --u")
        return read_state(options)
    if options.state:
        raise InputError("--state and --q/--u are two ways to give a start; use one")
    q, u = assignments(options.q, "--q"), assignments(options.u, "--u")
    parameters = assignments(options.parameters, "--set")
    return make_start(load_scene(options.scene), q=q, u=u, parameters=parameters, project=options.project)


def read_options(options: argparse.Namespace) -> dict[str, float]:
    """The scheme's options as floats."""
    from painleve.exact.parse import exact_number

    given = assignments(options.scheme_options, "--option")
    return {name: float(exact_number(value, where=f"--option {name}")) for name, value in given.items()}
