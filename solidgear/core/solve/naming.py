"""Names of modes: the family by the motion of the shape around the axis, twins by symmetry, numbers
by frequency.

Families are ``axial``, ``breathing`` and ``torsion`` (nothing varies around the axis: n = 0),
``bending`` (n = 1) and ``ovalising n=2`` and so on. For a body in blocks n is that of the block,
whatever its sections do; shapes of a 3D mesh are fitted by :mod:`solidgear.core.solve.circumference`.

Two modes are one pair only where symmetry makes them so: the same profile over the meridian, a
quarter of a wave further round, with bearings that a quarter turn leaves as they are, or with n >=
2, which bearings do not touch. However far a mesh splits twins, they are one pair: the split is an
error of the mesh, is a part of the error bar, and is reported where it is unusual.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse.csgraph import connected_components

from solidgear.core.body import Block, Body, Supports, component_rows
from solidgear.core.body.sections import signed
from solidgear.core.frames import rotation
from solidgear.core.solve.circumference import Circumference, Displacements, circumference_of
from solidgear.core.solve.families import (
    FAMILIES,
    family_of,
    has_several_families,
    repeats,
    waves_of,
)
from solidgear.core.solve.neighbours import shared_families

#: Bearings that a quarter turn changes by no more than this, relative, split a pair by half of it
#: at most.
ALIKE = 1e-6
_QUARTER = rotation(1, np.pi / 2)
#: Distance, relative, that 3D meshes usually leave between eigenvalues of twins of two and more
#: waves.
OVAL_TOLERANCE = 1e-2
#: shapes of a 3D mesh that are fitted around the axis at once
TOGETHER = 8


@dataclass
class Shape:
    """A shape without a name yet."""

    family: str
    waves: int  #: around the axis
    motion: np.ndarray  #: (stations, 6) section motions
    captured: float  #: share of the modal mass they describe
    profile: np.ndarray | dict[int, np.ndarray]  #: compared by :meth:`Names.overlap`
    #: whether it stands for its twin as well, as a block of two waves and more does for its cosine
    #: and its sine form
    double: bool = False
    #: ``z`` or ``x`` where bending stays in one plane of a part that has a mirror plane but is not
    #: round, else empty
    plane: str = ""

    @property
    def label(self) -> str:
        """Family and plane, within which modes are numbered."""
        return f"{self.family} {self.plane}" if self.plane else self.family


#: numbers and fields of the blocks that a shape moves: the same in every list that has it
Same = tuple[tuple[int, int], ...]


def same(vectors: dict[int, np.ndarray]) -> Same:
    """Return what a shape, by block index, has in common with itself in another list."""
    return tuple((block, id(field)) for block, field in vectors.items())


#: loads, Gram matrix and columns of the section motions of a block
_Loads = tuple[np.ndarray, np.ndarray, np.ndarray]


class Projection:
    """Mass-weighted projection of shapes onto section motions along the axis, at stations (s,) in
    ascending order, m, the first and the last at the ends of the shaft.
    """

    def __init__(self, body: Body, stations: np.ndarray):
        size = 6 * len(stations)
        self.count = len(stations)
        self.gram = np.zeros((size, size))  #: mass matrix of section motions
        self.parts = []
        loads_of_blocks: list[_Loads] = []
        for block in body.blocks:
            loaded, gram, columns = _section_loads(block, stations, loads_of_blocks)
            loads_of_blocks.append((loaded, gram, columns))
            self.gram[np.ix_(columns, columns)] += gram
            self.parts.append((loaded, columns, np.linalg.pinv(gram, rcond=1e-12, hermitian=True)))
        self.shares = Shares(self.gram)

    def __call__(self, vectors: dict[int, np.ndarray]) -> np.ndarray:
        """Return the (stations, 6) motions of a shape."""
        out = np.zeros(6 * self.count)
        for b, vector in vectors.items():
            if b < len(self.parts):
                loaded, columns, inverse = self.parts[b]
                out[columns] += inverse @ (loaded.T @ vector)
        return out.reshape(self.count, 6)


class Shares:
    """Modal mass that section motions (s, 6) describe, by their mass matrix (6 s, 6 s)."""

    def __init__(self, gram: np.ndarray):
        self._gram = gram
        # rows and mass matrix of the motions of some components
        self._parts: dict[tuple[int, ...], tuple[np.ndarray, np.ndarray]] = {}

    def by_family(self, motion: np.ndarray) -> dict[str, float]:
        """Return the part of each family, by the names of ``FAMILIES``."""
        return {name: self.of(motion, components) for name, components in FAMILIES.items()}

    def of(self, motion: np.ndarray, components: Sequence[int]) -> float:
        """Return the part of some components."""
        chosen = tuple(components)
        if chosen not in self._parts:
            rows = component_rows(range(len(motion)), chosen)
            self._parts[chosen] = rows, self._gram[np.ix_(rows, rows)]
        rows, gram = self._parts[chosen]
        part = motion.ravel()[rows]
        return float(part @ gram @ part)


def _section_loads(block: Block, stations: np.ndarray, loads_of_blocks: list[_Loads]) -> _Loads:
    """Return loads, Gram matrix and columns of a block; of a twin those of the original block,
    turned.
    """
    if not block.components:
        return np.zeros((block.size, 0)), np.zeros((0, 0)), np.zeros(0, int)
    if block.mirror is None:
        return block.section_loads(stations)
    original, signs = block.mirror
    loaded, gram = signed(lambda _: loads_of_blocks[original][:2], signs)(stations)
    return loaded, gram, component_rows(range(len(stations)), block.components)


def _wave_family(n: int) -> str:
    """Return the family of shapes of one wave around the axis, or more."""
    return "bending" if n == 1 else f"ovalising n={n}"


class Names:
    """Families, twins and numbers of the shapes of one body on bearings, whose blocks they refer
    to.
    """

    def __init__(self, body: Body, supports: Supports, project: Projection):
        self.body, self.project = body.without_results(), project
        self._with_masses = supports.inertia is not None
        self.promised = quarter_turn_change(supports)
        # a part that is not round promises no twins, however near its frequencies lie
        self._split = not body.mesh.get("round", True)
        self._planes = self._split and len(body.blocks) > 1
        self.without_axis = not body.mesh.get("axis", True)
        self._mirrored = any(block.mirror is not None for block in body.blocks)
        self._round = circumference_of(body)
        self._moving_axially: dict[int, np.ndarray] = {}
        # momenta of shapes, which are kept alive beside them
        self._momenta: dict[Same, tuple[dict, dict[int, np.ndarray]]] = {}
        # fits of shapes around the axis, and what is known of them, in the same way
        self._fitted: dict[Same, tuple[dict, np.ndarray, np.ndarray]] = {}
        self._described: dict[Same, tuple[dict, Shape]] = {}

    def describe(self, shapes: Sequence[dict[int, np.ndarray]]) -> list[Shape]:
        """Return family, waves around, section motions and profile of some shapes, by block index,
        each described once.
        """
        if self._round is not None:
            self._fit(*self._round, shapes)
        for vectors in shapes:
            if same(vectors) not in self._described:
                self._described[same(vectors)] = vectors, self._shape(vectors)
        return [self._described[same(vectors)][1] for vectors in shapes]

    def _shape(self, vectors: dict[int, np.ndarray]) -> Shape:
        motion = self.project(vectors)
        described = self.project.shares.by_family(motion)
        profile: np.ndarray | dict[int, np.ndarray] = vectors
        if self._round is not None:
            energy, profile = self._around(self._round[0], vectors)
        elif any(has_several_families(self.body.block(b)) for b in vectors):
            energy = {
                (1 if name == "bending" else 0, name): share for name, share in described.items()
            }
        else:
            energy = self._by_block(vectors)
        waves, family = max(energy, key=energy.__getitem__)
        if self.without_axis:
            family = "mode"
        if self._round is not None:
            profile = profile[waves]
        captured = sum(described.values())
        if self._with_masses:
            # shares are of the mass of the shaft, of which unit shapes have less than one
            moved = (v @ (self.body.block(b).mass @ v) for b, v in vectors.items())
            captured /= float(sum(moved))
        is_double = self._round is None and all(repeats(self.body.block(b)) for b in vectors)
        return Shape(
            family, waves, motion, captured, profile, is_double, self._plane(motion, family)
        )

    def _plane(self, motion: np.ndarray, family: str) -> str:
        """Return the plane of bending of a part with a mirror plane, unless bearings couple both."""
        if not self._planes or family != "bending":
            return ""
        planes = [self.project.shares.of(motion, components) for components in ((2, 3), (0, 5))]
        share = planes[0] / sum(planes)
        return "z" if share > 0.99 else "x" if share < 0.01 else ""

    def _fit(
        self,
        fit: Circumference,
        displacements: Displacements,
        shapes: Sequence[dict[int, np.ndarray]],
    ) -> None:
        """Fit shapes by waves around the axis, some at a time."""
        new = [vectors for vectors in shapes if same(vectors) not in self._fitted]
        for first in range(0, len(new), TOGETHER):
            some = new[first : first + TOGETHER]
            fits = zip(*fit(np.array([displacements(vectors) for vectors in some])))
            for vectors, (profile, share) in zip(some, fits):
                self._fitted[same(vectors)] = vectors, profile, share

    def _around(
        self, fit: Circumference, vectors: dict[int, np.ndarray]
    ) -> tuple[dict[tuple[int, str], float], np.ndarray]:
        """Return the shares of a shape by waves and family, and its profile by waves."""
        _, profile, share = self._fitted[same(vectors)]
        radial, tangential, axial = share[0]
        energy = {
            (0, "torsion"): tangential,
            (0, self._along_or_across(vectors)): axial + radial,
        }
        energy |= {(n, _wave_family(n)): share[n].sum() for n in range(1, fit.waves + 1)}
        return energy, profile

    def _along_or_across(self, vectors: dict[int, np.ndarray]) -> str:
        """Return the family of a shape of n = 0, weighed by all of the mass: bins lose motions that
        turn within them.
        """
        breathes = all(self._radial_share(b, v) > 0.5 for b, v in vectors.items())
        return "breathing" if breathes else "axial"

    def unmixed(
        self, shapes: list[Shape], vectors: list[dict[int, np.ndarray]], value: np.ndarray
    ) -> list[Shape]:
        """Name shapes by the families that they hold together with their neighbours (values
        ascending): a mesh that is not quite round mixes those that lie nearer than it splits twins,
        and any mixture of them is as good a solution.
        """
        if self._round is None or self.without_axis:
            return shapes
        out, tolerance = list(shapes), 2 * self.body.mesh.get("pair_tolerance", 0.0)
        for blocks in dict.fromkeys(frozenset(v) for v in vectors):
            of_blocks = np.array([i for i, v in enumerate(vectors) if v.keys() == blocks])
            cuts = np.flatnonzero(np.diff(value[of_blocks]) > tolerance * value[of_blocks][1:]) + 1
            for neighbours in np.split(of_blocks, cuts):
                if len(neighbours) > 1:
                    renamed = self._by_family(
                        [shapes[i] for i in neighbours], [vectors[i] for i in neighbours]
                    )
                    for i, shape in zip(neighbours, renamed):
                        out[i] = shape
        return out

    def _by_family(self, shapes: list[Shape], vectors: list[dict[int, np.ndarray]]) -> list[Shape]:
        """Name each of some neighbours by a family that their space holds, as often as it holds it."""
        assert self._round is not None
        fitted = [self._fitted[same(v)][1:] for v in vectors]
        around = np.array([profile for profile, _ in fitted])
        level = around[:, 0].reshape(len(shapes), -1, 3)
        rows = {(0, "torsion"): level[:, :, 1], (0, ""): level[:, :, ::2].reshape(len(shapes), -1)}
        rows |= {(n, _wave_family(n)): around[:, n] for n in range(1, around.shape[1])}
        out = list(shapes)
        for i, (waves, family), weight in shared_families(
            rows, [share.sum() for _, share in fitted]
        ):
            if not family:
                family = self._along_or_across(
                    {b: sum(w * v[b] for w, v in zip(weight, vectors)) for b in vectors[i]}
                )
            out[i] = replace(
                shapes[i],
                family=family,
                waves=waves,
                profile=around[i, waves],
                plane=self._plane(shapes[i].motion, family),
            )
        return out

    def _by_block(self, vectors) -> dict[tuple[int, str], float]:
        energy: dict[tuple[int, str], float] = {}
        for b, v in vectors.items():
            block = self.body.block(b)
            family = family_of(block)
            if family == "axial" and self._radial_share(b, v) > 0.5:
                family = "breathing"
            key = (waves_of(block), family)
            energy[key] = energy.get(key, 0.0) + float(v @ (block.mass @ v))
        return energy

    def _radial_share(self, b, v) -> float:
        """Return the share of the modal mass of a shape of n = 0 that moves across the axis: the
        mass couples no two directions, so the parts add up.
        """
        block = self.body.block(b)
        axial_unknowns = self._moving_axially
        if b not in axial_unknowns:
            along = np.zeros(block.size, bool)
            if 1 in block.components:
                along = block.rigid[:, block.components.index(1)] != 0
            if self._round is None:  # unknowns inside elements that no rigid motion moves
                count, label = connected_components(block.mass, directed=False)
                along = np.isin(label, np.unique(label[along]))
            axial_unknowns[b] = along
        radial = np.where(axial_unknowns[b], 0.0, v)
        return float(radial @ (block.mass @ radial)) / float(v @ (block.mass @ v))

    def overlap(self, a: Shape, b: Shape) -> float:
        """Return the MAC of one shape, turned by a quarter of a wave, with another: 1 for twins, 0
        for modes of other profiles.
        """
        if (
            a.family != b.family
            or a.waves < 1
            or (self._round is None and len(self.body.blocks) == 1)
        ):
            return 0.0
        profile_a, profile_b = a.profile, b.profile
        if isinstance(profile_a, np.ndarray) and isinstance(profile_b, np.ndarray):
            size = np.vdot(profile_a, profile_a).real * np.vdot(profile_b, profile_b).real
            return float(np.vdot(1j * profile_a, profile_b).real ** 2 / size)
        if not self._mirrored:
            return self._sections_alike(a.motion, b.motion)
        return self._turned(profile_a, profile_b) ** 2 / (
            self._turned(profile_a, None) * self._turned(profile_b, None)
        )

    def _sections_alike(self, a: np.ndarray, b: np.ndarray) -> float:
        """Return the same MAC by section motions, for a block that holds both planes."""
        gram, turned = self.project.gram, (a @ _QUARTER.T).ravel()
        size = (a.ravel() @ gram @ a.ravel()) * (b.ravel() @ gram @ b.ravel())
        return float((turned @ gram @ b.ravel()) ** 2 / size) if size > 0 else 0.0

    def _turned(self, a, b) -> float:
        """Return the mass product of a shape in blocks that mirror each other, turned into the
        other plane, with another; with itself, not turned, for None.
        """
        out, heavy = 0.0, self._momentum(a if b is None else b)
        for index, block in enumerate(self.body.blocks):
            if block.mirror is None:
                continue
            planes = (block.mirror[0], index)
            for p, q, sign in ((planes[0], planes[1], 1.0), (planes[1], planes[0], -1.0)):
                if b is None:
                    if p in a:
                        out += float(a[p] @ heavy[p])
                elif p in a and q in b:
                    out += sign * float(a[p] @ heavy[q])
        return out

    def _momentum(self, shape: dict[int, np.ndarray]) -> dict[int, np.ndarray]:
        """Return ``M u`` by block, once a shape: every shape is compared with all others."""
        if same(shape) not in self._momenta:
            heavy = {b: self.body.block(b).mass @ v for b, v in shape.items()}
            self._momenta[same(shape)] = shape, heavy
        return self._momenta[same(shape)][1]

    def pairs(self, shapes: list[Shape], value: np.ndarray) -> list[tuple[int, ...]]:
        """Group shapes that belong together, by their eigenvalues (k,), ascending: pairs and single
        modes in ascending order of the first member.
        """
        partner: dict[int, int] = {}
        for i, shape in enumerate(shapes):
            if shape.double or i in partner or not self._promises_twins(shape):
                continue
            candidates = [
                j
                for j in range(i + 1, len(shapes))
                if j not in partner
                and shapes[j].waves == shape.waves
                and shapes[j].family == shape.family
            ]
            overlaps = {j: self.overlap(shape, shapes[j]) for j in candidates}
            twin = max(overlaps, key=overlaps.__getitem__, default=None)
            if twin is None or overlaps[twin] < 0.5:
                # Shapes of a cluster mix: then the nearest is as good as any.
                is_near = candidates and value[candidates[0]] - value[i] <= self.usual(shape) * abs(
                    value[i]
                )
                twin = candidates[0] if is_near else None
            if twin is not None:
                partner[i] = partner[twin] = twin
        groups: list[tuple[int, ...]] = [
            (i, partner[i]) if i in partner else (i,)
            for i in range(len(shapes))
            if partner.get(i) != i
        ]
        self._momenta.clear()  # as large as the shapes
        return groups

    def _promises_twins(self, shape: Shape) -> bool:
        """Return whether symmetry gives a shape a twin: around N equal sectors none of N/2 waves
        has one.
        """
        if self._split or shape.waves < 1:
            return False
        if shape.waves == 1:
            return self.promised <= ALIKE
        sectors = self.body.mesh.get("sectors")
        return not sectors or 2 * shape.waves % sectors != 0

    def usual(self, shape: Shape) -> float:
        """Return the relative distance of eigenvalues that meshes like this one leave between the
        twins of a shape.
        """
        tolerance = self.body.mesh.get("pair_tolerance", 1e-7)
        return (
            2 * max(tolerance, self.promised)
            if shape.waves == 1
            else max(2 * tolerance, OVAL_TOLERANCE)
        )


def quarter_turn_change(supports: Supports) -> float:
    """Bound the relative change of any eigenvalue by a quarter turn of the bearings, and of the
    masses on ports, which twins need; infinite where the change is not small.

    If ``|v' D v| <= eps v' K v`` for the change D of the stiffness K, then no eigenvalue of the
    supported body moves by more than eps (Rayleigh), and likewise for a change of the mass.

    Examples
    --------
    >>> round(quarter_turn_change(Supports(("A",), np.diag([1e8, 0.0, 1e8, 0.0, 0.0, 0.0]))), 12)
    0.0
    >>> round(quarter_turn_change(Supports(("A",), np.diag([1e8, 0.0, 2e8, 0.0, 0.0, 0.0]))), 12)
    1.0
    """
    if not supports.ports:
        return 0.0
    change = _largest_change(supports.stiffness)
    return change if supports.inertia is None else change + _largest_change(supports.inertia)


def _largest_change(k: np.ndarray) -> float:
    """Return the largest change of ``v' k v`` by a quarter turn, relative; infinite where it is not small."""
    turn = np.kron(np.eye(len(k) // 6), rotation(1, np.pi / 2))
    change = turn @ k @ turn.T - k
    size = np.sqrt(np.abs(np.diag(k)))
    resisted = size > 0
    scale = np.outer(size[resisted], size[resisted])
    if np.abs(change[~resisted]).max(initial=0.0) > 1e-12 * np.abs(k).max(initial=0.0):
        return np.inf
    w, v = np.linalg.eigh(k[np.ix_(resisted, resisted)] / scale)
    relative = change[np.ix_(resisted, resisted)] / scale
    regular = w > 1e-9
    if np.abs(v[:, ~regular].T @ relative).max(initial=0.0) > 1e-12:
        return np.inf
    half = v[:, regular] / np.sqrt(w[regular])
    return float(np.abs(np.linalg.eigvalsh(half.T @ relative @ half)).max(initial=0.0))
