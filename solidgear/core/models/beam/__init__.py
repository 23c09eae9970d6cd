"""Beams: Euler-Bernoulli and Timoshenko."""
