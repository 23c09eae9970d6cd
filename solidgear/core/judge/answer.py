"""The cheapest answer to a question, with an error bar.

A solid is solved on ever finer meshes until the error bar of every quantity asked for
(:mod:`solidgear.core.judge.bars`) is within the tolerance; only the families of motion that the question
needs are built, statics only if a compliance or a stiffness is asked for, modes only if a frequency
is. A beam has no error bar of its own: its error is known from a solid only, whose coarsest mesh
with two orders costs about as much as the beam, so it is the answer as well. Models that were
passed over, and why, are part of the answer.
"""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from solidgear.core.body.mode_names import ModeName
from solidgear.core.display import Displayed
from solidgear.core.errors import SolidgearError, nearest, show
from solidgear.core.frames import DOF_NAMES
from solidgear.core.judge.cautions import number_cautions
from solidgear.core.judge.quantities import canonical_name, judged
from solidgear.core.judge.question import FamilySolver
from solidgear.core.judge.refinement import (
    INTERRUPTED,
    Interrupted,
    Progress,
    Refinement,
    refine,
    uninterrupted,
)
from solidgear.core.judge.solving import ENOUGH
from solidgear.core.judge.steps import Step, Value
from solidgear.core.ladder import NO_MODEL, build, way_out
from solidgear.core.ladder.meshes import HARMONIC
from solidgear.core.ladder.model import BEAM, SOLID
from solidgear.core.ladder.registry import LADDER
from solidgear.core.loading import load
from solidgear.core.machine.memory import one_run
from solidgear.core.machine.threads import pinned
from solidgear.core.named import ByName
from solidgear.core.plain import plain
from solidgear.core.quantity import ACROSS, QUANTITIES, Quantity
from solidgear.core.scene.document import Source
from solidgear.core.scene.shaft import without_axis
from solidgear.core.scene.units import quantity
from solidgear.core.solve.families import FAMILIES
from solidgear.core.solve.modes import modes

if TYPE_CHECKING:
    from solidgear.core.scene import Scene

#: between two quantities
COMMA = rf",(?!\s*(?:{'|'.join(DOF_NAMES)})\b)"
#: a natural frequency by its place above zero, such as f1
PLACE = re.compile(r"f_?(\d{1,2})", re.IGNORECASE)
#: short words for quantities
WORDS = {family: Quantity(f"{family} 1") for family in FAMILIES}
#: below this, rounding of stiffness matrices decides what an answer is worth
LEAST_TOLERANCE = 1e-9


@dataclass(frozen=True, repr=False)
class Answered(ByName[float], Displayed):
    """An answer and the way to it."""

    shown: ClassVar[str] = "answered"
    plain_names = (
        *("scene", "tolerance", "values", "steps", "reached"),
        *(("model", "rung"), "missing", "cautions", "seconds"),
    )

    scene: str
    tolerance: float
    values: tuple[Value, ...]  #: in the order asked for
    steps: tuple[Step, ...]
    reached: bool  #: whether every bar is within the tolerance
    rung: str  #: that the values come from
    #: quantities that do not exist for this scene, such as the compliance of a free motion
    missing: tuple[Quantity, ...]
    cautions: tuple[str, ...]  #: sentences on what the numbers leave out
    seconds: float

    @property
    def by_name(self) -> dict[str, float]:
        """Numbers by their quantities, SI, in the order asked for."""
        return {v.quantity: v.value for v in self.values}

    @property
    def bar(self) -> float:
        """Largest error bar; infinite where nothing that was asked for exists."""
        return max((v.bar for v in self.values), default=math.inf)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return plain(self)


@pinned
def answer(
    scene: Source,
    tol: float | str | None = None,
    ask: Iterable[str] | str = (),
    *,
    progress: Progress = lambda _: None,
) -> Answered:
    """Numbers within a tolerance, from the cheapest model and mesh that can show it.

    Parameters
    ----------
    scene : path, dict or Scene
        A scene: its file (TOML), the tables of one, or an object.
    tol : float or str, optional
        Relative error that every quantity may have, such as 0.01 or ``"1%"``; by default the
        tolerance of the scene.
    ask : str or iterable of str, optional
        Quantities (:data:`solidgear.core.quantity.QUANTITIES`), or ``bending``, ``axial``,
        ``torsion`` for the first frequency of a family, ``f1``, ``f2`` ... for the lowest of all;
        ``C_zz@name`` at a further lumped point; by default those the scene asks for.
    progress : callable
        Called with a sentence at every step.

    Returns
    -------
    Answered
        After the last mesh that could be solved; ``reached`` says whether it is within the tolerance.

    Raises
    ------
    SolidgearError
        For a tolerance that is not usable, an unknown quantity, or a
        scene that no model can answer.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> found = sg.answer(scene, tol=0.01, ask=["C_zz"])
    >>> found.reached, found.rung, found.bar <= 0.01
    (True, 'harmonic', True)
    """
    scene = load(scene)
    if without_axis(scene):
        raise SolidgearError(f"answer: {scene.name} has no axis: run solidgear stiffness or modes")
    start = time.perf_counter()
    tol = read_tolerance(scene.ask.tolerance if tol is None else tol)
    wanted = asked_for(scene, ask)
    try:
        solver, steps = solve_cheapest(scene, tol, wanted, progress)
    except Interrupted as stop:
        solver, steps = stop.result
    values, rung = solver.refinement.values(), solver.refinement.model.name
    existing = {v.quantity for v in values}
    found = Answered(
        scene=scene.name,
        tolerance=tol,
        values=values,
        steps=tuple(steps),
        reached=bool(values) and all(v.bar <= tol for v in values),
        rung=rung,
        missing=tuple(q for q in wanted if q not in existing),
        cautions=tuple(number_cautions(scene, {v.quantity: v.bar for v in values}, rung)),
        seconds=time.perf_counter() - start,
    )
    return uninterrupted(found, steps)


def solve_cheapest(
    scene: Scene,
    tol: float,
    wanted: tuple[Quantity, ...],
    progress: Progress,
    solver_of: Callable[[Refinement], FamilySolver] = FamilySolver,
    *,
    whole: bool = False,
    only: str = "",
) -> tuple[FamilySolver, list[Step]]:
    """Refine the first solid of the ladder that can be solved at all, or `only` one, with `whole` for
    the body and not for single numbers; return also the steps that were passed over and tried, in
    the order of the ladder. SolidgearError if no model can be solved.
    """
    steps = [
        Step(
            name,
            setting="",
            valid=False,
            why="beams cannot show their own error",
        )
        for name in LADDER.of(BEAM)
        if not only
    ]
    with one_run():
        for name in (only,) if only else LADDER.of(SOLID):
            model = LADDER[name]
            refinement = Refinement(
                scene,
                model,
                wanted,
                tol,
                plan=model.meshes_of(scene, {}),
                whole=whole,
                middles=not whole,  # a body is given with its own couplings
            )
            solver = solver_of(refinement)
            try:
                refine(refinement, solver, progress, model.title)
            except (SolidgearError, MemoryError) as error:
                reason = str(error) or "not enough memory"
                if not refinement.levels and only:
                    raise
                if not refinement.levels:
                    steps.append(Step(name, setting="", valid=False, why=reason))
                    continue
                refinement.end(f"the next mesh could not be solved: {reason}")
            except KeyboardInterrupt:  # what a coarser mesh gave is kept
                if not refinement.levels:
                    raise
                refinement.end(INTERRUPTED)
                raise Interrupted((solver, steps + refinement.steps)) from None
            return solver, steps + refinement.steps
    models: dict[str, list[str]] = {}
    way = way_out(scene)
    for step in steps:
        if step.rung in LADDER.of(SOLID):
            models.setdefault(step.why.removesuffix(f"; {way}"), []).append(step.rung)
    reasons = [f"{' and '.join(names)}: {reason}" for reason, names in models.items()]
    advice = way.removeprefix(NO_MODEL)
    raise SolidgearError(f"no model can answer: {'; '.join(reasons)}{advice}")


def read_tolerance(tol: float | str) -> float:
    """Return a tolerance that can be met; a text is read as in a scene. SolidgearError unless it is
    above 0, at most 1, and not below the limit of arithmetic.
    """
    text = tol
    try:
        tol = quantity(text, "dimensionless")
    except SolidgearError:
        tol = math.nan
    if not 0 < tol <= 1:
        raise SolidgearError(
            f'tol = {show(text)} is not usable; give a number above 0 and at most 1, or "1%"'
        )
    if tol < LEAST_TOLERANCE:
        raise SolidgearError(
            f"tol = {tol:g} is below what arithmetic of sixteen digits allows; "
            f"give at least {LEAST_TOLERANCE:g}"
        )
    return tol


def asked_for(scene: Scene, ask: Iterable[str] | str) -> tuple[Quantity, ...]:
    """Return the quantities named by the words of an option; without any, those that a scene is
    judged by.
    """
    # C_z,thx has a comma of its own, and no quantity is called as a component alone
    names = re.split(COMMA, ask) if isinstance(ask, str) else list(ask)
    names = [name.strip() for name in names if name.strip()]
    if not names:
        return judged(scene)
    out = []
    for name in names:
        requested = Quantity(name)
        symbol = re.sub(r"_(\d)", r" \1", requested.symbol)  # bending_1
        word = WORDS.get(requested.symbol) or Quantity(symbol)
        if (place := PLACE.fullmatch(requested)) is not None:
            word = _lowest(scene, int(place[1]))
        if requested.points and word in QUANTITIES:
            if word.is_frequency:
                raise SolidgearError(
                    f"ask: {name}: a frequency belongs to the whole shaft; ask for {word}"
                )
            word = canonical_name(scene, requested)
        elif requested.points or not (word in (*QUANTITIES, *ACROSS) or _is_mode(word)):
            quantities = (*QUANTITIES, *ACROSS, *WORDS, "f1")
            if place is not None:
                raise SolidgearError(
                    f"ask: {name} is {word} here, for which answer has no error bar; ask for "
                    f"{', '.join(q for q in QUANTITIES if q.is_frequency)}, or run solidgear modes"
                )
            raise SolidgearError(
                f"ask: there is no quantity {show(name, 40)}{nearest(name, quantities)}; there are "
                f"{', '.join(quantities)}"
            )
        out.append(word if word.points else canonical_name(scene, word))
    return tuple(dict.fromkeys(out))


def _is_mode(name: Quantity) -> bool:
    """Return True for the name of a mode of bending, stretch or torsion, whatever its number."""
    mode = ModeName(name)
    return mode.family in FAMILIES and bool(mode.number) and not mode.rigid and not mode.plane


def _lowest(scene: Scene, place: int) -> Quantity:
    """Return the name of a natural frequency by the place among those above zero, from 1, twins
    counted once.

    A light harmonic solid of the plain part gives the order; its frequencies are not shown.
    """
    body = build(scene.plain, "harmonic", **HARMONIC)
    listed = modes(body, scene.plain, max(ENOUGH, 2 * place)).modes
    names = [mode.name for mode in listed if mode.frequency_hz > 0]
    if not 0 < place <= len(names):
        raise SolidgearError(f"ask: f{place}: give f1 to f{len(names)}")
    return Quantity(names[place - 1])
