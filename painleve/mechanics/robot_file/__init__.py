"""Robots' files, MJCF and URDF, read through the `mujoco` package where that is installed."""
