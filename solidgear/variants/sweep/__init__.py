"""Sweeps: many variants of a shaft or of a train, a row each."""
