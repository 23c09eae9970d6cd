"""What one rung answers about one scene: build, condense, modes, measure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from solidgear.body import Body, Supports, as_supports
from solidgear.evidence.quantities import QUANTITIES, measure
from solidgear.fidelity import build
from solidgear.machine.meter import Meter
from solidgear.solve.modes import ModeSet, modes
from solidgear.solve.statics import Condensed, condense

if TYPE_CHECKING:
    from solidgear.scene import Scene

#: modes that hold the first bending pair and the first axial mode of anything that looks like a
#: shaft
ENOUGH = 10


@dataclass(frozen=True)
class Numbers:
    """What an answer says, without the body behind it.

    Attributes
    ----------
    quantities : dict of str to float
        The compared numbers; see :mod:`solidgear.evidence.quantities`.
    solver : dict of str to float
        Relative error that the solver may have left in every one of them.
    """

    quantities: dict[str, float]
    solver: dict[str, float]


def numbers(statics: Condensed | None, found: ModeSet | None) -> Numbers:
    """The compared numbers of statics and modes, either of which may not have been solved."""
    return Numbers(measure(statics, found), _left(statics, found))


def _left(statics: Condensed | None, found: ModeSet | None) -> dict[str, float]:
    """Relative error that the solver may have left in every quantity."""
    solver = {}
    for name, (kind, place, _) in QUANTITIES.items():
        if kind == "frequency":
            mode = found.named(place) if found is not None and isinstance(place, str) else None
            if mode is not None:
                solver[name] = mode.error
        elif statics is not None:
            solver[name] = statics.evidence["residual"]
    return solver


@dataclass
class Answer:
    """A body on its bearings, tied in one way.

    Attributes
    ----------
    body : Body
    condensed : Condensed
        Statics at the lumped point.
    modes : ModeSet
    quantities : dict of str to float
        The compared numbers; see :mod:`solidgear.evidence.quantities`.
    """

    body: Body
    condensed: Condensed
    modes: ModeSet
    quantities: dict[str, float]

    @property
    def numbers(self) -> Numbers:
        """Its numbers and what the solver may have left in them; they outlive the body."""
        return Numbers(self.quantities, _left(self.condensed, self.modes))


def solve(
    scene: Scene,
    rung: str,
    n: int = ENOUGH,
    *,
    max_frequency: float | None = None,
    count: bool = False,
    ovalising: bool = False,
    meter: Meter | None = None,
    **options: Any,
) -> Answer:
    """Build one rung of a scene and solve it as the scene is tied.

    Parameters
    ----------
    scene : Scene
    rung : str
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
    >>> sorted(found.quantities)[:3]
    ['C_thx', 'C_yy', 'C_z,thx']
    """
    meter = meter or Meter()
    with meter.stage("build"):
        body = build(scene, rung, **options)
    return answered(
        body,
        as_supports(scene),
        scene.port.name,
        n=n,
        max_frequency=max_frequency,
        count=count,
        ovalising=ovalising,
        meter=meter,
    )


def answered(
    body: Body,
    supports: Supports,
    port: str,
    attachment: str | None = None,
    *,
    n: int = ENOUGH,
    max_frequency: float | None = None,
    count: bool = False,
    ovalising: bool = False,
    meter: Meter,
) -> Answer:
    """What a body answers on some supports; parameters as for :func:`solve`.

    Parameters
    ----------
    body : Body
    supports : Supports
    port : str
        Of the lumped point.
    attachment : str, optional
        Of the lumped point; by default the body's first.
    """
    with meter.stage("statics"):
        condensed = condense(body, supports, port, attachment)
    with meter.stage("modes"):
        found = modes(
            body, supports, n, max_frequency=max_frequency, count=count, ovalising=ovalising
        )
    # Evidence, not part of the answer: kept apart from what the modes cost.
    meter.move("modes", "count", found.evidence.get("count_seconds", 0.0))
    return Answer(body, condensed, found, measure(condensed, found))
