"""How far answers of two programs are apart."""

from __future__ import annotations

import numpy as np

from validation.race.heat import Check


def paired(frequency, multiplicity) -> np.ndarray:
    """Single frequencies brought to distinct ones: root mean square over each group of as many as
    ``multiplicity`` says.

    A mesh without symmetry splits a pair by its own error; our results give the pair, a peer gives
    both.
    """
    cuts = np.cumsum([0, *multiplicity])
    groups = [frequency[a:b] for a, b in zip(cuts, cuts[1:]) if b <= len(frequency)]
    return np.array([np.sqrt(np.mean(np.square(group))) for group in groups])


def frequency_gap(frequency, modes) -> float:
    """Largest relative difference of a peer's frequencies from a ModeSet's elastic ones."""
    elastic = [m for m in modes.modes if m.frequency_hz > 0]
    theirs = paired(np.sort(frequency), [m.multiplicity for m in elastic])
    mine = np.array([m.frequency_hz for m in elastic])[: len(theirs)]
    return float(np.abs(theirs / mine - 1).max())


def compliance_gap(theirs, ours) -> float:
    """Largest difference of two 6x6 compliances, entries scaled by the diagonal."""
    d = np.sqrt(np.diag(ours))
    return float((np.abs(theirs - ours) / np.outer(d, d)).max())


def frequency_check(modes, allowed: float, why: str) -> Check:
    """Frequencies of an answer against a ModeSet."""
    return Check("frequencies", lambda a: frequency_gap(a.frequency_hz, modes), allowed, why)


def compliance_check(compliance: np.ndarray, allowed: float, why: str) -> Check:
    """The 6x6 of an answer against ours."""
    return Check("6x6 compliance", lambda a: compliance_gap(a.compliance, compliance), allowed, why)
