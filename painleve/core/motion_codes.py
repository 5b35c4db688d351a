"""Codes of trajectories: which scheme stepped, how a step or a trajectory ended, what an ensemble's member did."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["Change", "Ending", "FixedStep", "MemberOutcome"]


class FixedStep(IntEnum):
    """The compiled schemes of the one time loop."""

    CONTACT_DYNAMICS = 0
    MOREAU_JEAN = 1
    STEWART_TRINKLE = 2
    SCHATZMAN_PAOLI = 3
    ANITESCU_POTRA = 4


class Change(IntEnum):
    """How the law changed the velocity at a step."""

    ORDINARY = 0  # by O(h), or not at all
    IMPACT = 1  # a collision without friction
    FRICTIONAL_IMPACT = 2  # a collision with friction
    JUMP_WITHOUT_COLLISION = 3  # a jump at a tangential contact

    @property
    def label(self) -> str:
        return self.name.lower()


class Ending(IntEnum):
    """How a trajectory ended; every method uses the same codes."""

    REACHED_END = 0
    INTERRUPTED = 1
    NOT_FINITE = 2
    DEGENERATE = 3
    NOT_CONVERGED = 4
    INCONSISTENT = 5
    INDETERMINATE = 6
    STEP_SIZE_UNDERFLOW = 7
    TOO_MANY_EVENTS = 8
    THROUGH_FLOOR = 9

    @property
    def label(self) -> str:
        return self.name.lower()

    @property
    def sentence(self) -> str:
        return _SENTENCES[self]


_SENTENCES = {
    Ending.REACHED_END: "the end of the time interval was reached",
    Ending.INTERRUPTED: "interrupted: what was computed until then is kept",
    Ending.NOT_FINITE: "a coordinate or a velocity left the range of numbers: the step is too large, or the force is",
    Ending.DEGENERATE: "the contact problem is degenerate there: grad g vanishes or M is not positive definite",
    Ending.NOT_CONVERGED: "the implicit equation of the step was not solved: its iteration does not converge",
    Ending.INCONSISTENT: "inconsistent: no acceleration solves the contact problem",
    Ending.INDETERMINATE: "indeterminate: more than one acceleration solves the contact problem",
    Ending.STEP_SIZE_UNDERFLOW: "step size underflow: the integrator found no step that meets its tolerances",
    Ending.TOO_MANY_EVENTS: "more changes of contact mode than allowed",
    Ending.THROUGH_FLOOR: "the outline went through the floor, which holds up the contact point alone",
}


class MemberOutcome(IntEnum):
    """The first thing that happens to a member of an ensemble."""

    JUMP = 0  # a velocity jump without collision
    STICK = 1  # a sticking contact reached without a jump
    LIFT_OFF = 2  # contact lost: the tip moves away faster than the free motion of a few steps explains
    IMPACT = 3  # a collision
    SLIDE = 4  # none of these until the end, and contact at some time
    FLIGHT = 5  # no contact until the end
    FAILED = 6  # numbers out of range, or a step that could not be taken
    NOT_RUN = 7  # interrupted before its turn
    THROUGH_FLOOR = 8  # a point of the outline that the contact does not hold up went through the floor

    @property
    def label(self) -> str:
        return self.name.lower()
