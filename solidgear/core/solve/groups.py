"""Groups of blocks that a supported body falls into, each solved as far as the modes asked for
reach, and counted.

Symmetry and bearings decide which blocks belong together. A body that can build further
circumferential families (a harmonic solid) is asked for those that may begin below the highest mode
wanted: by a closed form that no family undercuts and that grows with n, then by a light mesh.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from solidgear.core.body import FURTHER, Block, Body, Supports, component_rows
from solidgear.core.body.cache import LastTwo
from solidgear.core.errors import SolidgearError
from solidgear.core.safety import BESIDE
from solidgear.core.solve.coupling import groups
from solidgear.core.solve.eigen import Raw, Solved, count_below, lowest
from solidgear.core.solve.families import FAMILIES, family_of, repeats, waves_of
from solidgear.core.solve.supported import EPS, Supported

# validation/stability/circumferential_families.py: no family of its random shafts began below the
# closed form over 1.5, nor below a light mesh's over 1.5.
MARGIN = 1.5
LIGHT = 1.5
MOST_WAVES = 100
#: eigenvalues above this many times a limit are clear of it
CLEAR = 1.01
#: shapes that a group searches on by, at least, for room above a list, and that are searched at most
FARTHER, MOST_SHAPES = 4, 160
# Rounding in a factor moves eigenvalues by about eps times the highest one; nearer to the bound
# than a hundred times that, signs may turn.
DOUBT = 0.01


@dataclass
class Part:
    """Blocks that belong together, with their eigenpairs."""

    supported: Supported
    ask: int  #: number of modes to search for
    solved: Solved = field(default=None)  # type: ignore[assignment]  # set by the first search
    twins: list[int] = field(default_factory=list)  #: lone blocks that repeat it in the other plane
    #: added to block indices: that of a further circumferential family stands apart from those of
    #: the body's own
    first: int = 0
    verdict: dict | None = None  #: result of the count, see :func:`complete`

    @property
    def blocks(self) -> list[Block]:
        """Blocks of the group."""
        return self.supported.blocks

    @property
    def copies(self) -> int:
        """Number of shapes of every eigenpair."""
        return 2 if repeats(self.blocks[0]) else 1 + len(self.twins)

    def with_twins(self, pairs: list[Raw]) -> list[Raw]:
        """Return eigenpairs of the group, and of all twins of it."""
        out = []
        for r in pairs:
            vectors = {self.first + b: v for b, v in r.vectors.items()}
            out.append(Raw(r.value, vectors, r.residual, r.error))
        for twin in self.twins:
            for r in pairs:
                vectors = {twin: next(iter(r.vectors.values()))}
                out.append(Raw(r.value, vectors, r.residual, r.error))
        return out

    def reaches(self, limit: float) -> bool:
        """Return whether an eigenvalue was found above a limit, rad^2/s^2."""
        elastic = self.solved.elastic
        return bool(elastic) and elastic[-1].value > CLEAR * limit

    def has_room(self, limit: float, room: float) -> bool:
        """Return whether the first eigenvalue above a limit, rad^2/s^2, has another one so far above
        it, relative, or no more are worth a search: too many, or too close (:func:`is_dense`).
        """
        values = [r.value for r in self.solved.elastic]
        place = sum(value <= CLEAR * limit for value in values)
        if not room or self.ask >= self._most:
            return True
        if place == len(values):
            return False
        return 1 - values[place] / values[-1] >= room or is_dense(values, place, room)

    def ask_on(self) -> None:
        """Ask for as many modes again, of those that are worth a search."""
        self.ask = min(self.ask + max(FARTHER, self.ask), self._most)

    @property
    def _most(self) -> int:
        return min(MOST_SHAPES, self.supported.size // 2)

    def values(self) -> list[float]:
        """Return elastic eigenvalues with every shape counted, rad^2/s^2."""
        return [r.value for r in self.solved.elastic for _ in range(self.copies)]


def is_dense(values: Sequence[float], place: int, room: float) -> bool:
    """Return whether the eigenvalues above one of a list, which ascends with every shape counted, lie
    so close that none among the lowest `MOST_SHAPES` will leave it `room`, relative to the higher one.

    A thin layer that is held on both sides has hundreds of modes within some per cent. A run of a
    width below `BESIDE` may be of a few equal parts of a body, and end at any place; and of modes in
    three dimensions a mode has less than twice as many (1.5^(3/2)) below it at a room of a third.

    Examples
    --------
    >>> layer = [1 + 0.002 * k for k in range(40)]
    >>> is_dense(layer, 3, 1 / 3), is_dense([*layer, 3.0], 3, 1 / 3), is_dense(layer[:9], 3, 1 / 3)
    (True, False, False)
    """
    start, end = values[place], values[-1]
    if not BESIDE <= 1 - start / end < room:
        return False
    expected = place + (len(values) - place) * (start / (1 - room) - start) / (end - start)
    return expected > max(MOST_SHAPES, 2 * place)


@dataclass(frozen=True)
class Uncounted:
    """A family that was neither solved nor counted."""

    n: int  #: waves around the axis
    begins_hz: float  #: the family begins above this frequency
    and_above: bool = False  #: whether it stands for all families of more waves too


def solved_parts(
    body: Body,
    supports: Supports,
    spring: np.ndarray,
    n: int,
    method: str | None,
    room: float = 0.0,
) -> list[Part]:
    """Solve all groups of a body's own blocks, each only as far as the lowest `n` shapes of all
    reach, and from the first eigenvalue above these on until another leaves it `room`, relative;
    `spring` (6 m, 6 m) is that of :func:`~solidgear.core.solve.coupling.decoupled`. SolidgearError as
    :func:`~solidgear.core.solve.eigen.lowest`.
    """
    parts = body.cache.get(_OwnParts, _OwnParts).on(
        (*supports.key, spring.tobytes(), method),
        lambda: _unsolved_parts(body, supports, spring, n),
    )
    waiting = [part for part in parts if part.solved is None]
    while True:
        for part in waiting:
            part.solved = lowest(part.supported, part.ask, method)
        values = sorted(v for part in parts for v in part.values())
        reach = values[n - 1] if len(values) >= n else np.inf
        waiting = []
        for part in parts:
            if part.ask < n and part.solved.elastic and not part.reaches(reach):
                part.ask = min(2 * part.ask, n)
            elif not part.has_room(reach, room):
                part.ask_on()
            else:
                continue
            waiting.append(part)
        if not waiting:
            return [replace(part) for part in parts]


def _unsolved_parts(body: Body, supports: Supports, spring: np.ndarray, n: int) -> list[Part]:
    """Return the groups of a body's own blocks, with the number of modes to search each for."""
    parts: list[Part] = []
    for group in groups(body, supports, spring):
        original = next(
            (p for p in parts if _is_twin(body, supports, spring, group, p.supported.group)), None
        )
        if original is not None:
            original.twins.append(group[0])
        else:
            parts.append(Part(Supported(body, supports, spring, group), n))
    if len(parts) > 1:
        # Bending pairs make most of a spectrum, and half of a part holds one of each; a group
        # searched too little is searched again.
        for part in parts:
            half = sum(len(block.components) for block in part.blocks) >= 3
            share = 2 if half else 4
            if part.copies > 1:
                share = 3
            part.ask = n // share + 1
    return parts


class _OwnParts(LastTwo[list[Part]]):
    """Groups of the own blocks of a body on some springs: who asks for more modes, or for their
    count, goes on from there.
    """


def reach_of(parts: list[Part], n: int, highest: float = np.inf) -> float:
    """Return the highest eigenvalue that is used, rad^2/s^2: that of the last of ``n`` shapes of
    solved parts, or the highest allowed.
    """
    values = sorted(v for part in parts for v in part.values())
    return min(values[min(n, len(values)) - 1], highest) if values else 0.0


def further_parts(
    body: Body,
    parts: list[Part],
    n: int,
    highest: float,
    method: str | None,
    room: float = 0.0,
) -> tuple[list[Part], list[Uncounted]]:
    """Solve circumferential families of two waves and more that begin among the ``n`` lowest
    shapes, below the largest eigenvalue wanted, rad^2/s^2, with `room` as
    :func:`solved_parts`; return also those that begin above, in ascending order of waves. `parts` are
    the body's own, solved.
    """
    have = {waves_of(b) for p in parts for b in p.blocks}
    limit = reach_of(parts, n, highest)
    light: dict[int, float] = {}
    waves = 2
    while waves < MOST_WAVES and body.further.bound(waves) <= MARGIN * _hz(limit):
        if waves not in have:
            light[waves] = body.further.light(waves)
        waves += 1
    uncounted = [Uncounted(waves, body.further.bound(waves) / MARGIN, True)]
    further: list[Part] = []
    for waves in sorted(light, key=light.__getitem__):
        limit = reach_of(parts + further, n, highest)
        if light[waves] > 1.01 * LIGHT * _hz(limit):
            uncounted.append(Uncounted(waves, light[waves] / LIGHT))
            continue
        family_body = body.family(waves)
        part = Part(
            Supported(family_body, Supports((), np.zeros((0, 0))), np.zeros((0, 0)), [0]),
            max(2, n // 8),
            first=FURTHER + waves,
        )
        solved_families = family_body.cache.get(_Solved, _Solved)
        while True:
            # no spring reaches them: one solution serves all springs
            key = part.ask, method
            if key not in solved_families:
                solved_families[key] = lowest(part.supported, part.ask, method)
            part.solved = solved_families[key]
            # Two shapes for every value: half of n is all that the list has room for.
            if not part.reaches(limit) and part.ask <= n // 2 + 1:
                part.ask = min(2 * part.ask, n // 2 + 2)
            elif not part.has_room(limit, room):
                part.ask_on()
            else:
                break
        further.append(part)
    return further, sorted(uncounted, key=lambda u: u.n)


class _Solved(dict[tuple[int, str | None], Solved]):
    """Eigenpairs of a family by the number asked for, and by method."""


def _hz(value: float) -> float:
    return float(np.sqrt(max(value, 0.0)) / (2 * np.pi))


def complete(part: Part, reach: float, method: str | None) -> dict:
    """Count the modes of a solved part up to the highest eigenvalue that is used, rad^2/s^2, and
    search again with more vectors where one was missed.

    The verdict, which the part keeps, is ``checked``, with ``below_hz``, ``modes`` and ``backend``,
    or with ``why`` not. SolidgearError if modes are still missing.
    """
    supported, n = part.supported, part.ask
    count = count_below(supported, part.solved, reach)
    if count is not None and count.existing != count.computed:
        missed = count.existing - count.computed
        part.solved = lowest(
            supported,
            n + 4 + 2 * abs(missed),
            "arpack" if part.solved.method == "lanczos" else "lanczos",
        )
        count = count_below(supported, part.solved, reach)
    if count is not None and count.existing != count.computed:
        stiffest = supported.highest / count.below
        if EPS * stiffest > DOUBT * count.distance:
            part.verdict = {
                "checked": False,
                "why": (
                    f"the stiffest cell lies {stiffest:.0e} times above the modes, so that "
                    "rounding changes signs of the factor"
                ),
            }
            return part.verdict
        raise SolidgearError(
            f"modes: {count.computed} modes were found below {_hz(count.below):.6g} Hz "
            f"but the factor counts {count.existing}; ask for more modes (n = {n})"
        )
    if count is None:
        part.verdict = {"checked": False, "why": f"no inertia from {supported.backend}"}
    else:
        part.verdict = {
            "checked": True,
            "below_hz": _hz(count.below),
            "modes": count.existing,
            "backend": count.backend,
        }
    return part.verdict


def families(parts: list[Part]) -> list[tuple[str, int | None, bool]]:
    """Return family, waves around the axis (None for all), and whether it was counted, of every
    solved block; the lowest number of waves last among single families.
    """
    rows: dict[str, tuple[int | None, bool]] = {}
    for part in parts:
        for block in part.blocks:
            name = family_of(block)
            is_counted = (
                bool(part.verdict and part.verdict["checked"]) and rows.get(name, (0, True))[1]
            )
            rows[name] = (None if name == "all" else waves_of(block), is_counted)
    return [(name, *row) for name, row in rows.items()]


def family_rows(
    parts: list[Part], uncounted: list[Uncounted], modes: list[tuple[str, float, int]]
) -> list[dict]:
    """List families that were solved and counted, and those that were left alone, as in the
    evidence of :class:`~solidgear.core.solve.modes.ModeSet`; of every mode found `modes` has family,
    frequency (Hz) and number of shapes.
    """
    checked = [p.verdict for p in parts if p.verdict and p.verdict["checked"]]
    below = min((verdict["below_hz"] for verdict in checked), default=np.inf)
    rows = []
    for family, waves, is_counted in families(parts):
        family_modes = [
            (hz, shapes)
            for name, hz, shapes in modes
            if waves is None
            or name in family.split(" and ")
            or (family, name) == ("axial", "breathing")
        ]
        lowest = min((hz for hz, _ in family_modes), default=None)
        rows.append(
            {
                "family": family,
                "n": waves,
                "counted": is_counted,
                "modes_below": sum(shapes for hz, shapes in family_modes if hz < below),
                "lowest_hz": lowest,
            }
        )
    rows.sort(key=lambda row: (row["n"] or 0, row["family"]))
    for u in uncounted:
        rows.append(
            {
                "family": f"ovalising n={u.n}",
                "n": u.n,
                "counted": False,
                "modes_below": 0,
                "lowest_hz": u.begins_hz,
                "above": u.and_above,
            }
        )
    return rows


def _is_twin(body, supports, spring, group: list[int], neighbour: list[int]) -> bool:
    """Return whether a lone block mirrors another one, springs and masses included."""
    block = body.blocks[group[0]]
    if len(group) != 1 or block.mirror is None or neighbour != [block.mirror[0]]:
        return False
    index, signs = block.mirror
    m = len(supports.ports)
    rows, mirror_rows = (
        component_rows(range(m), b.components) for b in (block, body.blocks[index])
    )
    sign = np.tile(signs, m)
    signs = np.outer(sign, sign)
    for matrix in (spring, supports.masses):
        a, b = matrix[np.ix_(rows, rows)], matrix[np.ix_(mirror_rows, mirror_rows)] * signs
        if np.abs(a - b).max(initial=0.0) > 1e-14 * np.abs(b).max(initial=0.0):
            return False
    return True


def completeness_limits(parts: list[Part]) -> dict[int, float]:
    """Return the eigenvalues up to which the families of every block are complete, by block index,
    rad^2/s^2; parts that share a family of motion are complete up to the lower of both.
    """
    ends: dict[str, float] = {}
    for part in parts:
        last = part.solved.elastic[-1].value if part.solved.elastic else 0.0
        for family in _motions(part):
            ends[family] = min(last, ends.get(family, np.inf))
    return {
        index: min(ends[family] for family in _motions(part))
        for part in parts
        for index in (*(part.first + b for b in part.supported.group), *part.twins)
    }


def _motions(part: Part) -> set[str]:
    """Return families of motion that a part may show; of an ovalising block the name of it."""
    moved = {c for block in part.blocks for c in block.components}
    families = {name for name, components in FAMILIES.items() if moved & set(components)}
    return families or {block.name for block in part.blocks}
