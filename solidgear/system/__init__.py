"""Geared systems: mesh vector, the 14-DOF lumped pair, and identification of what a source leaves
out.
"""
