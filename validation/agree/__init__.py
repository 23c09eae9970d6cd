"""Relations that hold whatever the right numbers are, between what commands say of one file.

Four kinds, each a module: the same number by every command (:mod:`~validation.agree.same_number`),
answers at several tolerances (:mod:`~validation.agree.nested`), the same shaft described otherwise
(:mod:`~validation.agree.described`), and cautions that stand wherever a number rests on them
(:mod:`~validation.agree.cautions`).  None needs a reference.
"""
