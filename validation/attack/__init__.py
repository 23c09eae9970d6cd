"""Random scenes against an over-refined reference: do the bands hold the truth, are the verdicts
right?

    python -m validation.attack --scenes 100 --seed 1

`scenes` draws shafts as a stranger would write them, `reference` solves them far more finely than
asked for, `bands` and `verdicts` hold what `compare` and `check` say against it. Every scene
follows from its seed alone.
"""

from solidgear.machine.threads import pin

pin()  # before numpy: one thread for the many small dense matrices
