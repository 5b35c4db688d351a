"""`painleve ensemble SCENE`: many trajectories that differ in their step size or in their initial state."""

from __future__ import annotations

import argparse
from typing import Any

from painleve.cli.common import add_command, add_json, count, print_json, real
from painleve.cli.motion import add_motion, read_options, read_start


def register(commands: Any) -> None:
    parser = add_command(
        commands,
        "ensemble",
        run,
        sentence="count how trajectories end that differ in step size or initial state",
        example="painleve ensemble slender_rod --state stoss --step 1e-4 --spread 1 --count 1000 --until 1",
    )
    add_motion(parser)
    parser.add_argument("--count", type=count, required=True, metavar="N", help="number of trajectories")
    spread = parser.add_mutually_exclusive_group(required=True)
    spread.add_argument("--spread", type=real, metavar="DECADES", help="steps log-uniform in [H, H 10^DECADES]")
    spread.add_argument("--window", type=real, metavar="W", help="steps uniform in [H (1 - W), H (1 + W)]")
    spread.add_argument("--ball", type=real, metavar="EPS", help="initial states uniform in the balls of radius EPS")
    parser.add_argument("--seed", type=count, default=0, metavar="S", help="seed (default 0)")
    parser.add_argument("--threads", type=count, metavar="T", help="threads (default: all cores)")
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    from tqdm import tqdm

    from painleve.dynamics.ensemble import run_ensemble
    from painleve.dynamics.outline import start_notes

    with tqdm(total=options.count, unit=" trajectories", leave=False, delay=1.0, disable=None) as bar:
        found = run_ensemble(
            read_start(options),
            scheme=options.scheme,
            step=options.step,
            until=options.until,
            count=options.count,
            spread=options.spread,
            window=options.window,
            ball=options.ball,
            seed=options.seed,
            threads=options.threads,
            contact_tolerance=options.contact_tolerance,
            options=read_options(options),
            progress=bar.update,
        )
    facts = found.as_dict()
    if options.json:
        print_json(facts)
        return 0
    print(f"{found.start.scene.name}, {found.start.label}: {facts['count']} trajectories; {facts['ending']}")
    for note in start_notes(found.start):
        print(f"  note          {note}")
    for outcome, number in found.counts.items():
        if number:
            low, high = found.interval(outcome)
            print(
                f"  {outcome.label:13} {found.fraction(outcome):.4f} of them; "
                f"95% interval of the probability [{low:.4f}, {high:.4f}]"
            )
    if found.jump_time is not None:
        print("  jump time     min {:.9g}, median {:.9g}, max {:.9g} s".format(*found.jump_time))
    return 0
