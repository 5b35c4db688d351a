"""Template: the schemes of a contact without friction or with planar friction."""

from painleve._jit import jit
from painleve.core.motion_codes import FixedStep
from painleve.kernels.motion.contact import gap
from painleve.kernels.motion.schemes.anitescu_potra import anitescu_potra_step
from painleve.kernels.motion.schemes.contact_dynamics import contact_dynamics_step
from painleve.kernels.motion.schemes.moreau_jean import moreau_jean_step
from painleve.kernels.motion.schemes.schatzman_paoli import schatzman_paoli_step
from painleve.kernels.motion.schemes.stewart_trinkle import stewart_trinkle_step
from painleve.kernels.motion.sections.segment import solutions

CONTACT_DYNAMICS, MOREAU_JEAN = int(FixedStep.CONTACT_DYNAMICS), int(FixedStep.MOREAU_JEAN)
STEWART_TRINKLE, SCHATZMAN_PAOLI = int(FixedStep.STEWART_TRINKLE), int(FixedStep.SCHATZMAN_PAOLI)


@jit
def step(method, t, h, q, u, p):
    """One step of a scheme from (t, q, u)."""
    if method.scheme == CONTACT_DYNAMICS:
        return contact_dynamics_step(method, t, h, q, u, p)
    if method.scheme == MOREAU_JEAN:
        return moreau_jean_step(method, t, h, q, u, p)
    if method.scheme == STEWART_TRINKLE:
        return stewart_trinkle_step(method, t, h, q, u, p)
    if method.scheme == SCHATZMAN_PAOLI:
        return schatzman_paoli_step(method, t, h, q, u, p)
    return anitescu_potra_step(method, t, h, q, u, p)


@jit
def count_solutions(method, h, taken):
    """How many impulses solve the contact problem of the step just taken."""
    rows, contact = taken.rows, taken.contact
    if method.scheme == STEWART_TRINKLE:
        return solutions(rows, contact, contact[0] + gap(rows) / h)
    if method.scheme == SCHATZMAN_PAOLI:  # one linearisation, about the free motion: where it pushes there is one
        return solutions(rows, contact, gap(rows) / h)
    return solutions(rows, contact, contact[0]) if gap(rows) <= method.tolerance else 1
