"""Templates: what a step knows of the friction section, a file each; they define the same names.

NO_IMPULSE, `contact_velocity(rows, v)` = W^T v, `impulse(rows, contact, bias)` = (r, branch), `respond(rows, r, v)` =
v + M^-1 W r, `store_impulse(x, i, rows, r)` in the scene's own tangents, `kind_of_change(step, free, since, speed)`,
and in the plane `solutions(rows, contact, gap_rate)`, how many impulses solve the contact problem.
"""
