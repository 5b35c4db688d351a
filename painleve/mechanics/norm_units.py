"""The units that the norms of a scene mix: its coordinates may be lengths and angles, and distances are Euclidean."""

from __future__ import annotations

from painleve.mechanics.scene import Scene

__all__ = ["ACCELERATION", "COMPLIANCE", "ball_unit", "gamma_unit", "velocity_unit"]

COMPLIANCE = "1/kg"  # of a, b and C where g and the tangential displacements are lengths
ACCELERATION = "m/s^2"


def velocity_unit(scene: Scene) -> str:
    """The units that a Euclidean norm of the scene's velocities mixes, such as "m/s, rad/s"."""
    return ", ".join(dict.fromkeys(f"{c.unit}/s" for c in scene.coordinates))


def ball_unit(scene: Scene) -> str:
    """The units of a ball's radius eps: those of the coordinates and those of the velocities."""
    return ", ".join(dict.fromkeys(c.unit for c in scene.coordinates)) + "; " + velocity_unit(scene)


def gamma_unit(scene: Scene) -> str:
    """The units of gamma = (a - mu |b|)/|grad g|^2, which the norm of grad g mixes, such as "1/kg, rad^2/(kg m^2)"."""
    units = (c.unit for c in scene.coordinates if scene.contact.constraint.has(c.symbol))
    return ", ".join(dict.fromkeys(COMPLIANCE if u == "m" else f"{u}^2/(kg m^2)" for u in units))
