"""Hops: under a contact test on g the tip leaves the floor for some steps, and the next contact makes up for them.

An explicit step raises a sliding tip by O(h^2) at once, g < 0 in the next step, and a contact's impulse is that of all
steps since the contact before. A rod whose force is 5.71 times its weight: 5.71, 0, 11.43, 5.71, each over the step.
"""

from __future__ import annotations

import numpy as np

from painleve.core.codes import ContactMode
from painleve.core.motion_codes import Change

__all__ = ["HOPS", "force_over_hops", "free_steps_of_hops"]

HOPS = (
    "impulses come in hops, as they do under the strict test g >= 0: in {free} of {steps} steps the tip is off the "
    "floor between two contacts; contact_force is the average, each impulse over the time since the contact before"
)


def force_over_hops(
    t: np.ndarray, impulse: np.ndarray, branch: np.ndarray, change: np.ndarray, touches: bool
) -> np.ndarray:
    """Normal impulses (n,) over the time since the contact before, at that contact and over the hop that led to it.

    0 in flight; not a number where an impulse is of no force: at a jump of the velocity, and at row 0. `touches`: the
    first row is a contact.
    """
    rows, contacts = np.arange(len(t)), np.flatnonzero(branch != ContactMode.FREE)
    before = np.concatenate([[0], contacts])[:-1]
    if len(contacts) and not touches:
        before[0] = contacts[0] - 1
    lasting = change[contacts] == Change.ORDINARY
    mean = np.where(lasting, impulse[contacts] / (t[contacts] - t[before]), np.nan)
    following = np.searchsorted(contacts, rows)  # the contact at a row, or the next one after it
    in_hop = np.isin(following, np.flatnonzero(lasting)) & (rows > np.append(before, len(t))[following])
    force = np.where(in_hop, np.append(mean, 0.0)[following], 0.0)
    force[contacts] = mean
    force[0] = np.nan
    return force


def free_steps_of_hops(branch: np.ndarray, change: np.ndarray) -> int:
    """How many steps without contact lie between two contacts the second of which is no impact."""
    contacts = np.flatnonzero(branch != ContactMode.FREE)
    gaps, landings = np.diff(contacts) - 1, change[contacts[1:]]
    return int(gaps[(landings != Change.IMPACT) & (landings != Change.FRICTIONAL_IMPACT)].sum())
