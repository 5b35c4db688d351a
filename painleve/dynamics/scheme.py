"""What a scheme is: a name, its source and order, and how it makes a trajectory."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from painleve.core.motion_codes import FixedStep
from painleve.core.stepping import SteppingMethod
from painleve.dynamics.fixed_step import run_fixed_step
from painleve.dynamics.grid import TimeGrid
from painleve.dynamics.start import Start
from painleve.dynamics.trajectory import Trajectory
from painleve.errors import InputError, nearest

__all__ = ["Integrated", "Progress", "Scheme", "Stepped"]

Progress = Callable[[float], None]  # hears of the time (s) covered since it was last called


@dataclass(frozen=True, kw_only=True)
class Scheme:
    """A method: `order` is that of its velocity where the motion is smooth; `options` are numbers with their defaults.

    `tests_contact`: whether contact is found by testing g(q) >= -tolerance; other methods impose g(q) <= 0 itself.
    `friction_dimension`: the largest that it steps, 1 in the plane and 2 in space. The schemes of Moreau's law take the
    projection (7) there; others would have to solve Coulomb's law, which differs from it in space.
    """

    name: str
    sentence: str
    source: str
    order: int
    tests_contact: bool = True
    friction_dimension: int = 1
    options: Mapping[str, float] = field(default_factory=dict)

    def run(
        self, start: Start, grid: TimeGrid, tolerance: float, options: Mapping[str, float], progress: Progress
    ) -> Trajectory:
        raise NotImplementedError

    def settings(self, tolerance: float, given: Mapping[str, float] | None) -> dict[str, float]:
        """The options with defaults. Raises InputError for an unknown one or a tolerance that the method cannot use."""
        if not (tolerance >= 0.0 and tolerance < float("inf")):
            raise InputError(f"contact_tolerance: {tolerance} must be zero or a positive number")
        if tolerance > 0.0 and not self.tests_contact:
            raise InputError(f"contact_tolerance: {self.name} imposes g(q) <= 0 without a contact test; leave it at 0")
        for name in given or {}:
            if name not in self.options:
                known = ", ".join(self.options) or "none"
                raise InputError(
                    f"scheme {self.name}: no option {name!r}{nearest(name, self.options)}; it has: {known}"
                )
        return {**self.options, **(given or {})}


LEAST_RTOL = 1e-13  # below, scipy's integrators take their own


@dataclass(frozen=True, kw_only=True)
class Stepped(Scheme):
    """A compiled scheme of the one time loop; `lag(theta)`: see Trajectory.lag."""

    code: FixedStep
    lag: Callable[[float], float] = lambda theta: 0.0

    def theta(self, options: Mapping[str, float]) -> float:
        """The option theta, 0 where the scheme has none. Raises InputError."""
        theta = options.get("theta", 0.0)
        if not 0.0 <= theta <= 1.0:
            raise InputError(f"scheme {self.name}: theta = {theta} must be between 0 and 1")
        return theta

    def run(
        self, start: Start, grid: TimeGrid, tolerance: float, options: Mapping[str, float], progress: Progress
    ) -> Trajectory:
        method = SteppingMethod(int(self.code), self.theta(options), tolerance)
        return run_fixed_step(self.name, method, self.lag(method.theta), start, grid, progress)


@dataclass(frozen=True, kw_only=True)
class Integrated(Scheme):
    """A method on top of an adaptive integrator; the grid says where the trajectory is recorded."""

    integrate: Callable[[Start, TimeGrid, Mapping[str, float], Progress], Trajectory]
    tests_contact: bool = False

    def settings(self, tolerance: float, given: Mapping[str, float] | None) -> dict[str, float]:
        """The options with defaults. Raises InputError as Scheme.settings, and for numbers that are not positive."""
        options = super().settings(tolerance, given)
        for name, value in options.items():
            if not 0.0 < value < float("inf"):
                raise InputError(f"scheme {self.name}: {name} = {value} must be a positive number")
        if options["rtol"] < LEAST_RTOL:
            raise InputError(f"scheme {self.name}: rtol = {options['rtol']} is below what doubles hold; take 1e-13")
        return options

    def run(
        self, start: Start, grid: TimeGrid, tolerance: float, options: Mapping[str, float], progress: Progress
    ) -> Trajectory:
        return self.integrate(start, grid, options, progress)
