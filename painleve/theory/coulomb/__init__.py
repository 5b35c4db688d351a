"""Coulomb's law with maximal dissipation, all of its solutions; the paper's own law is the projection (7).

`problem` is a contact with numbers, `impulses` and `slip_roots` find every impulse that solves it, `one_step` and
`limit` are the questions that users ask: of one step, and of a tangential contact.
"""
