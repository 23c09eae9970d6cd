"""Mode correlation between models: MAC on axis stations, subspace MAC for degenerate pairs and
clusters, and which mode is which.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.sparse.csgraph import connected_components

from solidgear.core.judge.record import MacTable, PartnerRecord
from solidgear.core.solve.modes import Mode, ModeSet
from solidgear.core.solve.neighbours import best_assignment

#: A partner is certain from this similarity on, if the next one is less alike by this much.
SURE, LEAD = 0.75, 0.25
#: Less alike than this is no partner at all; from this on, two modes have something of each other.
FOREIGN, SHARED = 0.3, 0.05
#: Relative width of a cluster in which shapes may mix without harm, and how alike the spaces of two
#: clusters must be.
CLOSE, SAME_SPACE = 0.05, 0.9
#: Families without section motions are paired by rank; the partner is certain if frequencies are
#: this near, relative.
RANKED = 0.15


@dataclass(frozen=True)
class Pairing:
    """A reference mode and the mode of a model that is the same one."""

    reference: Mode
    mode: Mode | None  #: none where no mode of the model has this shape
    mac: float  #: of the two shapes; 0 for families that are paired by rank, and without a partner
    certain: bool  #: whether no other mode comes into question
    #: the rest of the partner, where the model has split a pair of the reference
    others: tuple[Mode, ...] = ()

    @property
    def frequency_hz(self) -> float:
        """Frequency of the partner, Hz; the root mean square over the members where a pair is
        split, NaN without a partner.
        """
        members = [m for m in (self.mode, *self.others) if m is not None]
        if not members:
            return float("nan")
        return float(
            np.sqrt(
                np.average(
                    [m.frequency_hz**2 for m in members], weights=[m.multiplicity for m in members]
                )
            )
        )

    @property
    def relative(self) -> float:
        """Relative difference of the frequencies of partner and reference."""
        return self.frequency_hz / self.reference.frequency_hz - 1


def pair_modes(model: ModeSet, reference: ModeSet) -> tuple[Pairing, ...]:
    """Pair the modes of a model with those of the reference, by shape and not by name: one pair for
    every elastic mode of the reference, in order; those beyond the end of the list follow.

    Every elastic mode of the reference gets the mode with the most similar section motions, all at
    once (an assignment), shapes of pairs counted one by one, so that a pair may meet a split one.
    Modes that come near each other mix their shapes: where the space of such a cluster is the same
    in both models, it is paired by frequency. Ovalising and breathing modes, which sections do not
    see, are paired by waves around and rank.

    ValueError if the sets were made on different stations.
    """
    if not np.allclose(model.stations, reference.stations):
        raise ValueError("the two mode sets were projected on different stations")
    reference_modes = [m for m in (*reference.modes, *reference.beyond) if m.frequency_hz > 0]
    model_modes = [m for m in (*model.modes, *model.beyond) if m.frequency_hz > 0]
    out: dict[int, Pairing] = {}
    for key in {_ranked(m) for m in reference_modes} - {None}:
        places = [j for j, m in enumerate(reference_modes) if _ranked(m) == key]
        pairings = _by_rank(
            [m for m in model_modes if _ranked(m) == key], [reference_modes[j] for j in places]
        )
        out |= dict(zip(places, pairings))
    places = [j for j, m in enumerate(reference_modes) if _ranked(m) is None]
    out |= dict(
        zip(
            places,
            _by_shape(
                [m for m in model_modes if _ranked(m) is None],
                [reference_modes[j] for j in places],
                reference.gram,
            ),
        )
    )
    return tuple(out[j] for j in range(len(reference_modes)))


def _ranked(mode: Mode) -> tuple[int, str] | None:
    """Return the key by which modes are paired by rank; None for modes that section motions
    describe.
    """
    return (mode.waves, mode.family) if mode.waves > 1 or mode.family == "breathing" else None


def _by_rank(modes: list[Mode], references: list[Mode]) -> list[Pairing]:
    """Pair the lowest mode with the lowest and so on, shape by shape."""
    shapes = [m for m in sorted(modes, key=lambda m: m.frequency_hz) for _ in range(m.multiplicity)]
    out, start = [], 0
    for mode in references:
        members = list({id(m): m for m in shapes[start : start + mode.multiplicity]}.values())
        start += mode.multiplicity
        if not members:
            out.append(Pairing(mode, None, 0.0, False))
            continue
        close = all(abs(m.frequency_hz / mode.frequency_hz - 1) < RANKED for m in members)
        out.append(Pairing(mode, members[0], 0.0, close, tuple(members[1:])))
    return out


def _by_shape(modes: list[Mode], references: list[Mode], gram) -> list[Pairing]:
    """Pair modes by the assignment of the largest similarity, then mark pairs that are certain,
    alone or as a cluster.
    """
    if not modes or not references:
        return [Pairing(m, None, 0.0, False) for m in references]
    mac = np.array([[subspace_mac(_rows(a), _rows(b), gram) for b in references] for a in modes])
    # Shapes of which sections show equal parts; sections that show all of one shape and little of
    # another say that they differ.
    share_a, share_b = (
        np.array([max(min(m.captured, 1.0), 1e-3) for m in side]) for side in (modes, references)
    )
    like = mac * np.sqrt(
        np.minimum(share_a[:, None], share_b) / np.maximum(share_a[:, None], share_b)
    )
    distance = np.abs(
        np.log([[a.frequency_hz / b.frequency_hz for b in references] for a in modes])
    )
    rows = np.repeat(np.arange(len(modes)), [m.multiplicity for m in modes])
    columns = np.repeat(np.arange(len(references)), [m.multiplicity for m in references])
    # Among equals the nearer frequency; it decides nothing else.
    gain = like - 0.01 * np.minimum(distance, 1.0)
    assigned = [
        (int(rows[r]), int(columns[c]))
        for r, c in zip(*best_assignment(gain[np.ix_(rows, columns)]))
    ]
    partners = {
        j: sorted(
            {i for i, k in assigned if k == j and like[i, j] >= FOREIGN},
            key=lambda i: modes[i].frequency_hz,
        )
        for j in range(len(references))
    }
    clusters = _clusters(modes, references, like, gram)
    out = []
    for j, reference in enumerate(references):
        members = partners[j]
        if not members:
            out.append(Pairing(reference, None, 0.0, False))
            continue
        value = subspace_mac(np.vstack([_rows(modes[i]) for i in members]), _rows(reference), gram)
        rivals = [like[i, j] for i in range(len(modes)) if i not in members]
        rivals += [
            like[i, k]
            for i in members
            for k in range(len(references))
            if k != j and i not in partners[k]
        ]
        least = min(like[i, j] for i in members)
        certain = least >= SURE and max(rivals, default=0.0) <= least - LEAD
        if not certain and j in clusters:
            members, value = clusters[j]
            certain = True
        out.append(
            Pairing(
                reference,
                modes[members[0]],
                float(value),
                bool(certain),
                tuple(modes[i] for i in members[1:]),
            )
        )
    return out


def _clusters(modes, references, like, gram) -> dict[int, tuple[list[int], float]]:
    """Pair modes by frequency inside clusters of close modes that span the same space in both
    models; return reference -> (members, subspace MAC).
    """
    links = like > SHARED
    m = len(modes)
    graph = np.block([[np.zeros((m, m)), links], [links.T, np.zeros((len(references),) * 2)]])
    count, label = connected_components(graph, directed=False)
    out: dict[int, tuple[list[int], float]] = {}
    for c in range(count):
        places, reference_places = np.flatnonzero(label[:m] == c), np.flatnonzero(label[m:] == c)
        for group, reference_group in _dense_groups(places, reference_places, modes, references):
            a = np.vstack([_rows(modes[i]) for i in group])
            b = np.vstack([_rows(references[j]) for j in reference_group])
            value = subspace_mac(a, b, gram)
            if value < SAME_SPACE:
                continue
            shapes = [i for i in group for _ in range(modes[i].multiplicity)]
            for j in reference_group:
                size = references[j].multiplicity
                members, shapes = dict.fromkeys(shapes[:size]), shapes[size:]
                out[int(j)] = ([int(i) for i in members], value)
    return out


def _dense_groups(places, reference_places, modes, references):
    """Yield runs of modes close in frequency, in both models, with as many shapes on either side,
    as (indices, indices), the largest first.
    """
    places = sorted(places, key=lambda i: modes[i].frequency_hz)
    reference_places = sorted(reference_places, key=lambda j: references[j].frequency_hz)

    def runs(order, members):
        frequency = [members[k].frequency_hz for k in order]
        for a, b in combinations(range(len(order) + 1), 2):
            if b - a > 1 and frequency[b - 1] <= (1 + CLOSE) * frequency[a]:
                yield order[a:b], sum(members[k].multiplicity for k in order[a:b])

    model_runs = list(runs(places, modes))
    used: set[int] = set()
    reference_used: set[int] = set()
    for reference_group, shapes in sorted(runs(reference_places, references), key=lambda x: -x[1]):
        for group, count in model_runs:
            if (
                count == shapes
                and not used & set(group)
                and not reference_used & set(reference_group)
            ):
                used |= set(group)
                reference_used |= set(reference_group)
                yield group, reference_group
                break


def subspace_mac(a: np.ndarray, b: np.ndarray, gram: np.ndarray) -> float:
    """Compute the MAC of two subspaces of station motions, rows (k, n) and (l, n), in the inner
    product ``gram`` (n, n), positive semidefinite.

    The mean of the squared cosines of the principal angles; for single modes the usual MAC.
    Degenerate pairs come out in any orientation, single MACs of their members mean nothing.
    """

    def orthonormal(x):
        w, v = np.linalg.eigh(x @ gram @ x.T)
        keep = w > 1e-12 * w.max(initial=0.0)
        return (v[:, keep] / np.sqrt(w[keep])).T @ x

    qa, qb = orthonormal(a), orthonormal(b)
    if not len(qa) or not len(qb):
        return 0.0
    cosines = np.linalg.svd(qa @ gram @ qb.T, compute_uv=False)
    return float(min(1.0, (cosines**2).sum() / min(len(qa), len(qb))))


def correlate(model: ModeSet, reference: ModeSet) -> MacTable:
    """Correlate two mode sets, with the section masses of the reference as weights; partners of elastic
    modes are those most alike.

    ValueError if the sets were made on different stations.
    """
    if not np.allclose(model.stations, reference.stations):
        raise ValueError("the two mode sets were projected on different stations")
    model_modes, reference_modes = (
        [m for m in s.modes if m.frequency_hz > 0] for s in (model, reference)
    )
    values = [
        [subspace_mac(_rows(a), _rows(b), reference.gram) for b in reference_modes]
        for a in model_modes
    ]
    pairs = []
    for a, row in zip(model_modes, values if reference_modes else ()):
        mac = max(row)
        b = reference_modes[row.index(mac)]
        relative = a.frequency_hz / b.frequency_hz - 1
        pairs.append(
            PartnerRecord(
                mode=a.name,
                partner=b.name,
                mac=mac,
                frequency_hz=a.frequency_hz,
                reference_hz=b.frequency_hz,
                relative=relative,
            )
        )
    rows, columns = ([m.name for m in modes] for modes in (model_modes, reference_modes))
    return MacTable(rows=rows, columns=columns, values=values, pairs=pairs)


def _rows(mode: Mode) -> np.ndarray:
    return mode.motions.reshape(len(mode.motions), -1)
