"""Mechanisms as trees of rigid bodies and joints: data here, and what follows from them on a tape."""
