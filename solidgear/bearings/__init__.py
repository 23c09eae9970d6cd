"""Rolling bearings from catalogue data: load, tangent stiffness at load, equilibrium with a shaft."""
