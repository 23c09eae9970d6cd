"""Places of the error of a number.

A bar is made of the energies of local solutions, cell by cell of the meridian
(:mod:`solidgear.judge.bounded`): each shoulder, seat end or other singular place has what the cells
around it hold.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.body import Body, Supports, as_supports
from solidgear.bounds.harmonic import richer_space
from solidgear.bounds.refining import Meshed, corner_strength
from solidgear.errors import SolidgearError, nearest, show
from solidgear.judge.bars import LEAST, ErrorBar
from solidgear.judge.bounded import bounded
from solidgear.judge.quantities import own_name, usual
from solidgear.judge.record import PlaceRecord, WhereRecord
from solidgear.judge.singular_places import Place, singular_places
from solidgear.judge.solving import ENOUGH, Statics, numbers, searched
from solidgear.judge.ties import SCENE
from solidgear.ladder import build
from solidgear.machine.memory import one_run
from solidgear.machine.threads import pinned
from solidgear.meshing.meridian import Meridian
from solidgear.quantity import ACROSS, QUANTITIES, Quantity
from solidgear.scene.coned import coned
from solidgear.solve.modes import ModeSet
from solidgear.solve.statics import SOLVED, flexibility

if TYPE_CHECKING:
    from solidgear.judge.solution import Solution
    from solidgear.scene import Scene

log = logging.getLogger(__name__)

#: bars that leave less than this beside what the solver leaves are rounding, and have no place
ROUNDING = 1e-9
#: exponents, and distances in lengths of the shaft, that differ by less are the same
SAME_EXPONENT, SAME_DISTANCE = 1e-3, 1e-9
ELSEWHERE = "elsewhere"


@dataclass(frozen=True)
class Row:
    """A place and its share of the error.

    Attributes
    ----------
    what : str
        ``shoulder``, ``seat end of A``, ...; ``elsewhere``.
    y, r : float
        m; of ``elsewhere`` the middle of the cell with most of it.
    share : float
        Of the sum over all places.
    reach : float or None
        Cells whose middle lies within this count as its, where no other place is nearer, m.
    """

    what: str
    y: float
    r: float
    share: float
    reach: float | None = None


@dataclass(frozen=True, eq=False)
class Whereabouts:
    """Places of the error of a number.

    Attributes
    ----------
    order : int
        Of the elements.
    total : float
        Bar of the quantity, relative; of a coupling, to the geometric mean of its diagonal entries.
    rows : tuple of Row
        Largest share first.
    points : (2, n) ndarray
        r and y of the corners of the cells, m.
    cells : (4, m) ndarray of int
    shares : (m,) ndarray
        Of every cell; in sum one.

    Examples
    --------
    >>> rows = (Row("shoulder", 0.186, 0.03, 0.97), Row(ELSEWHERE, 0.05, 0.02, 0.03))
    >>> none = np.zeros((0, 0))
    >>> print(Whereabouts(Quantity("C_zz"), 3, 4e-4, rows, none, none, none, 0.1).sentence)
    97 % of what is left in C_zz sits at the shoulder at y = 186 mm
    """

    quantity: Quantity
    order: int
    total: float
    rows: tuple[Row, ...]
    points: np.ndarray
    cells: np.ndarray
    shares: np.ndarray
    seconds: float

    @property
    def sentence(self) -> str:
        """Place of most of it, in words."""
        first, *rest = self.rows
        said = f"{_percent(first)} of what is left in {self.quantity} sits {_at(first)}"
        if first.share >= 0.5 or not rest:
            return said
        return f"{said}, {_percent(rest[0])} {_at(rest[0])}"


@pinned
def where(
    scene: Scene, quantity: str = "C_zz", options: Mapping[str, Any] | None = None
) -> Whereabouts:
    """Places of the error of a number of the harmonic solid, on one mesh.

    Parameters
    ----------
    quantity : str
        A compliance, a stiffness or a frequency, also of a further point or between two.
    options : mapping, optional
        Of the builder of the harmonic solid; by default the first mesh that is tried for an answer.

    Raises
    ------
    SolidgearError
        For an unknown quantity, one that this scene does not have, or one whose bar is no more than
        rounding.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = where(sg.load("geometry/shaft_stepped.toml"), "C_zz")
    >>> found.rows[0].what, round(sum(row.share for row in found.rows), 9)
    ('shoulder', 1.0)
    """
    start = time.perf_counter()
    asked = _known(scene, Quantity(quantity))
    options = Meshed().options() if options is None else options
    with one_run():
        body, supports = build(scene, "harmonic", **options), as_supports(scene)
        statics, found = _solved(scene, body, supports, asked)
        bar, shares = _shares(scene, body, supports, statics, found, asked)
        # a body with several attachments answers with the first
        places = singular_places(scene, (options.get("attachments") or ())[:1] or None)
        return _whereabouts(scene, body, places, asked, bar.width, shares, start)


def recorded_places(scene: Scene, solution: Solution) -> WhereRecord | None:
    """Places of the error of the least certain number of a harmonic solid, for the record.

    Parameters
    ----------
    solution : Solution
        Of the harmonic solid.

    Returns
    -------
    WhereRecord or None
        None where the error has no place: nothing is judged, or what is left is rounding.
    """
    start = time.perf_counter()
    bars = solution.error_bars.get(SCENE, {})
    judged = [q for q in usual(scene) if q in bars]
    if not judged:
        return None
    quantity = max(judged, key=lambda q: bars[q].width)
    if _rounding(bars[quantity]):
        return None
    shares, places = solution.scores[quantity], singular_places(scene)
    total = bars[quantity].width
    found = _whereabouts(scene, solution.body, places, quantity, total, shares, start)
    return WhereRecord(
        model=solution.model,
        quantity=quantity,
        order=found.order,
        total=found.total,
        sentence=found.sentence,
        rows=[PlaceRecord(**asdict(row)) for row in found.rows],
        points=found.points.tolist(),
        cells=found.cells.tolist(),
        shares=found.shares.tolist(),
        seconds=found.seconds,
    )


def _percent(row: Row) -> str:
    return f"{100 * row.share:.0f} %"


def _at(row: Row) -> str:
    place = f"y = {1e3 * row.y:.4g} mm"
    if row.what == ELSEWHERE:
        return f"away from shoulders and seat ends, most of it around {place}"
    return f"at the {row.what} at {place}"


def _known(scene: Scene, quantity: Quantity) -> Quantity:
    """A quantity as results call it."""
    names = (*QUANTITIES, *ACROSS)
    if quantity.symbol not in names:
        raise SolidgearError(
            f"there is no quantity {show(quantity, 40)}{nearest(quantity.symbol, names)}; "
            f"there are {', '.join(names)}"
        )
    if quantity.points and quantity.is_frequency:
        raise SolidgearError(
            f"{quantity}: a frequency is not of a point; ask for {quantity.symbol}"
        )
    return own_name(scene, quantity)


def _solved(
    scene: Scene, body: Body, supports: Supports, quantity: Quantity
) -> tuple[Statics | None, ModeSet | None]:
    """Statics at the points of a quantity, or modes, whichever it needs."""
    if quantity.is_frequency:
        return None, searched(body, supports, ENOUGH, [quantity], spare=True, ovalising=False)
    flexibility(body, SOLVED)
    return Statics.of(scene, body, supports, [quantity]), None


def _shares(
    scene: Scene,
    body: Body,
    supports: Supports,
    statics: Statics | None,
    found: ModeSet | None,
    quantity: Quantity,
) -> tuple[ErrorBar, np.ndarray]:
    """Bar of a quantity that is solved, and (m,) shares of it by cells."""
    _exists(quantity, statics, found)
    solver = numbers(statics, None).solver
    told = bounded(scene, body, supports, statics, found, [quantity], solver)
    bar, score = told.error_bars[quantity], told.scores[quantity]
    if _rounding(bar):
        raise SolidgearError(
            f"the bar of {quantity} is {bar.width:.1e}, which is rounding; there is no error to place"
        )
    return bar, score / score.sum()


def _rounding(bar: ErrorBar) -> bool:
    """Tell whether a bar is no more than rounding, and has no place."""
    return bar.width - bar.solver - LEAST < ROUNDING


def _whereabouts(
    scene: Scene,
    body: Body,
    places: tuple[Place, ...],
    quantity: Quantity,
    total: float,
    shares: np.ndarray,
    start: float,
) -> Whereabouts:
    """Places of the error of a quantity, begun at some time."""
    flat = body.geometry.meridian  # type: ignore[union-attr]
    rows = _rows(places, flat, _owners(scene, body, places), shares)
    order = int(body.mesh["order"])
    spent = time.perf_counter() - start
    return Whereabouts(quantity, order, total, rows, flat.points, flat.cells, shares, spent)


def _exists(quantity: Quantity, statics: Statics | None, found: ModeSet | None) -> None:
    """Refuse a quantity that is not there."""
    if quantity.is_frequency:
        if found is None or found.named(quantity) is None:
            raise SolidgearError(f"{quantity} is not among the lowest modes of this scene")
    elif statics is None or quantity not in statics.values():
        raise SolidgearError(f"{quantity} does not exist in this scene: the motion is free")


def _rows(
    places: tuple[Place, ...], flat: Meridian, owners: list[list[int]], shares: np.ndarray
) -> tuple[Row, ...]:
    """Shares of the places and of what belongs to none, the largest first."""
    sums, away = np.zeros(len(places)), shares.copy()
    for cell, own in enumerate(owners):
        if own:
            sums[own] += shares[cell] / len(own)
            away[cell] = 0.0
    rows = [Row(p.what, p.y, p.r, float(x), p.reach) for p, x in zip(places, sums)]
    r, y = flat.points[:, flat.cells[:, away.argmax()]].mean(axis=1)
    rows.append(Row(ELSEWHERE, float(y), float(r), float(away.sum())))
    return tuple(sorted(rows, key=lambda row: -row.share))


def _owners(scene: Scene, body: Body, places: tuple[Place, ...]) -> list[list[int]]:
    """Places that every cell of a mesh belongs to, of several each to the same part.

    Of a cell with singular corners it is that of the sharpest: where cells are as small as each
    other a smaller exponent costs more. Of all else it is the nearest to its middle, if that
    reaches so far.
    """
    flat = body.geometry.meridian  # type: ignore[union-attr]
    corners: dict[int, tuple[list[int], float]] = {}
    for vertex, (kind, angle) in richer_space(coned(scene), body).corners.items():
        at = _nearest(scene, places, flat.points[:, vertex])
        if at:
            corners[vertex] = at, corner_strength(kind, angle)
    out = []
    for cell in flat.cells.T:
        here = [corners[v] for v in map(int, cell) if v in corners]
        sharpest = min((exponent for _, exponent in here), default=0.0) + SAME_EXPONENT
        own = [at for at, exponent in here if exponent < sharpest]
        out.append(
            list(dict.fromkeys(k for at in own for k in at))
            or _nearest(scene, places, flat.points[:, cell].mean(axis=1))
        )
    return out


def _nearest(scene: Scene, places: tuple[Place, ...], point: np.ndarray) -> list[int]:
    """The nearest of some places to a point, r and y in m; none where that does not reach so far,
    several where they are as near.
    """
    away = np.array([np.hypot(p.r - point[0], p.y - point[1]) for p in places])
    least = away.min(initial=np.inf) + SAME_DISTANCE * scene.length
    return [k for k, p in enumerate(places) if away[k] <= min(least, p.reach)]
