"""Theorem 1 on every named state of the library."""
