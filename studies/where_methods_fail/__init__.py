"""Rare slips, cancellation, and parameters near a critical value."""
