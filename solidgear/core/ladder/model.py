"""A model of the ladder: name, options, builder and limits of one model, and the ladder of all."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, ClassVar

from solidgear.core.errors import NoSuchName, SolidgearError, listed, nearest, show
from solidgear.core.factoring import Factoring
from solidgear.core.models.kinds import BODIES, CYCLIC
from solidgear.core.models.options import FACTORING_OPTIONS, Option, checked
from solidgear.core.registry import absent, added

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.ladder.meshes import Sequence
    from solidgear.core.models.size import Size
    from solidgear.core.scene.shaft import Shaft

LUMPED, BEAM, SOLID = "lumped", "beam", "solid"
Options = Mapping[str, Any]
#: a line of a chart: family, label, builder options from the cheapest level on
Series = tuple[str, str, list[dict[str, Any]]]


def features_of(scene: Shaft) -> tuple[Any, ...]:
    """Return the features of a scene that are not smeared."""
    from solidgear.core.scene.shaft import resolved  # start-up: every command reads the ladder

    return resolved(scene)


class Model:
    """One model of the ladder; a subclass overrides what differs from these defaults."""

    name: ClassVar[str]  #: in scenes, commands and records
    title: ClassVar[str]  #: in a sentence, such as ``harmonic solid``
    heading: ClassVar[str]  #: at the head of a narrow column
    #: ``lumped`` (rests on the body of another model), ``beam`` or ``solid``; solids judge the others
    family: ClassVar[str]
    #: in a sentence: ``Trust the ...: exact 3D elasticity ...``
    theory: ClassVar[str] = ""
    colour: ClassVar[str] = "#777777"  #: in charts
    marker: ClassVar[str] = "P"  #: in charts
    options: ClassVar[Mapping[str, Option]] = {}  #: of the builder, with their limits
    preset: ClassVar[Options] = {}  #: options of a builder that several models share
    at_rest: ClassVar[
        Options
    ] = {}  #: options with which the body is exact at rest, and costs least
    coarser: ClassVar[str] = "use a coarser mesh"  #: advice where it is too large
    #: sorts of features (`CUTS`, `CYCLIC`), or a part from a file (`PARTS`), that it can model, one
    #: of them at a time; a body of revolution none
    holds: ClassVar[tuple[str, ...]] = ()
    #: sorts of these that it can model together
    together: ClassVar[frozenset[str]] = frozenset()
    #: whether it is made for these features alone
    for_features: ClassVar[bool] = False
    #: where error bars of its mesh come from, in a table; empty for models that cannot show their error
    bars_by: ClassVar[str] = ""
    #: whether the next mesh is made from the error bars of the last one, on the exact geometry
    follows: ClassVar[bool] = False
    #: error bars are wanted below the tolerance asked for divided by this
    share: ClassVar[float] = 1.0
    #: whether its mesh has the mean motion of any section, so that it is compared with equal seats
    section_ties: ClassVar[bool] = True
    #: relative tolerance of mass and inertia against the closed form
    mass_tolerance: ClassVar[float] = 1e-9
    most_seats: ClassVar[int] = 12  #: seats that one body carries in a sweep
    #: nature of its body, in refusals of a feature
    _nature: ClassVar[str] = "of revolution"

    def builder(self) -> Callable[..., Body]:
        """Import and return the builder: ``builder(scene, **options)`` gives the free body."""
        raise NotImplementedError(f"the {self.title} has no body")

    def build(self, scene: Shaft, **options: Any) -> Body:
        """Build the free body of a scene, by options of the builder within their limits."""
        return self.builder()(scene, **{**self.preset, **options})

    def size(self, scene: Shaft, options: Options) -> Size:
        """Count the unknowns and matrix entries on the mesh."""
        return self._size(scene, self.defaults() | self.checked(self.given(scene, options)))

    def _size(self, scene: Shaft, options: dict[str, Any]) -> Size:
        """Count with all options given; a cheap body is built and counted."""
        from solidgear.core.models.size import size_of_body

        return size_of_body(self.builder()(scene, **self.split(options)[0]))

    def rough_unknowns(self, scene: Shaft, options: Options) -> float:
        """Estimate the unknowns of tetrahedra to within a factor of about three, without meshing; 0
        for models without tetrahedra.
        """
        return 0.0

    def can_halve(self, scene: Shaft, options: Options) -> bool:
        """Return True where an option ``half`` makes the body smaller."""
        return False

    def meshes(self, options: Options) -> Sequence:
        """Return the meshes of a solid, coarse to fine, by the options that were asked for."""
        raise NotImplementedError(f"the {self.title} is solved once")

    def meshes_of(self, scene: Shaft, options: Options) -> Sequence:
        """Return the meshes for a scene, coarse to fine."""
        return self.meshes({**self.preset, **self.given(scene, options)})

    def series(self, scene: Shaft, full: bool) -> list[Series]:
        """Return lines of a chart of error against cost, with more levels when full; the usual mesh
        alone by default.
        """
        return [(self.family, self.heading, [{}])]

    def limits(self, scene: Shaft) -> str:
        """Return the reason why this model cannot solve the scene, although it supports its
        features; empty if it can. Called for scenes with features of `CYCLIC` only.
        """
        return ""

    def can_model(self, scene: Shaft) -> bool:
        """Return True where it models all of a scene; :meth:`unfit` says why not, and imports every
        feature there is for that.
        """
        return not self._misses_features(scene) and not self.unfit(scene)

    def _misses_features(self, scene: Shaft) -> bool:
        """Return True where it is made for features and the scene has none of them."""
        return self.for_features and not any(f.sort in self.holds for f in scene.features)

    def unfit(self, scene: Shaft) -> str:
        """Return the reason why it does not model a scene; empty if it does."""
        from solidgear.core.scene.shaft import feature_labels

        features, with_smeared = features_of(scene), scene.features
        if self._misses_features(scene):
            kinds = sorted(kind for kind, cls in added("feature").items() if cls.sort in self.holds)
            return (
                f"the {self.title} needs features, and the scene has none of: "
                f"{listed(kind.replace('_', ' ') for kind in kinds)}"
            )
        sorts = {f.sort for f in features}
        modelled = {f.sort for f in with_smeared} if self.for_features and not sorts else sorts
        if (len(sorts) < 2 or sorts <= self.together) and sorts <= set(self.holds):
            return self.limits(scene) if CYCLIC in modelled else ""
        if not self.holds and all(f.round for f in features):
            return ""
        if BODIES in sorts and BODIES not in self.holds:
            (body,) = (f for f in features if f.sort == BODIES)
            return f"the {self.title} is for shafts, and a {body.what} has no axis"
        strange = [f for f in features if f.sort not in self.holds]
        unfit = (
            f"the {self.title} is {self._nature} and the scene has "
            f"{feature_labels(strange or features)}"
        )
        if not self.holds:
            return f"{unfit}: it would answer for the plain part"
        return unfit if strange else f"{unfit}, and no mesh has both"

    def left_out(self, scene: Shaft) -> str:
        """Return the features that the plain part is without where it stands for a scene, in words;
        empty of a model that is made for features and of a scene that it holds for.
        """
        from solidgear.core.scene.shaft import feature_labels  # start-up: as above

        if self.for_features or self.can_model(scene):
            return ""
        return feature_labels(features_of(scene))

    def concerns(self, scene: Shaft) -> bool:
        """Return True where it is among the models solved for a scene when none is named."""
        sorts = {f.sort for f in features_of(scene)}
        return not self.for_features or not sorts.isdisjoint(self.holds)

    def given(self, scene: Shaft, options: Options) -> dict[str, Any]:
        """Return options for the builder of a scene: those asked for over those that features
        need.
        """
        return dict(options)

    def checked(self, options: Options) -> dict[str, Any]:
        """Return options for the builder within their limits; see
        :func:`solidgear.core.models.options.checked`.
        """
        return checked(self.name, options, self.options)

    def defaults(self) -> dict[str, Any]:
        """Return every option of the builder with its default."""
        from inspect import signature

        parameters = signature(self.builder()).parameters.values()
        defaults = {p.name: p.default for p in parameters if p.default is not p.empty}
        factoring = {k: v for k, v in asdict(Factoring()).items() if k in self.options}
        return defaults | dict(self.preset) | factoring

    def split(self, options: Options) -> tuple[dict[str, Any], Factoring]:
        """Return the options that the builder takes, and those of factoring."""
        builder_options = {k: v for k, v in options.items() if k not in FACTORING_OPTIONS}
        factoring = Factoring(**{k: v for k, v in options.items() if k in FACTORING_OPTIONS})
        in_core_double = factoring.precision == "double" and not factoring.out_of_core
        if factoring.engine != "own" and not in_core_double:
            raise SolidgearError(
                f"{self.name}: engine = {factoring.engine} factors in double precision and in memory; "
                "leave out precision and out_of_core"
            )
        return builder_options, factoring


class Ladder:
    """Models by name, cheapest first.

    Examples
    --------
    >>> from solidgear.core.ladder.registry import LADDER
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
        raise NoSuchName(unknown_model(name, self.names))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all models."""
        return tuple(m.name for m in self.models)

    @property
    def bodies(self) -> tuple[str, ...]:
        """Names of the models that build a body."""
        return tuple(m.name for m in self.models if m.family != LUMPED)

    def fit(self, scene: Shaft) -> tuple[str, ...]:
        """Return the models with a body, without those made for features that a scene does not
        have.
        """
        return tuple(n for n in self.bodies if self[n].concerns(scene))

    def holding(self, scene: Shaft) -> tuple[str, ...]:
        """Return the models with a body that model all of a scene."""
        return tuple(n for n in self.bodies if self[n].can_model(scene))

    @property
    def judges(self) -> tuple[str, ...]:
        """Models from best to worst judge: solids, the cheaper first, then beams, the better first."""
        return (*self.of(SOLID), *reversed(self.of(BEAM)))

    def of(self, *families: str) -> tuple[str, ...]:
        """Return the models of some families."""
        return tuple(m.name for m in self.models if m.family in families)


def unknown_model(name: str, names: tuple[str, ...]) -> str:
    """Return the reason why a name that is none of a model's is refused."""
    missing = absent("model", name)
    if missing:
        return f"model {name} {missing}"
    return f"model {show(name, 40)} is unknown{nearest(name, names)}; use one of {', '.join(names)}"
