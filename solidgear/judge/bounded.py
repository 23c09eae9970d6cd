"""Numbers of a harmonic solid between two bounds, and where on its mesh their uncertainty sits.

Compliances lie between that of the body and that of its softest relative, stiffnesses the other way
round, as quadratic forms; a coupling lies within half the geometric mean of what its two diagonal
entries leave open, about the middle of its own two values. Frequencies lie between the Rayleigh
quotient and what Kato and Temple leave of it (:mod:`solidgear.bounds.harmonic`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.body import Body, Supports
from solidgear.bounds.harmonic import HarmonicBounds, harmonic_bounds, with_tail
from solidgear.bounds.safety import LOCAL
from solidgear.judge.bars import LEAST, ErrorBar
from solidgear.judge.quantities import Values, in_order, size
from solidgear.judge.solving import Statics, widened
from solidgear.judge.steps import METHOD
from solidgear.quantity import STIFFNESS, Quantity
from solidgear.scene.coned import coned
from solidgear.solve.modes import ModeSet, modes
from solidgear.solve.statics import flexibility

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: shapes above a list of modes that are looked at for its bars
ABOVE = 12


@dataclass(frozen=True)
class Bounded:
    """Bars of some numbers."""

    error_bars: dict[Quantity, ErrorBar]
    #: of every number, (ne,) shares of its bar by cells; in sum one
    scores: dict[Quantity, np.ndarray]


def bounded(
    scene: Scene,
    body: Body,
    supports: Supports,
    statics: Statics | None,
    found: ModeSet | None,
    names: Sequence[Quantity],
    solver: Values,
    later: ModeSet | None = None,
) -> Bounded:
    """Bars of some numbers of a harmonic body by local problems, from what was condensed and solved of it
    and the relative error that the solver may have left.

    Parameters
    ----------
    later : ModeSet, optional
        Modes in other supports, whose bars will be asked for.
    """
    asked = [q for q in names if q.is_frequency]
    bounds = harmonic_bounds(
        coned(scene),
        body,
        statics=statics is not None,
        modes=found,
        wanted=list(dict.fromkeys(asked)),
        safety=LOCAL,
        later=later,
    )
    bars: dict[Quantity, ErrorBar] = {}
    scores: dict[Quantity, np.ndarray] = {}
    if statics is not None:
        stiff = statics.values()
        two, one = (
            statics.again(bounds.softer(more), supports).values()
            for more in (bounds.more, bounds.less)
        )
        for name in in_order(dict.fromkeys((*stiff, *names))):
            known = all(name in end for end in (stiff, two, one))
            if known and not name.is_frequency:
                bars[name] = _between(name, stiff, two, one, solver.get(name, 0.0))
        own = [q for q in names if q in bars]
        scores |= _static_scores(body, supports, bounds, statics, own)
    for name in names:
        mode = found.named(name) if found is not None and name.is_frequency else None
        if mode is None:
            continue
        least = bounds.frequency(mode)
        open_ = 1 - least / mode.frequency_hz
        bars[name] = _bar(mode.frequency_hz, open_, mode.error, least)
        scores[name] = bounds.of_modes[mode.name] / bounds.of_modes[mode.name].sum()
    return Bounded(bars, scores)


def mode_bars(scene: Scene, body: Body, supports: Supports, found: ModeSet) -> dict[str, float]:
    """Error bars of the frequencies of a harmonic body, which lie above the exact ones, of all families:
    relative, by the names of elastic modes; without those that no other mode of their family was found
    above.
    """
    names = [m.name for m in found.modes if m.frequency_hz > 0]
    if not names:
        return {}
    every = found
    if not _all_below(found):
        # the gap to what lies above counts, in every family
        shapes = sum(m.multiplicity for m in found.modes)
        every = widened(found, modes(body, supports, shapes + ABOVE, ovalising=True))
    bounds = harmonic_bounds(
        coned(scene), body, statics=False, modes=every, wanted=names, safety=LOCAL
    )
    last = _highest(every)
    return {
        m.name: 1 - bounds.frequency(m) / m.frequency_hz + m.error
        for m in found.modes
        if 0 < m.frequency_hz < last[m.family]
    }


def _highest(found: ModeSet) -> dict[str, float]:
    """Highest frequency that was found of every family, Hz."""
    out: dict[str, float] = {}
    for mode in found.solved:
        out[mode.family] = max(mode.frequency_hz, out.get(mode.family, 0.0))
    return out


def _all_below(found: ModeSet) -> bool:
    """Tell whether a mode of its family was found above each of a list."""
    last = _highest(found)
    return all(m.frequency_hz < last[m.family] for m in found.modes if m.frequency_hz > 0)


def _between(name: Quantity, stiff: Values, two: Values, one: Values, solver: float) -> ErrorBar:
    """Error bar of a static number from its ends: the number itself, and as soft as two orders more
    and one order more see it.
    """
    scale = size(stiff, name)

    def move(q: Quantity) -> float:
        return LOCAL * with_tail(abs(two[q] - stiff[q]), abs(one[q] - stiff[q]))

    pair = name.diagonals
    if pair is None or not all(d in end for d in pair for end in (stiff, two, one)):
        other = stiff[name] + np.copysign(move(name), two[name] - stiff[name])
        return _bar(stiff[name], move(name) / scale, solver, other, scale=scale)
    half = float(np.sqrt(move(pair[0]) * move(pair[1]))) / 2
    seen = float(np.sqrt(abs(np.prod([two[d] - stiff[d] for d in pair]))))
    most = 2 * half / seen if seen else 1.0
    other = stiff[name] + np.clip(most * (two[name] - stiff[name]), -2 * half, 2 * half)
    middle = (stiff[name] + other) / 2
    # the number itself stands aside of the middle
    open_ = (half + abs(middle - stiff[name])) / scale
    return _bar(stiff[name], open_, solver, other, float(middle), scale)


def _bar(
    value: float,
    open_: float,
    solver: float,
    other: float,
    middle: float | None = None,
    scale: float | None = None,
) -> ErrorBar:
    return ErrorBar(
        values=(float(value),),
        width=float(open_ + solver + LEAST),
        change=float(abs(other - value) / (scale or abs(value) or 1.0)),
        reduction=None,
        factor=LOCAL,
        solver=float(solver),
        extrapolated=float(value + (other - value) / LOCAL),
        method=METHOD,
        middle=middle,
    )


def _static_scores(
    body: Body,
    supports: Supports,
    bounds: HarmonicBounds,
    statics: Statics,
    names: Sequence[Quantity],
) -> dict[Quantity, np.ndarray]:
    """Shares of bars of compliances by cells: the energy of the local solutions under the load and
    what the bearings answer to it.
    """
    ports = [(port.name, port.attachment) for port in body.ports]
    out: dict[Quantity, np.ndarray] = {}
    forces: dict[int, np.ndarray] = {}
    attached = {one.port: one.attachment for one in (statics.main, *statics.further.values())}
    if statics.coupled is not None:
        attached |= dict(zip(statics.coupled.ports, statics.coupled.attachments))
    for name in names:
        one = name.points[0] if name.points else statics.main.port
        total = np.zeros(len(bounds.of_ports))
        for point, load in set(zip(name.pair or (one, one), name.loads)):
            seat = statics.main if point == statics.main.port else statics.further.get(point)
            first = 6 * ports.index((point, attached[point]))
            loads = np.array(load)
            if name.kind == STIFFNESS and seat is not None:
                loads = np.nan_to_num(seat.stiffness, posinf=0.0, neginf=0.0) @ loads
            f = np.zeros(6 * len(ports))
            for c in map(int, np.flatnonzero(loads)):
                if first + c not in forces:
                    forces[first + c] = _forces(body, supports, first + c)
                f += loads[c] * forces[first + c]
            energy = np.einsum("i,cij,j->c", f, bounds.of_ports, f)
            if energy.sum() > 0:
                total = np.maximum(total, energy / energy.sum())
        out[name] = total / (total.sum() or 1.0)
    return out


def _forces(body: Body, supports: Supports, load: int) -> np.ndarray:
    """(6 p,) forces on all ports under a unit load on one component of one, bearings included."""
    f = np.zeros(6 * len(body.ports))
    f[load] = 1.0
    if not supports.ports:
        return f

    there = supports.rows(body)
    flex, rigid, root = flexibility(body).matrix, body.rigid_ports, supports.root
    # springs by their root: stretch s with (1 + L'F L) s = L'(F f + R a), R_b'L s = R'f
    inner = np.eye(root.shape[1]) + root.T @ flex[np.ix_(there, there)] @ root
    held = root.T @ rigid[there]
    scale = np.abs(held).max(axis=0)
    keep = scale > 0
    held = held[:, keep] / scale[keep]
    reach = np.linalg.solve(inner, root.T @ flex[there, load])
    through = np.linalg.solve(inner, held)
    a = np.linalg.lstsq(
        held.T @ through, rigid[load, keep] / scale[keep] - held.T @ reach, rcond=1e-12
    )[0]
    f[there] -= root @ (reach + through @ a)
    return f
