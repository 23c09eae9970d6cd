"""Answer of one model about one scene: build, condense, modes, measure."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from solidgear.body import Body, Supports, as_supports
from solidgear.judge.quantities import measure
from solidgear.ladder import build
from solidgear.quantity import ACROSS, QUANTITIES, STIFFNESS, Quantity
from solidgear.solve.condensed import Condensed, Coupled
from solidgear.solve.modes import ModeSet, modes
from solidgear.solve.statics import condense

if TYPE_CHECKING:
    from solidgear.body.supports import Holding
    from solidgear.scene import Scene

#: shapes that are searched at most for a mode that is asked for
MOST_SHAPES = 160
#: modes that hold the first bending pair and the first axial mode of anything that looks like a
#: shaft
ENOUGH = 10


@dataclass(frozen=True)
class Numbers:
    """Numbers of an answer, without the body behind it."""

    #: the compared numbers; see :mod:`solidgear.judge.quantities`
    quantities: dict[Quantity, float]
    #: relative error that the solver may have left in every one of them
    solver: dict[Quantity, float]


@dataclass(frozen=True)
class Statics:
    """Statics of a body on its bearings."""

    main: Condensed  #: at the main lumped point
    further: Mapping[str, Condensed] = field(default_factory=dict)  #: at further ones, by name
    coupled: Coupled | None = None  #: of several points together

    @classmethod
    def at(
        cls,
        body: Body,
        supports: Holding,
        points: Sequence[str],
        attachments: Sequence[str | None] | str | None = None,
    ) -> Statics:
        """Statics at some points, the main one first, and between all of them."""
        if attachments is None or isinstance(attachments, str):
            attachments = [attachments] * len(points)
        kinds = tuple(attachments)
        main, *others = (condense(body, supports, *one) for one in zip(points, kinds))
        coupled = condense(body, supports, tuple(points), kinds) if others else None
        return cls(main, dict(zip(points[1:], others)), coupled)

    @classmethod
    def of(cls, scene: Scene, body: Body, supports: Supports, names: Sequence[Quantity]) -> Statics:
        """Statics that some quantities need: the main point, further ones, and pairs of points."""
        main = condense(body, supports, scene.port.name)
        points = dict.fromkeys(q.points[0] for q in names if len(q.points) == 1)
        further = {point: condense(body, supports, point) for point in points}
        pairs = {point for q in names for point in q.pair or ()}
        both = tuple(port.name for port in scene.ports if port.name in pairs)
        return cls(main, further, condense(body, supports, both) if pairs else None)

    def again(self, body: Body, supports: Supports) -> Statics:
        """The same of another body."""
        coupled = self.coupled and condense(
            body, supports, self.coupled.ports, self.coupled.attachments
        )
        return Statics(
            condense(body, supports, self.main.port, self.main.attachment),
            {
                name: condense(body, supports, name, one.attachment)
                for name, one in self.further.items()
            },
            coupled,
        )

    def values(self, found: ModeSet | None = None) -> dict[Quantity, float]:
        """All numbers, those of the other plane and between points included, and those of modes."""
        both = self.further, self.coupled
        return measure(self.main, found, *both) | measure(None, None, *both, ACROSS)


def numbers(statics: Statics | None, found: ModeSet | None) -> Numbers:
    """All numbers of statics and modes, either of which may not have been solved."""
    values = measure(None, found) if statics is None else statics.values(found)
    return Numbers(values, _left(statics, found, values))


def _left(
    statics: Statics | None, found: ModeSet | None, values: Iterable[Quantity]
) -> dict[Quantity, float]:
    """Relative error that the solver may have left in every quantity."""
    solver = {}
    for name in dict.fromkeys((*QUANTITIES, *values)):
        if name.is_frequency:
            mode = found.named(name) if found is not None else None
            if mode is not None:
                solver[name] = mode.left
        elif statics is not None:
            inverted = statics.coupled if name.pair and name.kind == STIFFNESS else None
            solver[name] = statics.main.evidence["residual"]
            if inverted is not None:
                solver[name] = inverted.evidence["stiffness_error"]
    return solver


@dataclass
class Answer:
    """A body on its bearings, tied in one way."""

    body: Body
    statics: Statics  #: at all lumped points, and between them where there are several
    modes: ModeSet
    #: the compared numbers; see :mod:`solidgear.judge.quantities`
    quantities: dict[Quantity, float]
    supports: Supports | None = None  #: that hold it

    @classmethod
    def of(cls, body: Body, supports: Supports, statics: Statics, modes: ModeSet) -> Answer:
        """With the numbers of its statics and modes."""
        values = measure(statics.main, modes, statics.further, statics.coupled)
        return cls(body, statics, modes, values, supports)

    @property
    def numbers(self) -> Numbers:
        """Its numbers and what the solver may have left in them; they outlive the body."""
        left = _left(self.statics, self.modes, self.quantities)
        return Numbers(self.quantities, left)


def searched(
    body: Body,
    supports: Supports,
    n: int,
    wanted: Iterable[str],
    *,
    spare: bool = False,
    **options: Any,
) -> ModeSet:
    """Modes that hold all that are asked for, however high they lie.

    Parameters
    ----------
    n : int
        Elastic shapes of the list; what is found above stands beyond its end.
    wanted : iterable of str
        Names of modes.
    spare : bool
        Whether one more of the same motion is wanted above each.
    **options
        Of :func:`solidgear.solve.modes.modes`.

    Returns
    -------
    ModeSet
        Without those that are not among the lowest `MOST_SHAPES` shapes.
    """
    wanted = list(wanted)
    found = modes(body, supports, n, **options)
    count, wider = n, found
    while count < MOST_SHAPES and not all(_held(wider, name, spare) for name in wanted):
        count *= 2
        wider = modes(body, supports, count, ovalising=False)
    if wider is not found:
        found = widened(found, wider)
    asked = [m for name in wanted if (m := _widest(found).named(name)) is not None]
    names = [m.name for m in (*found.modes, *found.beyond)]
    more = tuple(m for m in asked if m.name not in names)
    above = tuple(m for m in found.above if m not in more)
    return replace(found, beyond=(*found.beyond, *more), above=above)


def widened(found: ModeSet, wider: ModeSet) -> ModeSet:
    """A list of modes with all that a longer one of the same body has beyond it."""
    known = {m.name for m in (*found.modes, *found.beyond)}
    beyond = tuple(m for m in (*wider.modes, *wider.beyond) if m.name not in known)
    above = tuple(m for m in wider.above if m.name not in known)
    return replace(found, beyond=(*found.beyond, *beyond), above=above)


def _widest(found: ModeSet) -> ModeSet:
    """With all that was solved."""
    return replace(found, beyond=(*found.beyond, *found.above), above=())


def _held(found: ModeSet, name: str, spare: bool) -> bool:
    """Tell whether a mode is there, and one above it of the same motion."""
    every = _widest(found)
    mode = every.named(name)
    if mode is None or not spare:
        return mode is not None
    above = (m for m in (*every.modes, *every.beyond) if m.frequency_hz > mode.frequency_hz)
    return any(m.family == mode.family for m in above)


def solve(
    scene: Scene,
    model: str,
    n: int = ENOUGH,
    *,
    max_frequency: float | None = None,
    **options: Any,
) -> Answer:
    """Build one model of a scene and solve it as the scene is tied: so many elastic shapes, twins counted
    twice, up to a frequency in Hz. Errors are those of the builder, the statics and the modes.
    """
    body = build(scene, model, **options)
    ports = [port.name for port in scene.ports]
    return answered(body, as_supports(scene), ports, n, max_frequency=max_frequency)


def answered(
    body: Body,
    supports: Supports,
    ports: Sequence[str],
    n: int = ENOUGH,
    wanted: Iterable[str] = (),
    *,
    ovalising: bool = False,
    **options: Any,
) -> Answer:
    """Answer of a body on some supports.

    Parameters
    ----------
    ports : sequence of str
        Names of the lumped points, the main one first.
    n, wanted, **options
        As for :func:`searched`.
    """
    statics = Statics.at(body, supports, ports)
    found = searched(body, supports, n, wanted, ovalising=ovalising, **options)
    return Answer.of(body, supports, statics, found)
