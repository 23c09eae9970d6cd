"""Distance of a corrected solid from the exact solution: bounds of the difference of two errors.

Flexibility is corrected as a sum,

    F = F_harmonic + (F_with - F_without),

of which both 3D solids are on the same cells.  With E the energies of their errors, under the same
loads on the ports, and M that of the harmonic solid,

    F_exact - F = M + (E_with - E_without).

In one order more (:mod:`solidgear.core.bounds.solid`) both errors are known, e_with and e_without in
the functions of the mesh and one order more, and so is the difference D of their energies.  What is
beyond one order more, q, is orthogonal to both, so that its energies add to them:

    E_with - E_without = D + sum over cells of a(q_with, q_with) - a(q_without, q_without)

In a cell of both the products of two such remainders are a quadratic form of the two solutions there,
positive and no larger than (s - 1) times that of the errors in one order more, where ``1/s`` is the
share that one order takes at the sharpest edge.  Let d = e_with - e_without and g = e_with +
e_without there: of any such form Q, with any t > 0,

    4 t Q(d, g) = Q(d + t g, d + t g) - Q(d - t g, d - t g)

    -(s - 1) |d - t g|^2 / 4 t  <=  Q(d, g)  <=  (s - 1) |d + t g|^2 / 4 t.

With t = |d| / |g| these are half of (s - 1) times ``a(d, g) -+ |d| |g|``: where features change
nothing, both errors are the same and nothing remains, however large they are.  In a cell that
features remove only the error without them counts: t = 1.  With a fixed t in every cell both sides
are quadratic forms of the loads, so that bearings, held ports and couplings come after that, as with
other solids.

Frequencies are corrected by way of free modes, which is no sum.  Their bounds come from a sum of
their own: of an eigenvalue in the same bearings on all three bodies, whose errors are the same
energies under the same rule,

    lambda = lambda_with - (lambda_without - lambda_harmonic) - M - (E_with - E_without)

and the error bar is the distance of the corrected one from the further end.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from solidgear.core import Body, SolidgearError
from solidgear.core import modes as modes_of
from solidgear.core.body.cache import Cache
from solidgear.core.bounds.harmonic import (
    HarmonicBounds,
    eigenvalue,
    harmonic_bounds,
    least_frequency,
)
from solidgear.core.bounds.solid import (
    FIELDS,
    Errors,
    eigenvalues,
    errors_of_loads,
    errors_of_modes,
    on_mesh,
    share_of_error,
)
from solidgear.core.models.solid.enriched import by_cells, products_by_cells
from solidgear.core.models.solid.mesh import SolidMesh
from solidgear.core.safety import ALIKE, TURNING
from solidgear.core.scene.coned import coned
from solidgear.core.solve.statics import flexibility, port_fields
from solidgear.cuts.corrected.body import Origin
from solidgear.cuts.solid.halves import HalfDrawing

if TYPE_CHECKING:
    from solidgear.core import Mode, ModeSet, Scene, Supports

#: shapes solved above those of the corrected solid, for 3D solids ovalise besides
ABOVE = 6
#: least ratio of a change by features to the whole that weighs both in a cell: rounding
SAME, TINY = 1e-6, 1e-300


@dataclass
class CorrectedBounds:
    """Bounds of one corrected body; cells are those of the 3D mesh of the plain part."""

    body: Body
    #: (6 p, 6 p) ends between which the flexibility grows, safety included
    least: np.ndarray
    more: np.ndarray
    #: least eigenvalue that each mode may have, rad^2/s^2, where one is known
    lowest: dict[str, float]
    of_modes: dict[str, np.ndarray]  #: (ne,) width of the bounds of a mode, by its name
    #: (ne, 6 p, 6 p) width of the bounds of the flexibility
    of_ports: np.ndarray
    #: a correction errs to both sides, as far up for a mode as down to `lowest`
    two_sided: ClassVar = True

    @property
    def less(self) -> np.ndarray:
        """(6 p, 6 p) zero: no further order takes a part of the error."""
        return np.zeros_like(self.more)

    def energy_by_cells(self, forces: np.ndarray) -> np.ndarray:
        """Return (ne,) widths of the bounds under forces (6 p,) on the ports, but for the harmonic
        solid's part, which is on other cells.
        """
        return np.einsum("i,cij,j->c", forces, self.of_ports, forces)

    def softer(self, more: np.ndarray) -> Body:
        """Return the body with another flexibility; only ports know of it."""
        computed = flexibility(self.body)
        return replace(self.body, cache=Cache(replace(computed, matrix=computed.matrix + more)))

    def frequency(self, mode: Mode) -> float | None:
        """Return the least frequency that a mode may have, Hz, and it may be as much higher; None
        where no modes of the bodies that it was made of are its own.
        """
        return least_frequency(self.lowest, mode)


def corrected_bounds(
    scene: Scene,
    body: Body,
    supports: Supports,
    *,
    statics: bool,
    modes: ModeSet | None = None,
    wanted: Sequence[str] = (),
    safety: float = 1.0,
) -> CorrectedBounds:
    """Compute bounds of the flexibility and of some modes of a corrected body on some supports;
    other parameters are those of :func:`solidgear.core.bounds.harmonic.harmonic_bounds`.
    """
    origin = body.cache.find(Origin)
    if origin is None:
        raise SolidgearError("corrected: the bodies that it was made of were forgotten")
    difference = _Difference(scene, origin)
    size, cells = 6 * len(body.ports), difference.cells
    ports = np.zeros((cells if statics else 0, size, size))
    least, more = np.zeros((2, size, size))
    if statics:
        plain = harmonic_bounds(coned(scene.plain), origin.plain, statics=True).tailed
        lower, upper, ports = difference.of_ports(np.diag(flexibility(body).matrix))
        middle, half = (lower + upper + plain) / 2, safety * (upper + plain - lower) / 2
        least, more = middle - half, middle + half
    ends: dict[str, float] = {}
    widths: dict[str, np.ndarray] = {}
    chosen = [m for name in wanted if modes is not None and (m := modes.named(name)) is not None]
    if modes is not None and chosen:
        ends, widths = _of_modes(difference, supports, modes, chosen, safety)
    return CorrectedBounds(body, least, more, ends, widths, ports)


@dataclass
class _Difference:
    """The difference of the errors of both 3D solids of a correction."""

    scene: Scene
    origin: Origin

    @property
    def cells(self) -> int:
        """Number of cells of the plain part."""
        return len(self.origin.kept)

    @cached_property
    def beyond(self) -> float:
        """Energy beyond one order more over that in one order more, at most."""
        return share_of_error(self.scene, self.origin.without) - 1

    def in_cells(self, body: Body, index: int, errors: Errors) -> np.ndarray:
        """Return the values (ne, b, k) of the errors of a 3D solid in the cells of the plain part,
        zero in those that it does not have.
        """
        values = by_cells(_mesh(body), on_mesh(body, index, errors), errors.fields)
        if body is self.origin.without:
            return values
        out = np.zeros((self.cells, *values.shape[1:]))
        out[self.origin.kept] = values
        return out

    def products(
        self, with_: np.ndarray, without: np.ndarray
    ) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]]:
        """Yield some cells after others with the products (e, k, k) of energy of both errors: with
        features, of both and without.
        """
        mesh = _mesh(self.origin.without)
        copies = 1 if mesh is self.origin.without.geometry else 2
        materials = [segment.material for segment in self.scene.segments]
        count = with_.shape[2]
        for part, energy in products_by_cells(mesh, materials, (with_, without)):
            energy = copies * energy
            rows = energy[:, :count], energy[:, count:]
            yield part, rows[0][..., :count], rows[0][..., count:], rows[1][..., count:]

    def of_ports(self, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return both ends (6 p, 6 p) of the difference of the errors of the flexibility, and the
        distance between them by cells; `scale` are flexibilities of one component each.
        """
        with_, without = self.origin.with_, self.origin.without
        size = len(scale)
        lower, upper = np.zeros((2, size, size))
        by_cell = np.zeros((self.cells, size, size))
        blocks = zip(port_fields(with_, FIELDS), port_fields(without, FIELDS))
        for (index, fields, *_), (_, plain_fields, *_) in blocks:
            rows = with_.rows(with_.blocks[index])
            place = np.ix_(rows, rows)
            errors = errors_of_loads(with_, index, fields)
            plain_errors = errors_of_loads(without, index, plain_fields)
            values = self.in_cells(with_, index, errors)
            plain_values = self.in_cells(without, index, plain_errors)
            weight = 1 / np.where(scale[rows] > 0, scale[rows], np.inf)
            for part, ww, wo, oo in self.products(values, plain_values):
                crossed = wo + wo.transpose(0, 2, 1)
                change, total = ww - crossed + oo, ww + crossed + oo
                size_of_change, size_of_total = (
                    np.einsum("eii,i->e", np.maximum(x, 0.0), weight) for x in (change, total)
                )
                t = np.sqrt(size_of_change / np.maximum(size_of_total, TINY))
                t = np.maximum(t, SAME)[:, None, None]
                difference = ww - oo
                mean = (change / t + t * total) / 4
                low, high = (self.beyond * (mean + side * difference / 2) for side in (-1, 1))
                lower[place] += (difference - low).sum(axis=0)
                upper[place] += (difference + high).sum(axis=0)
                by_cell[np.ix_(part, rows, rows)] = low + high
        return lower, upper, by_cell

    def of_modes(
        self, index: int, fields: np.ndarray, values: np.ndarray, plain: _Plain
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return both ends (k,) of the difference of the errors of eigenvalues of a block, and the
        distance between them by cells (ne, k), from modes (n, k) with features, eigenvalues (k,)
        and modes of the plain part.
        """
        with_, without = self.origin.with_, self.origin.without
        errors = errors_of_modes(with_, index, fields, values)
        plain_errors = errors_of_modes(without, index, plain.fields, plain.values)
        plain_values = self.in_cells(without, index, plain_errors) @ plain.turn
        lower, upper = np.zeros((2, len(values)))
        by_cell = np.zeros((self.cells, len(values)))
        for part, *energies in self.products(self.in_cells(with_, index, errors), plain_values):
            ww, wo, oo = (np.einsum("ekk->ek", x) for x in energies)
            difference = ww - oo
            mean = (
                np.sqrt(np.maximum(ww - 2 * wo + oo, 0.0) * np.maximum(ww + 2 * wo + oo, 0.0)) / 2
            )
            lower += (difference - self.beyond * (mean - difference / 2)).sum(axis=0)
            upper += (difference + self.beyond * (mean + difference / 2)).sum(axis=0)
            by_cell[part] = 2 * self.beyond * mean
        return lower, upper, by_cell


def _mesh(solid: Body) -> SolidMesh:
    """Return the mesh of a 3D solid, or of half of it."""
    drawing = solid.geometry.mesh if isinstance(solid.geometry, HalfDrawing) else solid.geometry
    assert isinstance(drawing, SolidMesh)
    return drawing


@dataclass(frozen=True)
class _Plain:
    """Modes of one block of the plain part."""

    fields: np.ndarray  #: (n, l)
    values: np.ndarray  #: (l,) eigenvalues, rad^2/s^2
    turn: np.ndarray  #: (l, k) that makes them most like those with features


@dataclass(frozen=True)
class _Shape:
    """One shape of a mode."""

    mode: Mode
    value: float  #: eigenvalue, rad^2/s^2
    vector: Mapping[int, np.ndarray]
    motion: np.ndarray  #: (6 s,) of sections, of unit length


def _shapes(mode_set: ModeSet, gram: np.ndarray) -> list[_Shape]:
    """Return all elastic shapes that move sections."""
    out = []
    for mode in mode_set.solved:
        for value, vector, moved in zip(eigenvalues(mode), mode.vectors, mode.motions):
            motion = moved.ravel()
            length = np.sqrt(motion @ gram @ motion)
            if mode.frequency_hz > 0 and length > 0:
                out.append(_Shape(mode, value, vector, motion / length))
    return out


def _of_modes(
    difference: _Difference,
    supports: Supports,
    mode_set: ModeSet,
    chosen: Sequence[Mode],
    safety: float,
) -> tuple[dict[str, float], dict[str, np.ndarray]]:
    """Return the least eigenvalues of some modes and the widths of their bounds by cells."""
    origin, gram = difference.origin, mode_set.gram
    highest = max(mode.frequency_hz for mode in chosen)
    count = sum(m.multiplicity for m in mode_set.solved if 0 < m.frequency_hz <= highest) + ABOVE
    with_set, without_set, plain_set = (
        modes_of(body, supports, count, ovalising=False)
        for body in (origin.with_, origin.without, origin.plain)
    )
    cut, uncut, plain = (_shapes(x, gram) for x in (with_set, without_set, plain_set))
    partners = [_most_like(cut, mode.motions[0].ravel(), gram) for mode in chosen]
    bests = [_most_like(uncut, shape.motion, gram) for shape in partners if shape is not None]
    # of shapes near these, those near of the harmonic solid
    names = [s.mode.name for s in plain if any(_near(s, best, 3 * TURNING) for best in bests)]
    bounds = harmonic_bounds(
        coned(difference.scene.plain),
        origin.plain,
        statics=False,
        modes=plain_set,
        wanted=list(dict.fromkeys(names)),
    )
    plain = [shape for shape in plain if shape.mode.name in bounds.lowest]
    lowest: dict[str, float] = {}
    widths: dict[str, np.ndarray] = {}
    ends = {id(shape): _plain_ends(shape, plain, bounds, gram) for shape in uncut}
    # bearings may couple both halves of a solid: the errors of all blocks of a mode add up
    for blocks in {frozenset(shape.vector) for shape in partners if shape is not None}:
        group = [s for s in uncut if set(s.vector) == blocks and ends[id(s)] is not None]
        pairs = []
        for mode, shape in zip(chosen, partners):
            if shape is None or set(shape.vector) != blocks:
                continue
            turn = _turned(group, shape, gram)
            if turn is not None:
                pairs.append((mode, shape, turn))
        if not pairs:
            continue
        turns = np.column_stack([turn for *_, turn in pairs])
        values = np.array([shape.value for _, shape, _ in pairs])
        plain_values = np.array([shape.value for shape in group])
        lower, upper = np.zeros((2, len(pairs)))
        by_cell = np.zeros((difference.cells, len(pairs)))
        for index in blocks:
            fields = np.column_stack([shape.vector[index] for _, shape, _ in pairs])
            plain_fields = np.column_stack([shape.vector[index] for shape in group])
            of_plain = _Plain(plain_fields, plain_values, turns)
            of_block = difference.of_modes(index, fields, values, of_plain)
            lower, upper, by_cell = (x + y for x, y in zip((lower, upper, by_cell), of_block))
        exact = np.array([ends[id(shape)] for shape in group])
        # what the 3D solid without features errs by, at least and at most
        least, most = ((turns**2).T @ (plain_values - end) for end in exact.T[::-1])
        for k, (mode, *_) in enumerate(pairs):
            low, high = values[k] - most[k] - upper[k], values[k] - least[k] - lower[k]
            value = eigenvalue(mode)
            distance = abs(value - (low + high) / 2) + safety * (high - low) / 2
            lowest[mode.name] = value - distance
            widths[mode.name] = by_cell[:, k]
    return lowest, widths


def _most_like(shapes: Sequence[_Shape], motion: np.ndarray, gram: np.ndarray) -> _Shape | None:
    """Return the shape that is most like a motion of sections; None where none is like it."""
    length = motion @ gram @ motion
    cosines = [(shape.motion @ gram @ motion) ** 2 / length for shape in shapes]
    best = int(np.argmax(cosines)) if cosines else 0
    return shapes[best] if cosines and cosines[best] > ALIKE else None


def _near(shape: _Shape, other: _Shape | None, most: float) -> bool:
    """Return whether frequencies of two shapes differ by less than a share."""
    return other is not None and abs(shape.mode.frequency_hz / other.mode.frequency_hz - 1) < most


def _turned(shapes: Sequence[_Shape], wanted: _Shape, gram: np.ndarray) -> np.ndarray | None:
    """Return the combination (l,) of near shapes, of unit length, that is most like another one;
    None where none is.
    """
    best = _most_like(shapes, wanted.motion, gram)
    if best is None:
        return None
    near = [_near(shape, best, TURNING) for shape in shapes]
    cosines = np.array([s.motion @ gram @ wanted.motion for s in shapes]) * near
    return cosines / np.linalg.norm(cosines)


def _plain_ends(
    shape: _Shape, plain: Sequence[_Shape], bounds: HarmonicBounds, gram: np.ndarray
) -> tuple[float, float] | None:
    """Return both ends of the exact eigenvalue of a shape of the plain part, from the harmonic modes
    that it consists of; None where it consists of none.
    """
    near = [s for s in plain if _near(s, shape, TURNING)]
    shares = np.array([(s.motion @ gram @ shape.motion) ** 2 for s in near])
    if shares.sum() < ALIKE:
        return None
    ends = np.array([(bounds.lowest[s.mode.name], s.value) for s in near])
    low, high = shares @ ends / shares.sum()
    return float(low), float(high)
