"""The templates of the schemes that step a contact, in the plane (with friction or without) and in space."""

from painleve.kernels.motion.schemes import (
    anitescu_potra,
    contact_dynamics,
    in_plane,
    in_space,
    moreau_jean,
    schatzman_paoli,
    stewart_trinkle,
)

__all__ = ["IN_PLANE", "IN_SPACE"]

IN_PLANE = (contact_dynamics, moreau_jean, stewart_trinkle, anitescu_potra, schatzman_paoli, in_plane)
IN_SPACE = (contact_dynamics, moreau_jean, in_space)
