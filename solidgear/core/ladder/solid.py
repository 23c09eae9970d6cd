"""The 3D solid, of hexahedra or tetrahedra, coarse to fine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from solidgear.core.elements import ELEMENTS
from solidgear.core.ladder.meshes import FREE, Sequence, levels
from solidgear.core.ladder.model import SOLID, Model, Options, Series, features_of
from solidgear.core.models.kinds import BODIES, CUTS, CYCLIC, PARTS
from solidgear.core.models.options import SOLID_OPTIONS
from solidgear.core.registry import addition

if TYPE_CHECKING:
    from solidgear.core.body import Body
    from solidgear.core.models.size import Size
    from solidgear.core.scene.shaft import Shaft


#: unknowns of a tetrahedron of second order, most of which it shares
PER_TETRAHEDRON = 4.0


class Volume(Model):
    """A model on a 3D mesh: without section ties, the volume off by arcs between nodes."""

    family = SOLID
    bars_by = "one order more"
    section_ties = False
    mass_tolerance = 1e-3

    def wanted(self, scene: Any, options: Options) -> list[tuple[Any, str]]:
        """Return the stations with their attachments."""
        from solidgear.core.scene.shaft import attached_stations

        return [*attached_stations(scene.stations, options["attachments"])]

    def limits(self, scene: Any) -> str:
        """Return the reason why the features of a scene have no sector that can be meshed; empty if
        they have.
        """
        return addition("question of features", "no sector")(scene)


Level = dict[str, Any]


def _hexahedra(layers: int, edge_layers: int, relative_size: float) -> Level:
    return {
        "layers": layers,
        "radial_layers": layers,
        "edge_layers": edge_layers,
        "relative_size": relative_size,
    }


# layers at the edges of seats tell from the third mesh on: before, shoulders decide
HEXAHEDRA: tuple[Level, ...] = (
    _hexahedra(0, 0, 1.5),
    _hexahedra(1, 0, 1.0),
    _hexahedra(2, 2, 0.7),
    _hexahedra(3, 3, 0.5),
    _hexahedra(4, 4, 0.35),
)
#: refinements of tetrahedra with their layers
_TETRAHEDRA = ((0.45, 1), (0.65, 2), (0.95, 2), (1.4, 3), (2.0, 3))
TETRAHEDRA: tuple[Level, ...] = tuple({"refinement": r, "layers": k} for r, k in _TETRAHEDRA)
LINEAR: tuple[Level, ...] = tuple({"refinement": r} for r in (0.6, 0.9, 1.35, 2.0))
#: cells around of hexahedra that bend as a whole: eight are good to some 6e-4, and the error falls
#: with the fourth power
AROUND = 8


class _Steps(NamedTuple):
    """Refinements of a quick chart, and further ones of a full chart."""

    quick: tuple[float, ...]
    more: tuple[float, ...]


#: refinements of uniform and of graded meshes, by element
_CHARTED = {
    "tet4": (_Steps((1.0, 1.8, 2.6), (3.4, 4.4)), _Steps((0.5, 0.8, 1.25), (1.8, 2.4))),
    "tet10": (_Steps((0.7, 1.3, 1.8), (2.4, 3.0)), _Steps((0.4, 0.6, 0.9), (1.2, 1.6))),
    "hex8": (_Steps((1.0, 1.5, 2.2), (3.0, 3.8)), _Steps((0.65, 1.0, 1.5), (2.0, 2.6))),
    "hex20": (_Steps((0.5, 1.0, 1.5), (2.0, 2.8)), _Steps((0.35, 0.65, 1.0), (1.4, 1.9))),
    "hex27": (_Steps((0.5, 1.0, 1.3), (1.6, 2.2)), _Steps((0.35, 0.65, 0.85), (1.0, 1.4))),
}


class Solid(Volume):
    """Full 3D elasticity on one mesh."""

    name = "solid"
    title = heading = "3D solid"
    theory = "full 3D elasticity"
    colour = "#5a3e8c"
    marker = "D"
    options = SOLID_OPTIONS
    coarser = "lower refinement or the layers, or raise size"
    holds = (CUTS, CYCLIC, PARTS, BODIES)
    together = frozenset((CUTS, CYCLIC))
    _nature = "one mesh of tetrahedra,"

    def builder(self) -> Callable[..., Body]:
        from solidgear.core.models.solid.body import solid

        return solid

    def _size(self, scene: Shaft, options: dict[str, Any]) -> Size:
        from solidgear.core.models.solid.size import solid_size

        return solid_size(scene, **self.split(options)[0])

    def rough_unknowns(self, scene: Shaft, options: Options) -> float:
        """Estimate the unknowns of tetrahedra."""
        from solidgear.core.models.solid.body import layers_of
        from solidgear.core.models.solid.plan import tetrahedra_of, tetrahedra_plan

        full_options = self.defaults() | self.given(scene, options)
        if not full_options["element"].startswith("tet"):
            return 0.0
        sizes = {n: full_options[n] for n in ("size", "graded_size", "refinement", "around")}
        plan = tetrahedra_plan(scene, self.wanted(scene, full_options), **sizes)
        layers = layers_of(full_options["element"], full_options["layers"])
        return PER_TETRAHEDRON * tetrahedra_of(
            scene, plan, full_options["refinement"], layers=layers
        )

    def can_halve(self, scene: Shaft, options: Options) -> bool:
        """Return True where all cuts of a shaft have one mirror plane."""
        mirror_plane = addition("question of features", "mirror plane")
        cuts = features_of(scene)
        return bool(cuts) and all(f.sort == CUTS for f in cuts) and mirror_plane(cuts) is not None

    def concerns(self, scene: Shaft) -> bool:
        """Return False where the mesh would be copies of a sector: that is no second opinion, and
        solved only when named.
        """
        return {CYCLIC} != {f.sort for f in features_of(scene)}

    def limits(self, scene: Shaft) -> str:
        """Return the reason why features of a scene have no sector, or cannot be cut beside each
        other; empty if they can.
        """
        if CUTS not in {f.sort for f in features_of(scene)}:
            return super().limits(scene)
        return addition("question of features", "not together")(scene)

    def given(self, scene: Shaft, options: Options) -> dict[str, Any]:
        """Return options with tetrahedra for features, fillets, chamfers or a part from a file,
        beside which layered hexahedra converge too slowly for error bars; and hexahedra for a
        block.
        """
        features = features_of(scene)
        if "block" in {getattr(f, "kind", "") for f in features}:
            return {"element": "hex27", **options}
        if features or scene.outline.corners:
            return {"element": "tet10", **options}
        return dict(options)

    def meshes_of(self, scene: Shaft, options: Options) -> Sequence:
        """Return the meshes of files, or the usual list."""
        full_options = {**self.preset, **self.given(scene, options)}
        body = getattr(scene, "body", None)
        if body is not None and body.one_mesh:
            files = range(len(body.coarser), -1, -1)
            return Sequence(tuple({**full_options, "coarser": k} for k in files), False)
        sequence = self.meshes(full_options)
        if body is not None and body.kind == "step" and not sequence.fixed:
            # layers double or treble the unknowns of edges that are many, for a bar narrower by a third
            first = _without_layers(sequence.levels[0])
            sequence = replace(sequence, levels=(first, *sequence.levels))
        if full_options.get("element") != "tet10" or _has_lines(scene, full_options):
            return sequence
        return replace(sequence, levels=tuple(_without_layers(k) for k in sequence.levels))

    def meshes(self, options: Options) -> Sequence:
        """Return meshes with ever more layers towards corners, tetrahedra that are smaller too, or
        plain refinement of linear ones.
        """
        if set(options) - set(FREE):
            return Sequence((dict(options),), True)
        element = self.checked({"element": options.get("element", "hex20")})["element"]
        second = ELEMENTS[element].order == 2
        if second and element.startswith("hex"):
            around = {"around": AROUND, **options}
            return Sequence(tuple({**level, **around} for level in HEXAHEDRA), False)
        tetrahedra = TETRAHEDRA if second else LINEAR
        return Sequence(tuple({**level, **options} for level in tetrahedra), False)

    def series(self, scene: Shaft, full: bool) -> list[Series]:
        """Return every element type, on uniform and on graded meshes."""
        from solidgear.core.models.solid.plan import usual_size

        size = usual_size(scene)
        even_tetrahedra = {"size": size, "graded_size": size}
        even_hexahedra = {
            "layers": 0,
            "edge_layers": 0,
            "size": 0.6 * scene.outline.least_radius,
            "radial_layers": 0,
        }
        return [
            *_elements("tetrahedra", "uniform", even_tetrahedra, full),
            *_elements("tetrahedra", "graded", {}, full),
            *_elements("hexahedra", "uniform", even_hexahedra, full),
            *_elements("hexahedra", "graded", {}, full),
        ]


def _has_lines(scene: Any, options: Options) -> bool:
    """Return whether a mesh of tetrahedra has lines that layers are made towards."""
    from solidgear.core.bounds.singular_places import sharpest_exponent
    from solidgear.core.meshing.corners import SLOW
    from solidgear.core.scene.shaft import without_axis

    # of a sector that repeats, edges are meshed by themselves
    if without_axis(scene) or CYCLIC in {f.sort for f in features_of(scene)}:
        return False
    ties = options.get("attachments") or ()
    rigid = [s.name for s in scene.stations if "rigid" in (*ties, s.attachment)]
    return sharpest_exponent(scene, rigid) < SLOW


def _without_layers(level: Options) -> Level:
    return {name: value for name, value in level.items() if name != "layers"}


def _elements(family: str, grading: str, extra: dict, full: bool) -> list[Series]:
    out = []
    for element, (uniform, graded) in _CHARTED.items():
        if not element.startswith(family[:3]):
            continue
        refinements = levels(*(uniform if grading == "uniform" else graded), full)
        options = [{"element": element, **extra, "refinement": s} for s in refinements]
        out.append((family, f"{element.upper()} {grading}", options))
    return out
