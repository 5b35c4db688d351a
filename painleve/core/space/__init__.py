"""The law with friction in space, from numbers: on the disc a projection onto a conic, on a polygon onto its edges.

`tangent_plane` is where both are, `conic_law` and `polygon_law` are S, `offset` and `from_rows` what both of
painleve.core.sections have use for; `coulomb` enumerates the solutions of the law of maximal dissipation.
"""
