"""Strict numerics for every test: floating-point errors raise, chance is fixed, pictures need no screen."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import settings

# set before matplotlib is imported anywhere, and inherited by the commands that tests start
os.environ["MPLBACKEND"] = "Agg"
os.environ["PAINLEVE_QUIET"] = "1"  # on a slow day what takes a second would add a line to what a test reads

# The same examples on every run and machine: a failure in CI is a failure at home. No deadline: the first call of a
# jitted function takes a second, the next a microsecond.
settings.register_profile("painleve", derandomize=True, deadline=None, database=None)
settings.load_profile("painleve")


@pytest.fixture(autouse=True)
def raise_on_floating_point_errors(request: pytest.FixtureRequest) -> Iterator[None]:
    """NumPy divisions by zero, overflows and invalid operations raise; the mark `allow_fp_errors` lets them pass."""
    if request.node.get_closest_marker("allow_fp_errors"):
        yield
    else:
        with np.errstate(divide="raise", over="raise", invalid="raise"):
            yield


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Ctrl-C is heard, by this process and those that it starts, even where the parent ignores it.

    What a shell starts in the background inherits an ignored SIGINT; Python then installs no handler, and so do its
    children. A handler, unlike a signal that is ignored, does not outlive an exec: children start with the default.
    """
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
