"""The arguments that choose a method of distance and its options, and a progress bar for those that take long."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields

from painleve.cli.common import count, real
from painleve.errors import InputError

__all__ = ["add_method", "read_method"]


def add_method(parser: argparse.ArgumentParser) -> None:
    """--method and the options of all methods; one that is given must belong to the method chosen."""
    parser.add_argument("--method", default="sample", metavar="NAME", help="sample (default), optimise or certify")
    parser.add_argument("--samples", type=count, metavar="N", help="sample: number of samples (default 1e6)")
    parser.add_argument("--seed", type=count, metavar="S", help="sample: seed (default 0)")
    parser.add_argument("--sampler", metavar="NAME", help="sample: kronecker (default), uniform or boundary")
    parser.add_argument("--threads", type=count, metavar="T", help="sample: threads (default: all cores)")
    parser.add_argument("--arithmetic", choices=("automatic", "taylor", "plain"), help="sample: evaluation near q")
    parser.add_argument("--width", type=real, metavar="W", help="certify: relative width aimed at (default 1e-6)")
    parser.add_argument("--budget", type=count, metavar="BOXES", help="certify: boxes after which it stops")


@contextmanager
def read_method(options: argparse.Namespace, *, quiet: bool = False) -> Iterator[tuple[str, object]]:
    """(name, options) of the method chosen; unless quiet, a bar on stderr shows progress while the context lasts."""
    from painleve.asymptotics.methods import find_method

    kind = find_method(options.method).options
    known = {f.name for f in fields(kind)}
    given: dict[str, object] = {}
    for name in ("samples", "seed", "sampler", "threads", "arithmetic", "width", "budget"):
        value = getattr(options, name)
        if value is None:
            continue
        if name not in known:
            raise InputError(f"--{name} is not an option of the method {options.method}")
        given[name] = value
    if quiet or "progress" not in known or "samples" not in known:
        yield options.method, kind(**given)
        return
    from tqdm import tqdm

    total = kind(**given).samples
    with tqdm(total=total, unit=" samples", unit_scale=True, leave=False, delay=1.0, disable=None) as bar:
        yield options.method, kind(**given, progress=bar.update)
