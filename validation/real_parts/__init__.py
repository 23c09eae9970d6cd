"""Random shafts with features, and what must hold of every one of them.

    python -m validation.real_parts --scenes 30 --seed 1

`scenes` draws files as a user would write them, with features of all kinds that can be combined;
`claims` holds what must be true of a part whatever it looks like; `volumes` counts points inside a
part, and shares no code with what meshes it. Every scene follows from its seed alone.
"""

from solidgear.machine.threads import pin

pin()  # before numpy: one thread for the many small dense matrices
