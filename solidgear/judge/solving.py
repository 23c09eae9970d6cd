"""Answer of one model about one scene: build, condense, modes, measure."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from solidgear.body import Body, Supports, as_supports
from solidgear.judge.quantities import measure
from solidgear.ladder import build
from solidgear.machine.meter import Meter
from solidgear.quantity import QUANTITIES, STIFFNESS, Quantity
from solidgear.solve.condensed import Condensed, Coupled
from solidgear.solve.modes import ModeSet, modes
from solidgear.solve.statics import condense

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: shapes that are searched at most for a mode that is asked for
MOST_SHAPES = 160
#: modes that hold the first bending pair and the first axial mode of anything that looks like a
#: shaft
ENOUGH = 10


@dataclass(frozen=True)
class Numbers:
    """Numbers of an answer, without the body behind it.

    Attributes
    ----------
    quantities : dict of Quantity to float
        The compared numbers; see :mod:`solidgear.judge.quantities`.
    solver : dict of Quantity to float
        Relative error that the solver may have left in every one of them.
    """

    quantities: dict[Quantity, float]
    solver: dict[Quantity, float]


def numbers(
    statics: Condensed | None,
    found: ModeSet | None,
    further: Mapping[str, Condensed] | None = None,
    coupled: Coupled | None = None,
) -> Numbers:
    """The compared numbers of statics and modes, any of which may not have been solved."""
    values = measure(statics, found, further, coupled)
    return Numbers(values, _left(statics, found, coupled, values))


def _left(
    statics: Condensed | None,
    found: ModeSet | None,
    coupled: Coupled | None,
    values: Iterable[Quantity],
) -> dict[Quantity, float]:
    """Relative error that the solver may have left in every quantity."""
    solver = {}
    for name in dict.fromkeys((*QUANTITIES, *values)):
        if name.is_frequency:
            mode = found.named(name) if found is not None else None
            if mode is not None:
                solver[name] = mode.error
        elif coupled is not None and name.pair and name.kind == STIFFNESS:
            solver[name] = coupled.evidence["stiffness_error"]
        elif statics is not None:
            solver[name] = statics.evidence["residual"]
    return solver


@dataclass
class Answer:
    """A body on its bearings, tied in one way.

    Attributes
    ----------
    condensed : Condensed
        Statics at the lumped point.
    quantities : dict of Quantity to float
        The compared numbers; see :mod:`solidgear.judge.quantities`.
    further : dict of str to Condensed
        Statics at further lumped points.
    coupled : Coupled or None
        All lumped points together, where there are several.
    supports : Supports or None
        That hold it.
    """

    body: Body
    condensed: Condensed
    modes: ModeSet
    quantities: dict[Quantity, float]
    further: dict[str, Condensed] = field(default_factory=dict)
    coupled: Coupled | None = None
    supports: Supports | None = None

    @property
    def numbers(self) -> Numbers:
        """Its numbers and what the solver may have left in them; they outlive the body."""
        left = _left(self.condensed, self.modes, self.coupled, self.quantities)
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
    count: bool = False,
    ovalising: bool = False,
    meter: Meter | None = None,
    **options: Any,
) -> Answer:
    """Build one model of a scene and solve it as the scene is tied.

    Parameters
    ----------
    model : str
        One that builds a body.
    n : int
        Elastic shapes, twins counted twice.
    max_frequency : float, optional
        Hz; modes above are left out.
    count : bool
        Whether modes are counted by the inertia of a second factor.
    ovalising : bool
        Whether families of two waves around and more are searched.
    meter : Meter, optional
        Given the seconds of every stage.
    **options
        Of the builder.

    Raises
    ------
    SolidgearError
        As the builder, the statics and the modes do.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = solve(sg.load("geometry/shaft_stepped.toml"), "timoshenko")
    >>> list(found.quantities)[:3]
    ['C_zz', 'C_z,thx', 'C_thx']
    """
    meter = meter or Meter()
    with meter.stage("build"):
        body = build(scene, model, **options)
    return answered(
        body,
        as_supports(scene),
        [port.name for port in scene.ports],
        n=n,
        max_frequency=max_frequency,
        count=count,
        ovalising=ovalising,
        meter=meter,
    )


def answered(
    body: Body,
    supports: Supports,
    ports: Sequence[str],
    attachments: Sequence[str | None] | str | None = None,
    *,
    n: int = ENOUGH,
    max_frequency: float | None = None,
    count: bool = False,
    ovalising: bool = False,
    wanted: Iterable[str] = (),
    spare: bool = False,
    meter: Meter,
) -> Answer:
    """Answer of a body on some supports; parameters as for :func:`solve`.

    Parameters
    ----------
    ports : sequence of str
        Names of the lumped points, the main one first.
    attachments : str or sequence of str, optional
        Of the lumped points; by default the body's first.
    wanted : iterable of str
        Names of modes that are searched for until they are there.
    spare : bool
        Whether one more of the same motion is wanted above each.
    """
    if attachments is None or isinstance(attachments, str):
        attachments = [attachments] * len(ports)
    kinds = tuple(attachments)
    with meter.stage("statics"):
        condensed, *others = (
            condense(body, supports, port, kind) for port, kind in zip(ports, kinds)
        )
        coupled = condense(body, supports, tuple(ports), kinds) if others else None
    further = dict(zip(ports[1:], others))
    with meter.stage("modes"):
        found = searched(
            body,
            supports,
            n,
            wanted,
            spare=spare,
            max_frequency=max_frequency,
            count=count,
            ovalising=ovalising,
        )
    # Evidence, not part of the answer: kept apart from what the modes cost.
    meter.move("modes", "count", found.evidence.get("count_seconds", 0.0))
    values = measure(condensed, found, further, coupled)
    return Answer(body, condensed, found, values, further, coupled, supports)
