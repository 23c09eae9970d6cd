"""A model of the ladder: everything the program must know of one that it does not know of all."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, ClassVar

from solidgear.errors import SolidgearError, listed, nearest, show
from solidgear.factoring import Factoring
from solidgear.models.kinds import BODIES, CYCLIC
from solidgear.models.options import FACTORING_OPTIONS, Option, checked

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.bounds.safety import Safety
    from solidgear.ladder.meshes import Sequence
    from solidgear.models.size import Size

LUMPED, BEAM, SOLID = "lumped", "beam", "solid"
Options = Mapping[str, Any]
#: a line of a chart: family, label, builder options from the cheapest level on
Series = tuple[str, str, list[dict[str, Any]]]


def features_of(scene: Any) -> tuple[Any, ...]:
    """Features of a scene that are not smeared; see :func:`solidgear.scene.shaft.resolved`, which
    is imported here, for the ladder is read by every command.
    """
    from solidgear.scene.shaft import resolved

    return resolved(scene)


class Model:
    """One model of the ladder; a subclass fills in what is not as usual."""

    name: ClassVar[str]  #: what scenes, commands and records call it
    title: ClassVar[str]  #: in a sentence, such as ``harmonic solid``
    heading: ClassVar[str]  #: at the head of a narrow column; the title unless told otherwise
    #: ``lumped`` (rests on another model's body), ``beam`` or ``solid``. Solids judge the others.
    family: ClassVar[str]
    #: what it solves, in a sentence: ``Trust the ...: exact 3D elasticity ...``
    theory: ClassVar[str] = ""
    #: colour, marker: in charts
    colour: ClassVar[str] = "#777777"
    marker: ClassVar[str] = "P"
    options: ClassVar[Mapping[str, Option]] = {}  #: of the builder, with their limits
    preset: ClassVar[Options] = {}  #: options that make this model of a builder that several share
    coarser: ClassVar[str] = "use a coarser mesh"  #: what to change where it is too large
    #: sorts of features (`CUTS`, `CYCLIC`), or a part from a file (`PARTS`), that its body holds,
    #: one of them at a time; a body of revolution holds none
    holds: ClassVar[tuple[str, ...]] = ()
    #: sorts of these that it holds beside each other
    together: ClassVar[frozenset[str]] = frozenset()
    #: whether it is made for the features that it holds, and for nothing else
    for_features: ClassVar[bool] = False
    #: whether every mesh tells its own error by local problems: its displacements are admissible on
    #: the exact geometry, integrated exactly. Such a body is too stiff, so that compliances come
    #: from below, stiffnesses and frequencies from above.
    bounded: ClassVar[bool] = False
    #: error bars are wanted below the tolerance asked for divided by this
    share: ClassVar[float] = 1.0
    #: whether its mesh carries the mean motion of any section; otherwise it is not compared like
    #: for like
    section_ties: ClassVar[bool] = True
    #: closure of mass and inertia that it owes to the closed form
    mass_tolerance: ClassVar[float] = 1e-9
    most_seats: ClassVar[int] = 12  #: seats that one body carries in a sweep
    #: of an error bar over its meshes, where it is not that of meshes with layers or of plain
    #: refinement
    safety: ClassVar[Safety | None] = None
    #: what its body is, where a feature does not fit it
    _nature: ClassVar[str] = "of revolution"

    def builder(self) -> Callable[..., Body]:
        """``builder(scene, **options)`` gives the free body; it is imported here, for the ladder is
        read by every command and builders bring large libraries.
        """
        raise NotImplementedError(f"the {self.title} has no body of its own")

    def build(self, scene: Any, **options: Any) -> Body:
        """The free body of a scene, by options of the builder within their limits."""
        return self.builder()(scene, **{**self.preset, **options})

    def size(self, scene: Any, options: Options) -> Size:
        """Unknowns and entries of its matrices, counted on the mesh."""
        return self._size(scene, self.defaults() | self.checked(self.given(scene, options)))

    def _size(self, scene: Any, options: dict[str, Any]) -> Size:
        """With all options given; of a body that is cheap it is counted there."""
        from solidgear.models.size import of_body

        return of_body(self.builder()(scene, **self.split(options)[0]))

    def rough_unknowns(self, scene: Any, options: Options) -> float:
        """Unknowns of tetrahedra to within a factor of three or so, without meshing; none unless told
        otherwise.
        """
        return 0.0

    def can_halve(self, scene: Any, options: Options) -> bool:
        """True where an option ``half`` makes it smaller."""
        return False

    def meshes(self, options: Options) -> Sequence:
        """Its coarser and finer relatives by the options that were asked for; of solids."""
        raise NotImplementedError(f"the {self.title} is solved once")

    def meshes_of(self, scene: Any, options: Options) -> Sequence:
        """Meshes for a scene, coarse to fine."""
        return self.meshes({**self.preset, **self.given(scene, options)})

    def series(self, scene: Any, full: bool) -> list[Series]:
        """Lines of a chart of error against cost, with more levels when full; its one usual mesh unless told
        otherwise.
        """
        return [(self.family, self.heading, [{}])]

    def limits(self, scene: Any) -> str:
        """Reason why a scene whose features are of sorts that it holds does not fit it all the same,
        or nothing; asked of scenes with features of `CYCLIC` only.
        """
        return ""

    def unfit(self, scene: Any) -> str:
        """Reason why it does not model a scene, or nothing."""
        from solidgear.scene.features import FEATURES
        from solidgear.scene.shaft import feature_labels

        features, every = features_of(scene), getattr(scene, "features", ())
        if self.for_features and not any(f.sort in self.holds for f in every):
            held = sorted(kind for kind, one in FEATURES.items() if one.sort in self.holds)
            return (
                f"the {self.title} is made for features, and the scene has none of: "
                f"{listed(kind.replace('_', ' ') for kind in held)}"
            )
        sorts = {f.sort for f in features}
        held_here = {f.sort for f in every} if self.for_features and not sorts else sorts
        if (len(sorts) < 2 or sorts <= self.together) and sorts <= set(self.holds):
            return self.limits(scene) if CYCLIC in held_here else ""
        if not self.holds and all(f.round for f in features):
            return ""
        if BODIES in sorts and BODIES not in self.holds:
            (body,) = (f for f in features if f.sort == BODIES)
            return f"the {self.title} is of a shaft, and a {body.what} has no axis"
        strange = [f for f in features if f.sort not in self.holds]
        unfit = (
            f"the {self.title} is {self._nature} and the scene has "
            f"{feature_labels(strange or features)}"
        )
        if not self.holds:
            return f"{unfit}: it would answer for the plain part"
        return unfit if strange else f"{unfit}, which no mesh holds together"

    def concerns(self, scene: Any) -> bool:
        """True where it is among the models that one asks of a scene without naming any."""
        sorts = {f.sort for f in features_of(scene)}
        return not self.for_features or not sorts.isdisjoint(self.holds)

    def given(self, scene: Any, options: Options) -> dict[str, Any]:
        """Options for the builder of a scene: those asked for over those that its features ask for."""
        return dict(options)

    def checked(self, options: Options) -> dict[str, Any]:
        """Options for the builder within their limits; see
        :func:`solidgear.models.options.checked`.
        """
        return checked(self.name, options, self.options)

    def defaults(self) -> dict[str, Any]:
        """Every option of the builder with the value it has unless told otherwise."""
        from inspect import signature

        parameters = signature(self.builder()).parameters.values()
        own = {p.name: p.default for p in parameters if p.default is not p.empty}
        usual = {k: v for k, v in asdict(Factoring()).items() if k in self.options}
        return own | dict(self.preset) | usual

    def split(self, options: Options) -> tuple[dict[str, Any], Factoring]:
        """Options that the builder takes, apart from those that say how matrices are factored."""
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
    """Models by name, cheapest first.

    Parameters
    ----------
    models : Model

    Examples
    --------
    >>> from solidgear.ladder.registry import LADDER
    >>> LADDER["solid"].title
    '3D solid'
    >>> LADDER.of("beam")
    ('euler', 'timoshenko')
    """

    def __init__(self, *models: Model):
        self.models = models

    def __iter__(self) -> Iterator[Model]:
        return iter(self.models)

    def __contains__(self, name: object) -> bool:
        return any(model.name == name for model in self.models)

    def __getitem__(self, name: str) -> Model:
        for model in self.models:
            if model.name == name:
                return model
        raise SolidgearError(
            f"model {show(name, 40)} is unknown{nearest(name, self.names)}; "
            f"use one of {', '.join(self.names)}"
        )

    @property
    def names(self) -> tuple[str, ...]:
        """All models."""
        return tuple(m.name for m in self.models)

    @property
    def bodies(self) -> tuple[str, ...]:
        """Models that build a body of their own."""
        return tuple(m.name for m in self.models if m.family != LUMPED)

    def fit(self, scene: Any) -> tuple[str, ...]:
        """Those with a body of their own, without models that are made for features of kinds that a
        scene does not have.
        """
        return tuple(n for n in self.bodies if self[n].concerns(scene))

    def holding(self, scene: Any) -> tuple[str, ...]:
        """Those with a body of their own that model all of a scene."""
        return tuple(n for n in self.bodies if not self[n].unfit(scene))

    @property
    def judges(self) -> tuple[str, ...]:
        """Models from the one that judges best to the one that judges worst: solids, the cheaper
        first, then beams, the better first.
        """
        return (*self.of(SOLID), *reversed(self.of(BEAM)))

    def of(self, *families: str) -> tuple[str, ...]:
        """Models of some families."""
        return tuple(m.name for m in self.models if m.family in families)
