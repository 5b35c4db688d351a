"""The paper's law (7) against Coulomb's law with maximal dissipation."""
