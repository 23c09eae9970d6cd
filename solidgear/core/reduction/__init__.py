"""Lumped-parameter synthesis: stiffness at the lumped point, effective mass and inertia, and their
error.
"""
