"""Automatic choice on random scenes: whether bars hold, how tight they are, and what they cost.

    python -m validation.choice [--scenes 100] [--seed 50001] [--judged-from 50046] [--live 5]

Every scene (those of `validation.attack`) is solved on many meshes of the harmonic solid, each
timed, and held against an over-refined reference.  The program's own climb is then walked over
these numbers at every tolerance: what it would have answered, with which bar, and what all meshes
on its way cost over the cheapest mesh that is good enough, known with hindsight among all that were
solved.  Factors of bands were set with scenes of the first seeds only; the others judge them.
"""
