"""Template: the schemes of a contact with friction in space, those that take Moreau's law as it is."""

from painleve._jit import jit
from painleve.core.motion_codes import FixedStep
from painleve.kernels.motion.schemes.contact_dynamics import contact_dynamics_step
from painleve.kernels.motion.schemes.moreau_jean import moreau_jean_step

CONTACT_DYNAMICS = int(FixedStep.CONTACT_DYNAMICS)


@jit
def step(method, t, h, q, u, p):
    """One step of a scheme from (t, q, u): contact_dynamics or moreau_jean."""
    if method.scheme == CONTACT_DYNAMICS:
        return contact_dynamics_step(method, t, h, q, u, p)
    return moreau_jean_step(method, t, h, q, u, p)


@jit
def count_solutions(method, h, taken):
    """One: the law is a projection (what solves Coulomb's law beside it: painleve.core.space.coulomb)."""
    return 1
