"""What a rung of the ladder of models is: everything the program must know of a model that it does
not know of all models.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from solidgear.errors import SolidgearError, listed, nearest, show
from solidgear.factoring import Factoring
from solidgear.models.kinds import CYCLIC, PARTS
from solidgear.models.options import FACTORING_OPTIONS, Option, checked

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.bounds.safety import Safety
    from solidgear.ladder.meshes import Sequence
    from solidgear.ladder.size import Size
    from solidgear.scene.shaft import Shaft

LUMPED, BEAM, SOLID = "lumped", "beam", "solid"
#: a line of a chart: family, label, builder options from the cheapest level on
Series = tuple[str, str, list[dict[str, Any]]]


@dataclass(frozen=True)
class Later:
    """A function of a module that is imported when the function is first called: the ladder is read
    by every command, and builders bring large libraries.
    """

    module: str
    name: str

    def load(self) -> Callable[..., Any]:
        """The function itself."""
        return getattr(importlib.import_module(self.module), self.name)

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self.load()(*args, **kwargs)


@dataclass(frozen=True)
class Rung:
    """One model of the ladder.

    Attributes
    ----------
    name : str
        What scenes, commands and records call it.
    title : str
        In a sentence, such as ``harmonic solid``.
    short : str
        At the head of a narrow column.
    family : str
        ``lumped`` (rests on another rung's body), ``beam`` or ``solid``. Solids judge the others.
    build : callable or None
        ``build(scene, **options)`` gives the free :class:`~solidgear.body.Body`; None for a lumped
        model.
    options : mapping of str to Option
        Of the builder, with their limits.
    preset : mapping
        Options that make this rung of a builder that several share.
    size : callable
        ``size(scene, options)`` gives the :class:`~solidgear.ladder.size.Size` of the body before
        it is built; all options are given.
    meshes : callable, optional
        ``meshes(options)`` gives the :class:`~solidgear.ladder.meshes.Sequence` of its coarser
        and finer relatives; None for a rung that is solved once and has no band of its own.
    safety : Safety, optional
        Of a band over these meshes, where it is not that of meshes with layers or of plain refinement.
    share : float
        Bands are wanted below the tolerance asked for divided by this.
    theory : str
        What it solves, in a sentence: ``Trust the ...: exact 3D elasticity ...``.
    section_ties : bool
        Whether its mesh carries the mean motion of any section; otherwise it is not compared like
        for like.
    bounded : bool
        Whether every mesh tells its own error by local problems: its displacements are admissible on
        the exact geometry, integrated exactly. Such a body is too stiff, so that compliances come
        from below, stiffnesses and frequencies from above.
    mass_tolerance : float
        Closure of mass and inertia that it owes to the closed form.
    most_seats : int
        Seats that one body carries in a sweep.
    series : callable, optional
        ``series(scene, full)`` gives the lines of a chart of error against cost; by default its
        one usual mesh.
    holds : tuple of str
        Sorts of features (`CUTS`, `CYCLIC`), or a part from a file (`PARTS`), that its body holds,
        one of them at a time; a body of revolution holds none.
    nature : str
        What its body is, where a feature does not fit it: ``of revolution``.
    limits : callable, optional
        ``limits(scene)`` tells why a scene whose features are of sorts that it holds does not fit
        it all the same, or nothing; asked of scenes with features of `CYCLIC` only.
    copies : str
        Sort of features for which its mesh is made of copies of another rung's: no second opinion,
        and solved only where it is asked for by name.
    for_features : bool
        Whether it is made for the features that it holds, and for nothing else.
    featured : mapping
        Options of the builder for a scene that is more than its segments: with features, fillets or
        chamfers, or from a file.
    colour, marker : str
        In charts.
    """

    name: str
    title: str
    family: str
    build: Callable[..., Body] | None = None
    options: Mapping[str, Option] = field(default_factory=dict)
    size: Callable[[Shaft, Mapping[str, Any]], Size] | None = None
    short: str = ""
    preset: Mapping[str, Any] = field(default_factory=dict)
    meshes: Callable[[Mapping[str, Any]], Sequence] | None = None
    safety: Safety | None = None
    share: float = 1.0
    theory: str = ""
    section_ties: bool = True
    bounded: bool = False
    mass_tolerance: float = 1e-9
    most_seats: int = 12
    series: Callable[[Any, bool], list[Series]] | None = None
    holds: tuple[str, ...] = ()
    nature: str = "of revolution"
    limits: Callable[[Any], str] | None = None
    copies: str = ""
    for_features: bool = False
    featured: Mapping[str, Any] = field(default_factory=dict)
    colour: str = "#777777"
    marker: str = "P"

    @property
    def heading(self) -> str:
        """Its name at the head of a narrow column."""
        return self.short or self.title

    def unfit(self, scene: Any) -> str:
        """Why it does not model a scene, or nothing.

        Parameters
        ----------
        scene : Scene
        """
        from solidgear.scene.features import FEATURES
        from solidgear.scene.shaft import named, resolved

        features, every = resolved(scene), getattr(scene, "features", ())
        if self.for_features and not any(f.sort in self.holds for f in every):
            held = sorted(kind for kind, one in FEATURES.items() if one.sort in self.holds)
            return (
                f"the {self.title} is made for features, and the scene has none of: "
                f"{listed(kind.replace('_', ' ') for kind in held)}"
            )
        sorts = {f.sort for f in features}
        held_here = {f.sort for f in every} if self.for_features and not sorts else sorts
        if len(sorts) < 2 and sorts <= set(self.holds):
            return self.limits(scene) if self.limits and CYCLIC in held_here else ""
        if not self.holds and all(f.round for f in features):
            return ""
        strange = [f for f in features if f.sort not in self.holds]
        unfit = f"the {self.title} is {self.nature} and the scene has {named(strange or features)}"
        if not self.holds:
            return f"{unfit}: it would answer for the plain part"
        return unfit if strange else f"{unfit}, which no mesh holds together"

    def concerns(self, scene: Any) -> bool:
        """Whether it is among the models that one asks of a scene without naming any.

        Parameters
        ----------
        scene : Scene
        """
        from solidgear.scene.shaft import resolved

        sorts = {f.sort for f in resolved(scene)}
        if self.for_features:
            return not sorts.isdisjoint(self.holds)
        return self.copies not in sorts

    def meshes_of(self, scene: Any, options: Mapping[str, Any]) -> Sequence:
        """Meshes for a scene, coarse to fine; see ``meshes``.

        Parameters
        ----------
        scene : Scene
        options : mapping
            Builder options that were asked for.
        """
        from solidgear.ladder.meshes import Sequence

        assert self.meshes is not None  # asked of rungs that have them
        given = self.given(scene, options)
        # what is of revolution is meshed from the segments of the round part, coarse to fine
        own = PARTS in self.holds
        if own and getattr(getattr(scene, "body", None), "one_mesh", False):
            return Sequence((given,), True, False)
        return self.meshes(given)

    def given(self, scene: Any, options: Mapping[str, Any]) -> dict[str, Any]:
        """Options for the builder of a scene: those asked for over those of its features.

        Parameters
        ----------
        scene : Scene
        options : mapping
        """
        from solidgear.scene.shaft import resolved

        # layered hexahedra converge too slowly beside fillets for their bands
        special = resolved(scene) or getattr(scene, "corners", ())
        return {**(self.featured if special else {}), **options}

    def checked(self, options: Mapping[str, Any]) -> dict[str, Any]:
        """Options for the builder within their limits; see
        :func:`solidgear.models.options.checked`.
        """
        return checked(self.name, options, self.options)

    def defaults(self) -> dict[str, Any]:
        """Every option of the builder with the value it has unless told otherwise."""
        from inspect import signature

        assert self.build is not None
        builder = self.build.load() if isinstance(self.build, Later) else self.build
        parameters = signature(builder).parameters.values()
        own = {p.name: p.default for p in parameters if p.default is not p.empty}
        usual = {k: v for k, v in asdict(Factoring()).items() if k in self.options}
        return own | dict(self.preset) | usual

    def split(self, options: Mapping[str, Any]) -> tuple[dict[str, Any], Factoring]:
        """What of the options the builder takes, and how the matrices are to be factored."""
        own = {k: v for k, v in options.items() if k not in FACTORING_OPTIONS}
        factoring = Factoring(**{k: v for k, v in options.items() if k in FACTORING_OPTIONS})
        if factoring.engine != "own" and (factoring.precision, factoring.out_of_core) != (
            "double",
            False,
        ):
            raise SolidgearError(
                f"{self.name}: engine = {factoring.engine} factors in double precision and in memory; "
                "leave out precision and out_of_core"
            )
        return own, factoring


class Ladder:
    """Rungs by name, cheapest first.

    Parameters
    ----------
    rungs : Rung

    Examples
    --------
    >>> from solidgear.ladder.registry import LADDER
    >>> LADDER["solid"].title
    '3D solid'
    >>> LADDER.of("beam")
    ('euler', 'timoshenko')
    """

    def __init__(self, *rungs: Rung):
        self.rungs = rungs

    def __iter__(self) -> Iterator[Rung]:
        return iter(self.rungs)

    def __contains__(self, name: object) -> bool:
        return any(rung.name == name for rung in self.rungs)

    def __getitem__(self, name: str) -> Rung:
        for rung in self.rungs:
            if rung.name == name:
                return rung
        raise SolidgearError(
            f"model {show(name, 40)} is unknown{nearest(name, self.names)}; "
            f"use one of {', '.join(self.names)}"
        )

    @property
    def names(self) -> tuple[str, ...]:
        """All rungs."""
        return tuple(rung.name for rung in self.rungs)

    @property
    def bodies(self) -> tuple[str, ...]:
        """Rungs that build a body of their own."""
        return tuple(rung.name for rung in self.rungs if rung.build is not None)

    def fit(self, scene: Any) -> tuple[str, ...]:
        """Those with a body of their own, without rungs that are made for features of kinds that a
        scene does not have.
        """
        return tuple(n for n in self.bodies if self[n].concerns(scene))

    @property
    def judges(self) -> tuple[str, ...]:
        """Rungs from the one that judges best to the one that judges worst: solids, the cheaper
        first, then beams, the better first.
        """
        return (*self.of(SOLID), *reversed(self.of(BEAM)))

    def of(self, *families: str) -> tuple[str, ...]:
        """Rungs of some families."""
        return tuple(rung.name for rung in self.rungs if rung.family in families)
