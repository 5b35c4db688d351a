"""Templates: one step of each fixed-step scheme, a file each; painleve.dynamics.schemes says what they are.

`<name>_step(method, t, h, q, u, p)` is the painleve.core.stepping.Step of length h from (t, q, u), p the parameters.
`in_plane` and `in_space` choose among the schemes that step such friction.
"""
