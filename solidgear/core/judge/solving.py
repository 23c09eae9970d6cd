"""Solution of one model of one scene: build, condense, find modes, measure."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from solidgear.core.body import Body, Supports, as_supports
from solidgear.core.bounds.harmonic import is_bounded, of_one_problem
from solidgear.core.judge.quantities import measure
from solidgear.core.ladder import build
from solidgear.core.quantity import ACROSS, QUANTITIES, STIFFNESS, Quantity
from solidgear.core.solve.condensed import Condensed, Coupled
from solidgear.core.solve.groups import MOST_SHAPES
from solidgear.core.solve.modes import ModeSet, modes
from solidgear.core.solve.statics import condense

if TYPE_CHECKING:
    from solidgear.core.body.supports import Holding
    from solidgear.core.scene import Scene

#: modes that hold the first bending pair and the first axial mode of anything that looks like a
#: shaft
ENOUGH = 10


@dataclass(frozen=True)
class Numbers:
    """Numbers of a solution, without the body behind it."""

    #: the compared numbers; see :mod:`solidgear.core.judge.quantities`
    quantities: dict[Quantity, float]
    #: relative error that the solver may have left in every one of them
    solver: dict[Quantity, float]


@dataclass(frozen=True)
class Statics:
    """Compliances and stiffnesses of a body on bearings."""

    main: Condensed  #: at the main lumped point
    further: Mapping[str, Condensed] = field(default_factory=dict)  #: at further ones, by name
    coupled: Coupled | None = None  #: of several points together

    @classmethod
    def at_points(
        cls,
        body: Body,
        supports: Holding,
        points: Sequence[str],
        attachments: Sequence[str | None] | str | None = None,
    ) -> Statics:
        """Condense a body to some points, the main one first, and to all of them together."""
        if attachments is None or isinstance(attachments, str):
            attachments = [attachments] * len(points)
        kinds = tuple(attachments)
        main, *further = (
            condense(body, supports, point, kind) for point, kind in zip(points, kinds)
        )
        coupled = condense(body, supports, tuple(points), kinds) if further else None
        return cls(main, dict(zip(points[1:], further)), coupled)

    @classmethod
    def for_quantities(
        cls, scene: Scene, body: Body, supports: Supports, names: Sequence[Quantity]
    ) -> Statics:
        """Condense a body to the points that some quantities need: the main one, further ones, and
        pairs of points.
        """
        main = condense(body, supports, scene.port.name)
        points = dict.fromkeys(q.points[0] for q in names if len(q.points) == 1)
        further = {point: condense(body, supports, point) for point in points}
        pairs = {point for q in names for point in q.pair or ()}
        ports = tuple(port.name for port in scene.ports if port.name in pairs)
        return cls(main, further, condense(body, supports, ports) if pairs else None)

    def repeated(self, body: Body, supports: Supports) -> Statics:
        """Condense another body to the same points."""
        coupled = self.coupled and condense(
            body, supports, self.coupled.ports, self.coupled.attachments
        )
        return Statics(
            condense(body, supports, self.main.port, self.main.attachment),
            {
                name: condense(body, supports, name, condensed.attachment)
                for name, condensed in self.further.items()
            },
            coupled,
        )

    def values(self, modes: ModeSet | None = None) -> dict[Quantity, float]:
        """Return all static numbers, those of the other plane and between points included, and
        those of modes.
        """
        values = measure(self.main, modes, self.further, self.coupled)
        return values | measure(None, None, self.further, self.coupled, ACROSS)


def numbers(
    statics: Statics | None, modes: ModeSet | None, wanted: Iterable[Quantity] = ()
) -> Numbers:
    """Return all numbers of statics and modes, either of which may not have been solved, with `wanted`
    frequencies that are no usual ones.
    """
    values = measure(None, modes) if statics is None else statics.values(modes)
    for name in wanted:
        mode = modes.named(name) if modes is not None else None
        if mode is not None:
            values.setdefault(name, mode.frequency_hz)
    return Numbers(values, _solver_errors(statics, modes, values))


def _solver_errors(
    statics: Statics | None, modes: ModeSet | None, values: Iterable[Quantity]
) -> dict[Quantity, float]:
    """Return the relative error that the solver may have left in every quantity."""
    solver = {}
    for name in dict.fromkeys((*QUANTITIES, *values)):
        if name.is_frequency:
            mode = modes.named(name) if modes is not None else None
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
    """A body on bearings, tied in one way, with statics and modes."""

    body: Body
    statics: Statics  #: at all lumped points, and between them where there are several
    modes: ModeSet
    #: the compared numbers; see :mod:`solidgear.core.judge.quantities`
    quantities: dict[Quantity, float]
    supports: Supports | None = None  #: that hold it

    @classmethod
    def measured(cls, body: Body, supports: Supports, statics: Statics, modes: ModeSet) -> Answer:
        """Measure the numbers of some statics and modes."""
        values = measure(statics.main, modes, statics.further, statics.coupled)
        return cls(body, statics, modes, values, supports)

    @property
    def numbers(self) -> Numbers:
        """Numbers, and the solver's relative error in them; they outlive the body."""
        solver = _solver_errors(self.statics, self.modes, self.quantities)
        return Numbers(self.quantities, solver)


def search_modes(
    body: Body,
    supports: Supports,
    n: int,
    wanted: Iterable[str],
    *,
    spare: bool = False,
    **options: Any,
) -> ModeSet:
    """Find modes of a body on supports, wider and wider until the modes named in `wanted` are among
    them, and with `spare` one more of the same eigenproblem above each and beyond those near it; options of
    :func:`solidgear.core.solve.modes.modes`.

    The list has `n` elastic shapes, modes found above stand beyond the end of it, and those that
    are not among the lowest `MOST_SHAPES` shapes are missing.
    """
    wanted = list(wanted)
    listed = modes(body, supports, n, **options)
    count, wider = n, listed
    while count < MOST_SHAPES and not all(_contains(wider, name, spare) for name in wanted):
        count *= 2
        wider = modes(body, supports, count, ovalising=False)
    if wider is not listed:
        listed = extended_modes(listed, wider)
    found_modes = [m for name in wanted if (m := with_all_solved(listed).named(name)) is not None]
    names = [m.name for m in (*listed.modes, *listed.beyond)]
    more = tuple(m for m in found_modes if m.name not in names)
    above = tuple(m for m in listed.above if m not in more)
    return replace(listed, beyond=(*listed.beyond, *more), above=above)


def extended_modes(listed: ModeSet, wider: ModeSet) -> ModeSet:
    """Return a list of modes, extended by all further modes of a longer list of the same body."""
    names = {m.name for m in (*listed.modes, *listed.beyond)}
    further_modes = tuple(m for m in (*wider.modes, *wider.beyond) if m.name not in names)
    above = tuple(m for m in wider.above if m.name not in names)
    return replace(listed, beyond=(*listed.beyond, *further_modes), above=above)


def with_all_solved(listed: ModeSet) -> ModeSet:
    """Return a list of modes with every solved mode beyond the end of the list."""
    return replace(listed, beyond=(*listed.beyond, *listed.above), above=())


def _contains(listed: ModeSet, name: str, spare: bool) -> bool:
    """Return whether a mode was found, and with `spare` one above it of the same eigenproblem, and
    one beyond those near it.
    """
    solved = with_all_solved(listed)
    mode = solved.named(name)
    if mode is None or not spare:
        return mode is not None
    above = (m for m in (*solved.modes, *solved.beyond) if m.frequency_hz > mode.frequency_hz)
    return any(of_one_problem(m, mode) for m in above) and is_bounded(solved, mode)


def solve(
    scene: Scene,
    model: str,
    n: int = ENOUGH,
    *,
    max_frequency: float | None = None,
    **options: Any,
) -> Answer:
    """Build one model of a scene and solve it as the scene is tied: `n` elastic shapes, twins
    counted twice, up to a frequency in Hz. Errors are those of the builder, the statics and the
    modes.
    """
    ports = [scene.port.name, *(port.name for port in scene.further_ports)]
    body = build(scene, model, **options)
    return answer_of_body(body, as_supports(scene), ports, n, max_frequency=max_frequency)


def answer_of_body(
    body: Body,
    supports: Supports,
    ports: Sequence[str],
    n: int = ENOUGH,
    wanted: Iterable[str] = (),
    *,
    ovalising: bool = False,
    **options: Any,
) -> Answer:
    """Solve statics and modes of a body on some supports, at lumped points, the main one first;
    modes as for :func:`search_modes`.
    """
    statics = Statics.at_points(body, supports, ports)
    listed = search_modes(body, supports, n, wanted, ovalising=ovalising, **options)
    return Answer.measured(body, supports, statics, listed)


def quantities_at(
    points: Sequence[str], body: Body, supports: Supports, listed: ModeSet
) -> dict[Quantity, float]:
    """Measure modes, and statics at some points where there are any, the main one first."""
    if not points:
        return measure(None, listed)
    statics = Statics.at_points(body, supports, points)
    return Answer.measured(body, supports, statics, listed).quantities
