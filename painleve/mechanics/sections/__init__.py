"""Friction sections B(q): what friction impulses s a unit normal impulse admits (docs/theory.md, section 1).

A file each; painleve.mechanics.friction lists them, `section` says what each of them knows.
"""
