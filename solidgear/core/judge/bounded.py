"""Numbers of a solid between two bounds, and the places on the mesh where their uncertainty lies.

Compliances lie between that of the body and that of its softest relative, stiffnesses the other way
round, as quadratic forms; a coupling lies within half the geometric mean of the uncertainties of
both diagonal entries, about the middle of its own two values. Frequencies lie between the Rayleigh
quotient and the lower bound of Kato and Temple.  The bounds are those of
:mod:`solidgear.core.bounds.harmonic` and :mod:`solidgear.core.bounds.solid`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.core.body import Body, Supports
from solidgear.core.bounds.harmonic import (
    Later,
    harmonic_bounds,
    is_beside_many,
    is_bounded,
    with_tail,
)
from solidgear.core.judge.bars import LEAST, ErrorBar
from solidgear.core.judge.quantities import Values, in_order, size
from solidgear.core.judge.solving import Statics, extended_modes, numbers
from solidgear.core.ladder.registry import LADDER
from solidgear.core.quantity import STIFFNESS, Quantity
from solidgear.core.registry import addition
from solidgear.core.safety import LOCAL
from solidgear.core.scene.coned import coned
from solidgear.core.solve.groups import MOST_SHAPES
from solidgear.core.solve.modes import ModeSet, modes
from solidgear.core.solve.statics import flexibility

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: why a mode has no error bar
NOTHING_BEYOND = (
    "an error bar needs a mode beyond those side by side with it that the mesh resolves, and none was "
    f"found among the lowest {MOST_SHAPES} shapes, or modes lie too dense for one there; without a bar "
    "a frequency is an upper end"
)
#: shapes above a list of modes that are looked at for its bars
ABOVE = 12


@dataclass(frozen=True)
class Bounded:
    """Error bars of some numbers."""

    error_bars: dict[Quantity, ErrorBar]
    #: of every number, (ne,) shares of its bar by cells; in sum one
    scores: dict[Quantity, np.ndarray]


def bounded(
    scene: Scene,
    body: Body,
    supports: Supports,
    statics: Statics | None,
    modes: ModeSet | None,
    names: Sequence[Quantity],
    solver: Values,
    later: Sequence[Later] = (),
) -> Bounded:
    """Bound some numbers of a solid from the condensed statics and the modes found and the relative
    error that the solver may have left; `later` are modes whose error bars will be asked for next.
    """
    frequencies = [q for q in names if q.is_frequency]
    bounds = bounds_of(
        scene, body, supports, statics is not None, modes, list(dict.fromkeys(frequencies)), later
    )
    bars: dict[Quantity, ErrorBar] = {}
    scores: dict[Quantity, np.ndarray] = {}
    if statics is not None:
        stiff = statics.values()
        two_orders, one_order, near = (
            statics.repeated(bounds.softer(more), supports).values() if more.any() else stiff
            for more in (bounds.more, bounds.less, bounds.least)
        )
        for name in in_order(dict.fromkeys((*stiff, *names))):
            complete = all(name in end for end in (stiff, two_orders, one_order, near))
            if not complete or name.is_frequency:
                continue
            left = solver.get(name, 0.0)
            if bounds.two_sided:
                bars[name] = _within(name, stiff, near, two_orders, left)
            else:
                bars[name] = _between(name, stiff, two_orders, one_order, near, left)
        static_names = [q for q in names if q in bars]
        scores |= _static_scores(body, supports, bounds, statics, static_names)
    for name in names:
        mode = modes.named(name) if modes is not None and name.is_frequency else None
        if mode is None:
            continue
        least = bounds.frequency(mode)
        if least is None:
            continue
        bars[name] = _bar(mode.frequency_hz, 1 - least / mode.frequency_hz, mode.error, least)
        scores[name] = bounds.of_modes[mode.name] / bounds.of_modes[mode.name].sum()
    method, misshapen = LADDER[body.fidelity].bars_by, geometry_share(body)
    for name, bar in bars.items():
        share = misshapen / 2 if name.is_frequency else misshapen
        bars[name] = replace(bar, width=bar.width + share, geometry=share, method=method)
    return Bounded(bars, scores)


def bounds_of(
    scene: Scene,
    body: Body,
    supports: Supports,
    statics: bool,
    modes: ModeSet | None,
    wanted: Sequence[str],
    later: Sequence[Later] = (),
) -> Any:
    """Compute the bounds of a solid, by local problems of a harmonic one, by one order more of a 3D
    one; of others as the room of their model does.
    """
    computed = addition("bounds", body.fidelity)
    if computed is not None:
        return computed(
            scene, body, supports, statics=statics, modes=modes, wanted=wanted, safety=LOCAL
        )
    if not LADDER[body.fidelity].follows:
        from solidgear.core.bounds.solid import solid_bounds  # start-up: for 3D solids alone

        return solid_bounds(scene, body, statics=statics, modes=modes, wanted=wanted, safety=LOCAL)
    return harmonic_bounds(
        coned(scene), body, statics=statics, modes=modes, wanted=wanted, safety=LOCAL, later=later
    )


def geometry_share(body: Body) -> float:
    """Return the share by which static numbers may be off either way, since the mesh of a body has not
    quite its shape; frequencies by half of it, as the root of stiffness over mass.

    If segments are softer by a share e of their own stiffness, at most, a flexibility is too large by
    ``e / (1 - e)``, and that far off is also the ratio of a stiffness to a mass.
    """
    error = body.mesh.get("geometry", 0.0)
    return error / (1 - error) if error < 1 else np.inf


def mode_bars(
    scene: Scene,
    body: Body,
    supports: Supports,
    modes_listed: ModeSet,
    extended: ModeSet | None = None,
) -> dict[str, float]:
    """Compute error bars of the frequencies of a solid, which lie above the exact ones, of all
    families: relative, by the names of elastic modes; without modes beyond whose neighbours nothing
    was found or is worth a search. `extended` is the list with all that bars rest on, where it is
    known.
    """
    elastic = [mode for mode in modes_listed.modes if mode.frequency_hz > 0]
    if not elastic:
        return {}
    if extended is None:
        extended = with_all_for_bars(body, supports, modes_listed)
    names = [m.name for m in elastic if not is_beside_many(extended, m)]
    bounds = bounds_of(scene, body, supports, False, extended, names)
    bars: dict[str, float] = {}
    misshapen = geometry_share(body)
    for mode in modes_listed.modes:
        least = bounds.frequency(mode) if mode.name in names else None
        if least is not None:
            bars[mode.name] = 1 - least / mode.frequency_hz + mode.error + misshapen / 2
    return bars


def elastic_names(mode_set: ModeSet) -> list[str]:
    """Return the names of the elastic modes of a list."""
    return [mode.name for mode in mode_set.modes if mode.frequency_hz > 0]


def with_all_for_bars(body: Body, supports: Supports, listed: ModeSet) -> ModeSet:
    """Return a list of modes with all others that error bars of its frequencies rest on."""
    elastic = [mode for mode in listed.modes if mode.frequency_hz > 0]

    def rest_on_others(found: ModeSet) -> bool:
        # the gap to the modes above counts, in every family
        widened = found is not listed or _all_below(found)
        bounded_ = (is_bounded(found, mode) or is_beside_many(found, mode) for mode in elastic)
        return widened and all(bounded_)

    return extended_until(body, supports, listed, rest_on_others)


def static_bars(
    scene: Scene, body: Body, supports: Supports, points: Sequence[str]
) -> dict[Quantity, float]:
    """Compute relative error bars of compliances and stiffnesses of a solid at some points and
    between them, about the numbers of its mesh.
    """
    statics = Statics.at_points(body, supports, points)
    values = numbers(statics, None)
    names = [name for name in values.quantities if not name.is_frequency]
    judged = bounded(scene, body, supports, statics, None, names, values.solver)
    return {name: bar.width for name, bar in judged.error_bars.items()}


def _all_below(mode_set: ModeSet) -> bool:
    """Return whether a mode of the same family was found above each mode of a list."""
    highest: dict[str, float] = {}
    for mode in mode_set.solved:
        highest[mode.family] = max(mode.frequency_hz, highest.get(mode.family, 0.0))
    return all(m.frequency_hz < highest[m.family] for m in mode_set.modes if m.frequency_hz > 0)


def extended_until(
    body: Body,
    supports: Supports,
    listed: ModeSet,
    enough: Callable[[ModeSet], bool],
) -> ModeSet:
    """Solve a list of modes on, among the lowest `MOST_SHAPES` shapes, until there are enough."""
    shapes = sum(mode.multiplicity for mode in listed.modes)
    extended, count = listed, shapes
    while not enough(extended) and count < MOST_SHAPES:
        count += ABOVE if count == shapes else count - shapes
        extended = extended_modes(listed, modes(body, supports, count, ovalising=True))
    return extended


def _between(
    name: Quantity,
    stiff: Values,
    two_orders: Values,
    one_order: Values,
    near: Values,
    solver: float,
) -> ErrorBar:
    """Compute the error bar of a static number from both ends: the number itself, or as soft as it
    is at least, and as soft as two orders more and one order more make it.
    """
    scale = size(stiff, name)

    def move(q: Quantity) -> float:
        return LOCAL * with_tail(abs(two_orders[q] - stiff[q]), abs(one_order[q] - stiff[q]))

    pair = name.diagonals
    if pair is None or not all(d in end for d in pair for end in (stiff, two_orders, one_order)):
        far_end = stiff[name] + np.copysign(move(name), two_orders[name] - stiff[name])
        middle = None if near is stiff else (near[name] + far_end) / 2
        return _bar(stiff[name], move(name) / scale, solver, far_end, middle, scale)
    most = float(np.sqrt(move(pair[0]) * move(pair[1])))
    reach = float(np.sqrt(abs(np.prod([two_orders[d] - stiff[d] for d in pair]))))
    far = most / reach * (two_orders[name] - stiff[name]) if reach else 0.0
    far_end = stiff[name] + np.clip(far, -most, most)
    # of a number that the mesh does not move both are rounding
    left = [max(move(d) - abs(near[d] - stiff[d]), 0.0) for d in pair]
    half = float(np.sqrt(left[0] * left[1])) / 2
    middle = (near[name] + far_end) / 2
    # the number itself stands aside of the middle
    open_ = (half + abs(middle - stiff[name])) / scale
    return _bar(stiff[name], open_, solver, far_end, float(middle), scale)


def _within(name: Quantity, value: Values, near: Values, far: Values, solver: float) -> ErrorBar:
    """Compute the error bar of a static number that may lie on either side of it, from both ends; of
    a coupling from those of both diagonal entries.
    """
    scale, middle = size(value, name), (near[name] + far[name]) / 2
    pair = name.diagonals
    half = abs(far[name] - near[name]) / 2
    if pair is not None and all(d in near and d in far for d in pair):
        half = float(np.sqrt(np.prod([abs(far[d] - near[d]) for d in pair]))) / 2
    open_ = (half + abs(middle - value[name])) / scale
    return _bar(value[name], open_, solver, far[name], float(middle), scale)


def _bar(
    value: float,
    open_: float,
    solver: float,
    far_end: float,
    middle: float | None = None,
    scale: float | None = None,
) -> ErrorBar:
    return ErrorBar(
        width=float(open_ + solver + LEAST),
        change=float(abs(far_end - value) / (scale or abs(value) or 1.0)),
        factor=LOCAL,
        solver=float(solver),
        extrapolated=float(value + (far_end - value) / LOCAL),
        middle=middle,
        aside=0.0 if middle is None else float(abs(middle - value) / (scale or abs(value) or 1.0)),
    )


def _static_scores(
    body: Body,
    supports: Supports,
    bounds: Any,
    statics: Statics,
    names: Sequence[Quantity],
) -> dict[Quantity, np.ndarray]:
    """Return (ne,) shares of error bars of compliances by cells: the energy of the local solutions
    under the load and the reactions of the bearings.
    """
    ports = [(port.name, port.attachment) for port in body.ports]
    out: dict[Quantity, np.ndarray] = {}
    forces: dict[int, np.ndarray] = {}
    attached = {
        point_name.port: point_name.attachment
        for point_name in (statics.main, *statics.further.values())
    }
    if statics.coupled is not None:
        attached |= dict(zip(statics.coupled.ports, statics.coupled.attachments))
    for name in names:
        point_name = name.points[0] if name.points else statics.main.port
        total = np.zeros(1)
        for point, load in set(zip(name.pair or (point_name, point_name), name.loads)):
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
            energy = bounds.energy_by_cells(f)
            if energy.sum() > 0:
                total = np.maximum(total, energy / energy.sum())
        out[name] = total / (total.sum() or 1.0)
    return out


def _forces(body: Body, supports: Supports, load: int) -> np.ndarray:
    """Return (6 p,) forces on all ports under a unit load on one component of one port, bearings
    included.
    """
    f = np.zeros(6 * len(body.ports))
    f[load] = 1.0
    if not supports.ports:
        return f

    rows = supports.rows(body)
    flex, rigid, root = flexibility(body).matrix, body.rigid_ports, supports.root
    # springs by their root: stretch s with (1 + L'F L) s = L'(F f + R a), R_b'L s = R'f
    inner = np.eye(root.shape[1]) + root.T @ flex[np.ix_(rows, rows)] @ root
    rigid_stretch = root.T @ rigid[rows]
    scale = np.abs(rigid_stretch).max(axis=0)
    keep = scale > 0
    rigid_stretch = rigid_stretch[:, keep] / scale[keep]
    reach = np.linalg.solve(inner, root.T @ flex[rows, load])
    through = np.linalg.solve(inner, rigid_stretch)
    a = np.linalg.lstsq(
        rigid_stretch.T @ through,
        rigid[load, keep] / scale[keep] - rigid_stretch.T @ reach,
        rcond=1e-12,
    )[0]
    f[rows] -= root @ (reach + through @ a)
    return f
