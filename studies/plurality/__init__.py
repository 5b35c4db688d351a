"""Velocity jumps without collision as the step size tends to 0, and the jam law."""
