"""Observed orders of the time-stepping schemes."""
