"""Solids of a piece of a shaft around one cut, for the stress there."""
