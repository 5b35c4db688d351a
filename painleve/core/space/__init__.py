"""The law with friction in space: on the disc a projection onto a conic, on a polygon onto its edges; and Coulomb's.

`conic_law` and `polygon_law` are S from numbers, `law` from a scene's rows, `offset` and `polygon_offset` relative to
the limit set; `steps` serves the schemes; `coulomb` enumerates the solutions of the law of maximal dissipation.
"""
