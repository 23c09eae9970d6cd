"""Where the error of a compliance sits.

One order more on the same mesh adds ``e = u(p+1) - u(p)`` to the displacement under a unit load at
the lumped point.  The displacements of order p are among those of order p + 1, so e does no work
on them (Galerkin orthogonality) and ``a(e, e) = C(p+1) - C(p)``, where a is the strain energy of
the shaft and of its bearings, twice: the change of the compliance is a sum over the places where
the error is.  Of a coupling, the same with the errors of two loads, whose product may have either
sign.  See e.g. Ainsworth and Oden, A Posteriori Error Estimation in Finite Element Analysis (2000),
ch. 5.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.body import Body, as_supports
from solidgear.errors import SolidgearError, nearest, show
from solidgear.evidence.places import Place, singular_places
from solidgear.evidence.quantities import change, described
from solidgear.evidence.record import PlaceRecord, WhereRecord
from solidgear.evidence.ties import SCENE
from solidgear.fidelity import build
from solidgear.fidelity.harmonic_energy import Meridional, PointEnergies
from solidgear.fidelity.levels import HARMONIC
from solidgear.fidelity.options import HARMONIC_OPTIONS
from solidgear.machine.memory import one_run
from solidgear.machine.threads import pinned
from solidgear.solve.families import FAMILIES
from solidgear.solve.statics import condense
from solidgear.solve.supported import Supported, decoupled, groups

if TYPE_CHECKING:
    from solidgear.body import Supports
    from solidgear.evidence.study import Solution
    from solidgear.scene import Scene

log = logging.getLogger(__name__)

#: compliances that can be placed, and the components of the loads they belong to
PLACED = ("C_zz", "C_z,thx", "C_thx", "C_yy")
#: the mesh by default: the coarsest one that an answer may rest on
USUAL = HARMONIC[1]
#: options that make a mesh
OF_A_MESH = ("order", "layers", "edge_layers", "ratio", "relative_size", "size", "refinement")
#: couplings by bearings may be left out where they move nothing by more than this
COUPLING = 1e-6
#: changes of a compliance below this are rounding, and have no place
ROUNDING = 1e-9
ELSEWHERE, SPRINGS = "elsewhere", "bearings"


@dataclass(frozen=True)
class Row:
    """A place and its share of the error.

    Attributes
    ----------
    what : str
        ``shoulder``, ``seat end of A``, ...; ``elsewhere``, and ``bearings`` for what their springs
        take up.
    y, r : float or None
        m; of ``elsewhere`` the middle of the cell with most of it, of ``bearings`` None.
    share : float
        Of the sum over all places; of a coupling, of the sum of magnitudes.
    reach : float or None
        What lies within this of the place counts as its, where no other place is nearer, m.
    """

    what: str
    y: float | None
    r: float | None
    share: float
    reach: float | None = None


@dataclass(frozen=True, eq=False)
class Whereabouts:
    """Where the error of a compliance sits.

    Attributes
    ----------
    quantity : str
    order : int
        p, of the mesh that is judged by one order more.
    total : float
        Relative change of the quantity from p to p + 1; of a coupling, to the geometric mean of its
        diagonal entries.
    check : float
        Sum of the energies over the change of the quantity; one but for rounding.
    rows : tuple of Row
        Largest share first.
    points : (2, n) ndarray
        r and y of the corners of the cells, m.
    cells : (4, m) ndarray of int
    shares : (m,) ndarray
        Of every cell.
    seconds : float

    Examples
    --------
    >>> rows = (Row("shoulder", 0.186, 0.03, 0.97), Row(ELSEWHERE, 0.05, 0.02, 0.03))
    >>> none = np.zeros((0, 0))
    >>> print(Whereabouts("C_zz", 3, 4e-4, 1.0, rows, none, none, none, 0.1).sentence)
    97 % of what is left in C_zz sits at the shoulder at y = 186 mm
    """

    quantity: str
    order: int
    total: float
    check: float
    rows: tuple[Row, ...]
    points: np.ndarray
    cells: np.ndarray
    shares: np.ndarray
    seconds: float

    @property
    def sentence(self) -> str:
        """Where most of it sits."""
        first, *rest = self.rows
        said = f"{_percent(first)} of what is left in {self.quantity} sits {_at(first)}"
        if abs(first.share) >= 0.5 or not rest:
            return said
        return f"{said}, {_percent(rest[0])} {_at(rest[0])}"


@pinned
def where(
    scene: Scene, quantity: str = "C_zz", options: Mapping[str, Any] | None = None
) -> Whereabouts:
    """Places of the error of a compliance at the lumped point, on one mesh of the harmonic solid.

    Parameters
    ----------
    scene : Scene
    quantity : str
        ``C_zz``, ``C_z,thx``, ``C_thx`` or ``C_yy``.
    options : mapping, optional
        Of the builder of the harmonic solid; by default order 3 with a layer towards every
        singular point.

    Returns
    -------
    Whereabouts

    Raises
    ------
    SolidgearError
        For another quantity, one that this scene does not have, an order that has none above it, or
        a change that is no more than rounding.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = where(sg.load("geometry/shaft_stepped.toml"), "C_zz")
    >>> found.rows[0].what, abs(found.check - 1) < 0.01
    ('shoulder', True)
    """
    start = time.perf_counter()
    if quantity not in PLACED:
        raise SolidgearError(
            f"the error of {show(quantity, 40)} has no places{nearest(quantity, PLACED)}; "
            f"there are those of {', '.join(PLACED)}"
        )
    options = {**USUAL, **(options or {})}
    order = _order(options)
    i, j = _entry(quantity)
    with one_run():
        components = _components(scene, quantity)
        options["families"] = tuple(f for f, own in FAMILIES.items() if set(own) & components)
        supports = as_supports(scene).on(components)
        loads = sorted({2, 3} if i in (2, 3) else {i})
        low = _Solved(scene, supports, loads, options)
        high = _Solved(scene, supports, loads, {**options, "order": order + 1})
        points, springs = _error(low, high)
    place = loads.index(i), loads.index(j)
    total = change(high.named(), low.named(), quantity) or 0.0
    if abs(total) < ROUNDING:
        raise SolidgearError(
            f"{quantity} changes by {abs(total):.1e} from order {order} to {order + 1}, "
            "which is rounding; there is no error to place"
        )
    energy, spring = points.energy[place], float(springs[place])
    difference = high.compliance[place] - low.compliance[place]
    places = singular_places(scene, options.get("attachments"))
    rows, size = _rows(places, points, energy, spring)
    return Whereabouts(
        quantity,
        order,
        total,
        float((energy.sum() + spring) / difference),
        rows,
        low.meridional.flat.points,
        low.meridional.flat.cells,
        energy.sum(axis=1) / size,
        time.perf_counter() - start,
    )


def recorded_places(scene: Scene, rung: Solution) -> WhereRecord | None:
    """Places of the error of the least certain compliance of a harmonic solid, for the record.

    Parameters
    ----------
    scene : Scene
    rung : Solution
        Of the harmonic solid.

    Returns
    -------
    WhereRecord or None
        None where the error has no place: nothing holds the shaft, or what is left is rounding.
    """
    bands = {q: band.gci for q, band in rung.bands.get(SCENE, {}).items() if q in PLACED}
    if not bands:
        return None
    quantity = max(bands, key=bands.__getitem__)
    mesh = {name: value for name, value in rung.options.items() if name in OF_A_MESH}
    try:
        found = where(scene, quantity, mesh)
    except SolidgearError as error:
        log.info("places of the error left out: %s", error)
        return None
    return WhereRecord(
        model=rung.model,
        quantity=quantity,
        order=found.order,
        total=found.total,
        check=found.check,
        sentence=found.sentence,
        rows=[PlaceRecord(**asdict(row)) for row in found.rows],
        points=found.points.tolist(),
        cells=found.cells.tolist(),
        shares=found.shares.tolist(),
        seconds=found.seconds,
    )


def _percent(row: Row) -> str:
    return f"{100 * abs(row.share):.0f} %"


def _at(row: Row) -> str:
    if row.y is None:
        return "in the springs of the bearings"
    place = f"y = {1e3 * row.y:.4g} mm"
    if row.what == ELSEWHERE:
        return f"away from shoulders and seat ends, most of it around {place}"
    return f"at the {row.what} at {place}"


def _order(options: Mapping[str, Any]) -> int:
    order, most = options["order"], int(HARMONIC_OPTIONS["order"].most or 0)
    if not isinstance(order, int) or isinstance(order, bool) or not 1 <= order < most:
        raise SolidgearError(
            f"order = {show(order)} has no order above it to be judged by; "
            f"give a whole number from 1 to {most - 1}"
        )
    return order


def _entry(quantity: str) -> tuple[int, int]:
    _, place, _ = described(quantity)
    assert not isinstance(place, str)  # as every compliance
    return place


def _components(scene: Scene, quantity: str) -> set[int]:
    """Components that the bearings couple to those of a quantity, by the coarsest of meshes."""
    body = build(scene, "harmonic", order=1, layers=0, edge_layers=0, relative_size=4.0)
    supports = as_supports(scene)
    statics = condense(body, supports, scene.port.name)
    i, j = _entry(quantity)
    if not np.isfinite(statics.compliance[[i, j], [i, j]]).all():
        raise SolidgearError(f"{quantity} does not exist in this scene: the motion is free")
    spring, _ = decoupled(body, supports, COUPLING)
    for group in groups(body, supports, spring):
        here = {c for b in group for c in body.blocks[b].components}
        if i in here:
            # a family is built whole: both bending planes, whether the bearings couple them or not
            return {c for own in FAMILIES.values() if here & set(own) for c in own}
    raise SolidgearError(f"no block of the harmonic solid carries {quantity}")


class _Solved:
    """Displacements of a scene under unit loads at its lumped point, on one mesh."""

    def __init__(
        self, scene: Scene, supports: Supports, loads: list[int], options: Mapping[str, Any]
    ):
        self.loads = loads
        self.body: Body = build(scene, "harmonic", **options)
        self.meridional = Meridional(scene, self.body)
        spring, _ = decoupled(self.body, supports, COUPLING)
        group = next(
            g
            for g in groups(self.body, supports, spring)
            if any(loads[0] in self.body.blocks[b].components for b in g)
        )
        self.supported = Supported(self.body, supports, spring, group)
        rows = self._rows(scene.port.name)
        self.fields = self.supported.static(rows.T)
        self.compliance = rows @ self.fields

    def _rows(self, port: str) -> np.ndarray:
        """(loads, n) rows that give the motions of the port."""
        index = self.body.port_index(port)
        parts = []
        for block in self.supported.blocks:
            own = block.components
            part = np.zeros((len(self.loads), block.size))
            for k, c in enumerate(self.loads):
                if c in own:
                    part[k] = block.ports[[index * len(own) + own.index(c)]].toarray().ravel()
            parts.append(part)
        return np.hstack(parts)

    def named(self) -> dict[str, float]:
        """The compliances found, by name."""
        out = {}
        for name in PLACED:
            i, j = _entry(name)
            if i in self.loads and j in self.loads:
                out[name] = float(self.compliance[self.loads.index(i), self.loads.index(j)])
        return out

    def stretch(self) -> np.ndarray:
        """(r, k) stretch of the springs, the root of their energy."""
        return self.supported.load.T @ self.fields


def _error(low: _Solved, high: _Solved) -> tuple[PointEnergies, np.ndarray]:
    """Energies of what the higher order adds: at the points of the shaft, and in its springs."""
    r = y = energy = None
    parts = zip(low.supported.parts(low.fields), high.supported.parts(high.fields))
    for block, (coarse, fine) in zip(high.supported.group, parts):
        known = high.meridional.embedded(low.meridional, low.meridional.local(block, coarse))
        found = high.meridional.energies(block, high.meridional.local(block, fine) - known)
        r, y = found.r, found.y
        energy = found.energy if energy is None else energy + found.energy
    assert r is not None and y is not None and energy is not None  # a group has a block
    more = high.stretch() - low.stretch()
    return PointEnergies(r, y, energy), more.T @ more


def _rows(
    places: tuple[Place, ...], points: PointEnergies, energy: np.ndarray, spring: float
) -> tuple[tuple[Row, ...], float]:
    """Shares of the places, every point of the shaft going to the nearest if that reaches so far;
    and what they are shares of.
    """
    nearest_yet = np.full(energy.shape, np.inf)
    owner = np.full(energy.shape, -1)
    for k, place in enumerate(places):
        distance = np.hypot(points.y - place.y, points.r - place.r)
        closer = distance < nearest_yet
        nearest_yet[closer] = distance[closer]
        owner[closer] = np.where(distance[closer] <= place.reach, k, -1)
    sums = [float(energy[owner == k].sum()) for k in range(len(places))]
    away = float(energy[owner == -1].sum())
    size = sum(abs(x) for x in (*sums, away, spring))
    rows = [Row(p.what, p.y, p.r, float(x / size), p.reach) for p, x in zip(places, sums)]
    cell = int(np.abs(np.where(owner == -1, energy, 0.0).sum(axis=1)).argmax())
    rows.append(
        Row(ELSEWHERE, float(points.y[cell].mean()), float(points.r[cell].mean()), away / size)
    )
    rows.append(Row(SPRINGS, None, None, spring / size))
    return tuple(sorted(rows, key=lambda row: -abs(row.share))), size
