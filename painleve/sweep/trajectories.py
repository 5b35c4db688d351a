"""The dataset of one trajectory, with where it comes from."""

from __future__ import annotations

import xarray as xr

from painleve.dynamics.trajectory import Trajectory
from painleve.store import provenance

__all__ = ["trajectory_dataset"]


def trajectory_dataset(trajectory: Trajectory, *, command: str | None = None) -> xr.Dataset:
    """What `painleve.store.save` keeps: a file says where it comes from; `command` as for provenance."""
    scene = trajectory.start.scene
    source = provenance(scene=scene, scene_digest=trajectory.start.motion.digest, seed=0, command=command)
    return trajectory.to_xarray().assign_attrs(source)
