"""Campaigns: scenes drawn by seeds, what is true of them, and whether the program said so.

scenes/     shafts, bodies drawn to break bars, parts with features, small shafts; by seed alone
truths/     references: spectral, triangles, finer meshes of a part, dense solutions, points counted
rows        a number held against the truth, a verdict held against it: the one judgement
table       the one table
cases/      the campaigns: what is asked of which scenes, and held against which truth
run         bodies through workers, kept as they come
results     the score of a run, with date, commit, seeds and machine
scoreboard  the page of all scores
"""

from solidgear.core.machine.threads import pin

pin()  # before numpy: one thread for the many small dense matrices
