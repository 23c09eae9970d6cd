"""The cheapest answer to a question, with an error that it can be held to.

A solid is solved on ever finer meshes until the error bar of every quantity asked for
(:mod:`solidgear.judge.bars`) is within the tolerance; only the families of motion that the
question needs are built, statics only if a compliance or a stiffness is asked for, modes only if a
frequency is.  A beam has no error of its own to show: what it lacks is known from a solid only,
whose coarsest mesh with two orders costs about as much as the beam, so it is the answer as well.
Models that were passed over, and why, are part of the answer.
"""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from solidgear.display import Displayed
from solidgear.errors import SolidgearError, nearest, show
from solidgear.frames import DOF_NAMES
from solidgear.judge.climb import Climb
from solidgear.judge.quantities import judged, own_name
from solidgear.judge.refinement import Progress
from solidgear.judge.solving import ENOUGH
from solidgear.judge.steps import Step, Value
from solidgear.ladder import NO_MODEL, build, way_out
from solidgear.ladder.meshes import HARMONIC
from solidgear.ladder.model import BEAM, SOLID
from solidgear.ladder.registry import LADDER
from solidgear.machine.memory import one_run
from solidgear.machine.threads import pinned
from solidgear.quantity import ACROSS, QUANTITIES, Quantity
from solidgear.scene.shaft import without_axis
from solidgear.scene.units import quantity
from solidgear.solve.families import FAMILIES
from solidgear.solve.modes import modes

if TYPE_CHECKING:
    from solidgear.scene import Scene

C = TypeVar("C", bound=Climb)

#: between two quantities
COMMA = rf",(?!\s*(?:{'|'.join(DOF_NAMES)})\b)"
#: a natural frequency by its place above zero, such as f1
PLACE = re.compile(r"f_?(\d{1,2})", re.IGNORECASE)
#: short words for quantities
WORDS = {family: Quantity(f"{family} 1") for family in FAMILIES}
#: below this, rounding of stiffness matrices decides what an answer is worth
LEAST_TOLERANCE = 1e-9


@dataclass(frozen=True, repr=False)
class Answered(Displayed):
    """An answer and the way to it."""

    shown: ClassVar[str] = "answered"

    scene: str
    tolerance: float
    values: tuple[Value, ...]  #: in the order asked for
    steps: tuple[Step, ...]
    reached: bool  #: whether every bar is within the tolerance
    rung: str  #: that the values come from
    #: quantities that do not exist for this scene, such as the compliance of a free motion
    missing: tuple[Quantity, ...]
    seconds: float

    def __getitem__(self, quantity: str) -> float:
        return next(v.value for v in self.values if v.quantity == quantity)

    @property
    def bar(self) -> float:
        """The largest bar; infinite where nothing that was asked for exists."""
        return max((v.bar for v in self.values), default=math.inf)

    def as_dict(self) -> dict[str, Any]:
        """Plain data."""
        out = asdict(self)
        for row in (*out["values"], *out["steps"]):
            if row["bar"] is not None and not math.isfinite(row["bar"]):
                row["bar"] = None
        return out


@pinned
def answer(
    scene: Scene,
    tol: float | str | None = None,
    ask: Iterable[str] | str = (),
    *,
    progress: Progress = lambda _: None,
) -> Answered:
    """Numbers within a tolerance, from the cheapest model and mesh that can show it.

    Parameters
    ----------
    scene : Scene
    tol : float or str, optional
        Relative error that every quantity may have, such as 0.01 or ``"1%"``; by default the
        tolerance of the scene.
    ask : str or iterable of str, optional
        Quantities (:data:`solidgear.quantity.QUANTITIES`), or ``bending``, ``axial``,
        ``torsion`` for the first frequency of a family, ``f1``, ``f2`` ... for the lowest of all;
        ``C_zz@name`` at a further lumped point; by default those the scene asks for.
    progress : callable
        Called with a sentence at every step.

    Returns
    -------
    Answered
        After the last mesh that could be solved; ``reached`` says whether it will do.

    Raises
    ------
    SolidgearError
        For a tolerance that is none or that arithmetic does not allow, an unknown quantity, or a
        scene that no model can answer.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> found = sg.answer(scene, tol=0.01, ask=["C_zz"])
    >>> found.reached, found.rung, found.bar <= 0.01
    (True, 'harmonic', True)
    """
    if without_axis(scene):
        raise SolidgearError(f"answer: {scene.name} has no axis: run solidgear stiffness or modes")
    start = time.perf_counter()
    tol = usable(scene.ask.tolerance if tol is None else tol)
    wanted = asked_for(scene, ask)
    climb, steps = climbed(scene, tol, wanted, Climb, progress)
    values = climb.values()
    known = {v.quantity for v in values}
    return Answered(
        scene.name,
        tol,
        values,
        tuple(steps),
        bool(values) and all(v.bar <= tol for v in values),
        climb.model.name,
        tuple(q for q in wanted if q not in known),
        time.perf_counter() - start,
    )


def climbed(
    scene: Scene,
    tol: float,
    wanted: tuple[Quantity, ...],
    kind: Callable[..., C],
    progress: Progress,
) -> tuple[C, list[Step]]:
    """The first solid of the ladder that can be solved at all, on the meshes that it takes; with the steps
    that were passed over and tried, in the order of the ladder.

    Parameters
    ----------
    kind : type of Climb, or what makes one

    Raises
    ------
    SolidgearError
        If no model can be solved.
    """
    steps = [
        Step(
            name,
            "",
            False,
            "no error of their own to show; the coarsest solid, which could show it, "
            "costs as much and is better",
        )
        for name in LADDER.of(BEAM)
    ]
    with one_run():
        for name in LADDER.of(SOLID):
            climb = kind(scene, LADDER[name], wanted, tol, progress)
            try:
                climb.run()
            except (SolidgearError, MemoryError) as error:
                if not climb.levels:
                    steps.append(Step(name, "", False, str(error) or "not enough memory"))
                    continue
                climb.stop(str(error) or "not enough memory")
            return climb, steps + climb.steps
    whys: dict[str, list[str]] = {}
    way = way_out(scene)
    for step in steps:
        if step.rung in LADDER.of(SOLID):
            whys.setdefault(step.why.removesuffix(f"; {way}"), []).append(step.rung)
    failed = [f"{' and '.join(models)}: {why}" for why, models in whys.items()]
    taught = way.removeprefix(NO_MODEL)
    raise SolidgearError(f"no model can answer: {'; '.join(failed)}{taught}")


def usable(tol: float | str) -> float:
    """A tolerance that can be held; a text is read as in a scene.

    Raises
    ------
    SolidgearError
        Unless it is above 0, at most 1, and not below what arithmetic allows.
    """
    given = tol
    try:
        tol = quantity(given, "dimensionless")
    except SolidgearError:
        tol = math.nan
    if not 0 < tol <= 1:
        raise SolidgearError(
            f'tol = {show(given)} is not usable; give a number above 0 and at most 1, or "1%"'
        )
    if tol < LEAST_TOLERANCE:
        raise SolidgearError(
            f"tol = {tol:g} is below what arithmetic of sixteen digits allows; "
            f"give at least {LEAST_TOLERANCE:g}"
        )
    return tol


def asked_for(scene: Scene, ask: Iterable[str] | str) -> tuple[Quantity, ...]:
    """Quantities by the words of an option; those that a scene is judged by without any."""
    # C_z,thx has a comma of its own, and no quantity is called as a component alone
    given = re.split(COMMA, ask) if isinstance(ask, str) else list(ask)
    given = [name.strip() for name in given if name.strip()]
    if not given:
        return judged(scene)
    out = []
    for name in given:
        asked = Quantity(name)
        symbol = re.sub(r"_(\d)", r" \1", asked.symbol)  # bending_1
        word = WORDS.get(asked.symbol) or Quantity(symbol)
        if (place := PLACE.fullmatch(asked)) is not None:
            word = _lowest(scene, int(place[1]))
        if asked.points and word in QUANTITIES:
            if word.is_frequency:
                raise SolidgearError(f"ask: {name}: a frequency is not of a point; ask for {word}")
            word = own_name(scene, asked)
        elif asked.points or word not in (*QUANTITIES, *ACROSS):
            known = (*QUANTITIES, *ACROSS, *WORDS, "f1")
            if place is not None:
                raise SolidgearError(
                    f"ask: {name} is {word} here, which has no bar of its own in an answer; ask for "
                    f"{', '.join(q for q in QUANTITIES if q.is_frequency)}, or run solidgear modes"
                )
            raise SolidgearError(
                f"ask: there is no quantity {show(name, 40)}{nearest(name, known)}; there are "
                f"{', '.join(known)}"
            )
        out.append(word)
    return tuple(dict.fromkeys(out))


def _lowest(scene: Scene, place: int) -> Quantity:
    """Name of a natural frequency by its place among those above zero, from 1, twins counted once.

    A light harmonic solid of the plain part tells the order; its frequencies are not told.
    """
    body = build(scene.plain, "harmonic", **HARMONIC)
    found = modes(body, scene.plain, max(ENOUGH, 2 * place)).modes
    names = [mode.name for mode in found if mode.frequency_hz > 0]
    if not 0 < place <= len(names):
        raise SolidgearError(f"ask: f{place}: give f1 to f{len(names)}")
    return Quantity(names[place - 1])
