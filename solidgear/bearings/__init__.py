"""Rolling bearings from catalogue data: load, stiffness at load, equilibrium with a shaft."""
