"""`painleve derive SCENE`: the derivation as a person would write it."""

from __future__ import annotations

import argparse
from typing import Any

from painleve.cli.common import add_command, add_json, add_scene, print_json


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "derive",
        run,
        sentence="print M, g, n, the friction section, gamma and mu_c of a scene",
        example="painleve derive slender_rod --latex",
    )
    add_scene(parser)
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--latex", action="store_true", help="print LaTeX")
    add_json(form)  # type: ignore[arg-type]


def run(options: argparse.Namespace) -> int:
    from painleve.mechanics.library import load_scene
    from painleve.mechanics.show import as_dict, as_latex, as_text

    scene = load_scene(options.scene)
    if options.json:
        print_json(as_dict(scene))
    else:
        print(as_latex(scene) if options.latex else as_text(scene))
    return 0
