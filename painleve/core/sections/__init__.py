"""What a contact does, for each friction section a file: S from the rows, S relative to the limit set, a step's law.

The files define the same names, as far as a section has need of them:
    contact_velocity(rows, d, v)                    W^T v: the normal velocity, then that along the tangents of the rows
    impulse(rows, ..., velocity, bias)              (r, branch) of the law where there is contact (painleve.core.steps)
    law_from_rows(rows, ..., v, result)             S(q, v), with the branch
    split(hit, ...)                                 S relative to the limit set, with the `...Base` state that it needs
    kind_of_change(rows, ..., velocity, r, ...)     what an impulse did in a step (painleve.core.motion_codes.Change)
"..." is what tells one scene from another: d, and for a polygon the number of its vertices.
"""
