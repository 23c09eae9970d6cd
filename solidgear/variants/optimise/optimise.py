"""Search for the entries of a file that reach goals best, as far as error bars distinguish designs.

Every design is read, meshed and solved as a variant of a sweep, its mesh refined until its error bars
are within the tolerance: it costs seconds, and its small jumps from mesh to mesh would spoil differences.
How a space is searched stands in :mod:`solidgear.variants.optimise.search`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from solidgear.core import Sheeted, SolidgearError, Source, document_of
from solidgear.core.errors import names_in
from solidgear.core.models.limits import number
from solidgear.core.plain import plain
from solidgear.variants.optimise.designs import Designs, scene_designs, train_designs
from solidgear.variants.optimise.front import FrontTrace, search_front
from solidgear.variants.optimise.outcome import Outcome
from solidgear.variants.optimise.pool import Design, Pool
from solidgear.variants.optimise.search import Aim, Trace, search
from solidgear.variants.optimise.sentences import sentences, solved_all_of
from solidgear.variants.optimise.wish import limit_of, wish_of
from solidgear.variants.sweep.design import Design as SweepDesign
from solidgear.variants.sweep.entries import as_texts

#: of a range: distance from an end of an optimum that is at it
AT_END = 1e-6
#: designs at most, for each goal
MOST = 500


@dataclass(frozen=True, repr=False, eq=False)
class Optimum(Outcome, Sheeted):
    """Result of a search."""

    shown: ClassVar[str] = "variants.optimise.command:designs"
    sheeted: ClassVar[str] = "variants.optimise.command:optimum_sheet"

    @property
    def sentences(self) -> list[str]:
        """Conclusions."""
        return [*sentences(self)]

    @property
    def results(self) -> dict[str, Any]:
        """Plain data that JSON can hold, SI."""
        return {
            "kind": "optimum",
            "scene": self.scene,
            "goals": [str(goal) for goal in self.goals],
            "keep": [str(wish) for wish in self.keep],
            "best": None if self.best is None else self.best.number,
            "front": [design.number for design in self.front],
            "at_end": list(self.at_end),
            "search": list(solved_all_of(self)),
            "followed": list(self.followed),
            "about_bars": self.unbarred or "beside each value",
            "gain": None if self.gain is None else plain(self.gain),
            "cautions": list(self.cautions),
            "designs": [
                {
                    "number": design.number,
                    **design.values,
                    **self._numbers(design),
                    "kept": design.kept,
                    "status": design.status,
                }
                for design in self.path
            ],
            "sentences": self.sentences,
        }

    def _numbers(self, design: Design) -> dict[str, float | None]:
        """Return the goals of a design with error bars, for JSON."""
        out: dict[str, float | None] = {"value": design.value, "bar": design.bar}
        for goal, value in zip(self.goals[1:], design.goals[1:]):
            out |= {goal.name: value.value, f"{goal.name} bar": value.bar}
        return out


def optimise(
    scene: Source,
    vary: str | Iterable[str] | Mapping[str, Any],
    goal: str | Iterable[str],
    keep: str | Iterable[str] = (),
    *,
    keep_sum: str | Iterable[str] = (),
    follow: str | Iterable[str] = (),
    model: str | None = None,
    tol: float | str | None = None,
    most: int | None = None,
    point: str | int | None = None,
    every_point: bool = False,
    progress: Callable[[str], None] = lambda _: None,
) -> Optimum:
    """Choose entries of a scene or train to make a number as large or as small as possible.

    Parameters
    ----------
    scene : path, dict, Scene or Train
        A scene or train: its file, the tables of one, or an object.
    vary : str or iterable of str, or mapping of str to values
        ``PATH=LOW:HIGH``, such as ``bearing.B.position=180 mm:240 mm``; ``PATH=A,B,C``, such as
        ``bearing.A.catalogue.designation=7208 B,7210 B,6210``; ``PATH=LOW:HIGH:COUNT`` for values at
        equal distances; whole numbers such as teeth by ``PATH=17:25``.
    goal : str or iterable of str
        ``max bending 1``, ``min C_zz``, ``min mass``, ``max life`` ...: columns of the sweep of the
        file. Two goals give a front.
    keep : str or iterable of str
        Limits such as ``C_zz < 5 um/kN``, ``f1 > 600 Hz``, ``life > 20000 h``; error bars included.
    keep_sum : str or iterable of str
        ``PATH+PATH``: sums that stay as they are in the file.
    follow : str or iterable of str
        ``PATH``: diameters that follow the bore of a designation that varies, beside the seat.
    model : str, optional
        Solve every design by it, such as ``timoshenko``, without error bars; by default by the
        cheapest mesh whose error bars are within `tol`.
    tol : float, optional
        Relative error bar of designs; a tenth of the tolerance of the scene by
        default.
    most : int, optional
        Designs that are solved at most; 500 for each goal by default.
    point : str, optional
        Of a train: operating point, by its name or number; the first by default.
    every_point : bool
        Of a train: goals and limits hold for the worst of all operating points.

    Returns
    -------
    Optimum
        ``best``, ``front`` of two goals, all designs in ``path``; ``to_dataframe()`` has them as rows.

    Raises
    ------
    SolidgearError
        For texts that cannot be read, a number that designs do not have, and a file that cannot be
        solved in any of them.

    Examples
    --------
    A bearing of a stepped shaft, where bending 1 is highest, by a beam:

    >>> import solidgear as sg
    >>> found = sg.optimise("geometry/shaft_stepped.toml", ["bearing.B.position=-60 mm:-30 mm"],
    ...     "max bending 1", model="timoshenko")
    >>> found.best.number > 0, found.gain.relative > 0.1, found.at_end
    (True, True, ('bearing.B.position',))
    """
    goals, limits = tuple(map(wish_of, names_in(goal))), tuple(map(limit_of, names_in(keep)))
    if not 1 <= len(goals) <= 2:
        raise SolidgearError(f"`goal`: give one goal, or two for a front, not {len(goals)}")
    if len(goals) == 2 and goals[0].name == goals[1].name:
        raise SolidgearError(f"`goal`: both are of {goals[0].name}; give another number to one")
    most = MOST * len(goals) if most is None else most
    number("optimise", "most", most, least=2, whole=True)
    design = SweepDesign(
        as_texts(vary), keep_sum=names_in(keep_sum), follow=names_in(follow), search=True
    )
    document = document_of(scene)
    names = [wish.name for wish in (*goals, *limits)]
    tried: Designs
    if document.describes_train:
        tried = train_designs(document, design, names, model, tol, point, every_point)
    else:
        tried = scene_designs(document, design, names, model, tol)
    pool = Pool(tried, goals, limits, most, progress)
    first = pool.solve_file()
    trace: Trace | FrontTrace
    trace = search(Aim(pool), [first]) if len(goals) == 1 else search_front(pool)
    aim = Aim(pool)
    sound = [d for d in pool.designs if d.kept and d.place is not None]
    best = aim.best(sound) if sound else None
    shown = trace.front(pool) if isinstance(trace, FrontTrace) else ()
    shown = [*shown] or [first if best is None else best]
    cautions = [text for design in shown for text in pool.cautions(design)]
    return Optimum(
        tried.title,
        goals=goals,
        keep=limits,
        path=tuple(pool.designs),
        best=best,
        front=tuple(trace.front(pool)) if isinstance(trace, FrontTrace) else (),
        at_end=_at_ends(pool, best),
        entries=tried.entries,
        trace=trace,
        most=most,
        followed=tried.task.variants.followed,
        unbarred=tried.unbarred,
        cautions=tuple(dict.fromkeys(cautions)),
        solved=tried.solved,
    )


def _at_ends(pool: Pool, best: Design | None) -> tuple[str, ...]:
    """Return the ranges at whose end a design is."""
    if best is None or best.place is None:
        return ()
    ranges = zip(pool.space.ranges, best.place.x)
    return tuple(entry.label for entry, x in ranges if min(x, 1 - x) <= AT_END)
