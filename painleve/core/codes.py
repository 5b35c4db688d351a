"""Codes for what the contact law did; they stand beside every value of S."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["ContactMode"]


class ContactMode(IntEnum):
    """Branches of S(q, v) (paper, section 2)."""

    FREE = 0  # v in V(q): no contact, or v does not point outward; S = v
    STICK = 1  # the tip's velocity vanishes
    SLIP_PLUS = 2  # friction impulse on the edge s = +mu_plus of the cone
    SLIP_MINUS = 3  # friction impulse on the edge s = -mu_minus
    FRICTIONLESS = 4  # an impact on a scene without friction
    SLIP = 5  # slipping in space: friction impulse on the edge of a section of dimension 2

    @property
    def label(self) -> str:
        return self.name.lower()
