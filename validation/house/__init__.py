"""Size and shape of the source, so that two checkouts can be compared.

``python -m validation.house`` prints the figures, ``--json FILE`` writes them, ``--tree DIR`` reads
another checkout, and ``--runs`` also follows a few commands through the functions they enter.
"""
