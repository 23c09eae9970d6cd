"""Wheels of a mesh from the numbers of a train file, with what is assumed where it gives none.

A pair of wheels has face places z in the direction in which a contact line lies nearer to the tips of
the first wheel (:mod:`solidgear.core.gears.wheel_pair`).  On a right flank it does so where the tooth
is turned clockwise, seen from the start of the shaft; right-handed teeth turn clockwise towards the
end, so that z runs to the end where hand and loaded flank have one name, else to the start.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, cos, degrees, radians

from solidgear.core.gears.flank_shape import FlankShape, Relief
from solidgear.core.gears.norm import STEEL
from solidgear.core.gears.wheel import Rack, Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.trains.file.cylindrical import first_given
from solidgear.trains.file.flanks import Flanks, RackTable, ReliefTable, roll_length
from solidgear.trains.file.gears import FLANKS, Gear, Member
from solidgear.trains.file.lengths import in_mm
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh

#: pressure angle of the basic rack (ISO 53), rad
USUAL_PRESSURE_ANGLE = radians(20)


@dataclass(frozen=True)
class MeshTeeth:
    """Two cylindrical wheels of a train that mesh."""

    wheels: WheelPair
    shapes: tuple[FlankShape, FlankShape]  #: their face places count from the shared middle
    #: by wheel: 1 where face places grow along y of the scene of its shaft, else -1; of planets and
    #: rings the scene of the sun
    along: tuple[int, int]
    #: middle of the shared face from each lumped point, along y of the scene, m
    middles: tuple[float, float]
    assumed: tuple[str, ...]  #: sentences on what the file leaves open

    @property
    def is_involute(self) -> bool:
        """True where neither wheel has modified flanks."""
        return all(shape.is_involute for shape in self.shapes)


@dataclass(frozen=True)
class _Numbers:
    """One wheel as the file gives it."""

    name: str  #: in words
    teeth: int  #: of a ring below zero
    shift: float
    face_width: float | None
    flanks: Flanks


def wheels_of(mesh: Pair | PlanetMesh, coast: bool | None = None) -> MeshTeeth | None:
    """Return the wheels of two cylindrical gears, or of planets with sun or ring (the first is never
    the ring); None for bevel gears, and where neither module nor pitch radius nor centre distance is
    given.

    Parameters
    ----------
    mesh : Pair or PlanetMesh
    coast : bool, optional
        True for the flank that the file does not name, and for a sun that drives about -y of its
        scene; by default that of the operating point.

    Raises
    ------
    SceneError
        As :class:`solidgear.core.gears.wheel_pair.WheelPair`.

    Examples
    --------
    >>> import solidgear as sg
    >>> teeth = wheels_of(sg.load_train("geometry/gearbox_train.toml").pairs[0])
    >>> round(teeth.wheels.contact_ratio, 3), teeth.assumed[0]
    (1.589, 'normal module 2.89778 mm, from pitch radius and helix angle')
    """
    if isinstance(mesh, PlanetMesh):
        return _of_planets(mesh, bool(coast))
    return _of_pair(mesh, coast)


def gears_of(mesh: Pair | PlanetMesh) -> tuple[Member | None, Member | None]:
    """Return the gears of a mesh on their shafts, the first first; None for planets and rings, which are
    bodies of the train.
    """
    if isinstance(mesh, Pair):
        return mesh.pinion, mesh.gear
    return (mesh.stage.sun if mesh.mate == "sun" else None), None


def elasticity_of(gear: Member) -> tuple[float, float]:
    """Return modulus of elasticity, N/m^2, and Poisson's ratio of a gear: those of its shaft where it
    sits.
    """
    segments = gear.scene.segments_at(gear.scene.port.y)
    material = segments[0].material if segments else gear.scene.material
    return material.E, material.nu


def moduli_of(mesh: Pair | PlanetMesh) -> tuple[float, float]:
    """Return the moduli of elasticity of both wheels, N/m^2; planets and rings are of steel."""
    first, second = (STEEL if gear is None else elasticity_of(gear)[0] for gear in gears_of(mesh))
    return first, second


def _of_pair(pair: Pair, coast: bool | None) -> MeshTeeth | None:
    pinion, gear, mesh = pair.pinion, pair.gear, pair.mesh
    if mesh.shaft_angle:
        return None
    helix = first_given(
        pinion.helix_angle, gear.helix_angle, pinion.spiral_angle, gear.spiral_angle
    )
    helix = helix or 0.0
    assumed = []
    distance, module = mesh.centre_distance, first_given(pinion.module, gear.module)
    if module is None:
        radius = pinion.pitch_radius or (gear.pitch_radius or 0.0) / pair.ratio
        radius = radius or (distance or 0.0) / (1 + pair.ratio)
        if not radius:
            return None
        module = 2 * radius * cos(helix) / pinion.teeth
        source = "pitch radius" if pinion.pitch_radius or gear.pitch_radius else "centre distance"
        assumed.append(f"normal module {in_mm(module)}, from {source} and helix angle")
    pressure = mesh.pressure_angle
    if pressure is None:
        pressure = USUAL_PRESSURE_ANGLE
        assumed.append(f"pressure angle {degrees(pressure):g} deg, of the basic rack of ISO 53")
    numbers = [
        _Numbers(side, wheel.teeth, wheel.profile_shift, wheel.face_width, wheel)
        for side, wheel in zip(pair.shafts, (pinion, gear))
    ]
    ends = [1 if wheel.apex == "start" else -1 for wheel in (pinion, gear)]
    if coast is None:
        coast = pair.point is not None and pair.point.coast
    way = _way(helix, _hand(pinion, gear), pinion.flank or FLANKS[0], coast)
    between = 0.0 if mesh.gear_position is None else mesh.gear_position[1]
    offsets = [end * wheel.face_offset for end, wheel in zip(ends, (pinion, gear))]
    wheels, more = _wheels(numbers, module, helix, pressure)
    pair_wheels = WheelPair(
        *wheels, centre_distance=distance, offset=way * (between + offsets[1] - offsets[0])
    )
    along = way * ends[0], way * ends[1]
    return _mesh_teeth(pair_wheels, numbers, along, (*assumed, *more))


def _of_planets(mesh: PlanetMesh, coast: bool) -> MeshTeeth:
    stage, table = mesh.stage, mesh.stage.table
    sun, helix = stage.sun, stage.sun.helix_angle or 0.0
    assert sun.module is not None  # a stage is refused without
    face = sun.face_width
    planets = _Numbers("planets", table.planet.teeth, 0.0, face, table.planet)
    numbers = [_Numbers("sun", sun.teeth, 0.0, face, sun), planets]
    if mesh.mate == "ring":
        flanks = table.ring_flanks or Flanks()
        numbers = [planets, _Numbers("ring", -table.ring_teeth, 0.0, face, flanks)]
    # a sun that drives about +y pushes with its right flanks, and planets the ring with left ones
    way = _way(helix, sun.hand, FLANKS[1], coast)
    wheels, assumed = _wheels(numbers, sun.module, helix, table.mesh.pressure_angle)
    if mesh.mate == "ring" and numbers[1].flanks.tip_diameter is None:
        # no rack cuts a ring, and fillets of planets may end the path before such tips do
        assumed = (*assumed, f"tip diameter of the ring {in_mm(2 * wheels[1].tip)}")
    first, second = (wheel.flanks.face_offset for wheel in numbers)
    pair_wheels = WheelPair(*wheels, offset=way * (second - first))
    return _mesh_teeth(pair_wheels, numbers, (way, way), assumed)


def _hand(pinion: Gear, gear: Gear) -> str | None:
    """Return the hand of the first of two gears, which the other's says as well."""
    if pinion.hand is None and gear.hand is not None:
        return FLANKS[gear.hand == "left"]
    return pinion.hand


def _way(helix: float, hand: str | None, flank: str, coast: bool) -> int:
    """Return 1 where face places run to the end of the shaft, seen from the apex, else -1."""
    if not helix or hand is None:
        return 1
    return 1 if (hand == flank) != coast else -1


def _wheels(
    numbers: list[_Numbers], module: float, helix: float, pressure: float
) -> tuple[tuple[Wheel, Wheel], tuple[str, ...]]:
    """Return both wheels, and sentences on what is assumed."""
    widths = [wheel.face_width for wheel in numbers]
    faces = widths[0] or widths[1] or 0.0, widths[1] or widths[0] or 0.0
    wheels, assumed = [], []
    for wheel, width in zip(numbers, faces):
        rack = (wheel.flanks.rack or RackTable()).with_angle(pressure)
        tip = wheel.flanks.tip_diameter
        tip_radius = None if tip is None else tip / 2
        wheels.append(Wheel(wheel.teeth, module, helix, wheel.shift, rack, tip_radius, width))
        if wheel.face_width is None and width:
            assumed.append(f"face width of the {wheel.name} {in_mm(width)}, that of its mate")
    plain = [wheel.name for wheel in numbers if wheel.flanks.rack is None]
    if plain:
        rack = Rack()
        numbers_of_rack = f"{rack.addendum:g}, {rack.dedendum:g}, {rack.root_radius:g}"
        assumed.append(f"rack of the {_both(plain)} as ISO 53 A ({numbers_of_rack} modules)")
    exact = [wheel.name for wheel in numbers if not wheel.flanks.is_modified]
    if exact:
        assumed.append(f"flanks of the {_both(exact)} without modification")
    return (wheels[0], wheels[1]), tuple(assumed)


def _mesh_teeth(
    wheels: WheelPair, numbers: list[_Numbers], along: tuple[int, int], assumed: tuple[str, ...]
) -> MeshTeeth:
    """Return both wheels with the shapes of their flanks."""
    shapes, middles = [], []
    for k, (wheel, middle) in enumerate(zip(numbers, wheels.face_middles)):
        flanks, solid = wheel.flanks, (wheels.first, wheels.second)[k]
        tip, root = reliefs(wheels, k, flanks.relief)
        measured = flanks.measured_flank
        grid = None if measured is None else measured.grid(solid.base)
        shapes.append(
            FlankShape(
                base_helix=wheels.base_helix,
                face_width=solid.face_width,
                middle=middle,
                tip=tip,
                root=root,
                crowning=flanks.crowning,
                slope=along[k] * flanks.helix_slope,
                grid=grid if grid is None or along[k] > 0 else grid.reversed(),
            )
        )
        middles.append(flanks.face_offset - along[k] * middle)
    return MeshTeeth(wheels, (shapes[0], shapes[1]), along, (middles[0], middles[1]), assumed)


def reliefs(
    wheels: WheelPair, k: int, table: ReliefTable | None
) -> tuple[Relief | None, Relief | None]:
    """Return the relief of tip and root of the first or the second wheel."""
    if table is None:
        return None, None
    wheel = (wheels.first, wheels.second)[k]
    tip_start, root_start = _single_contact(wheels, k)
    if table.from_ is not None:
        tip_start = roll_length(table.from_ / 2, wheel.base)
    if table.root_from is not None:
        root_start = roll_length(table.root_from / 2, wheel.base)
    tip = Relief(table.tip, tip_start, roll_length(wheel.tip, wheel.base))
    root = Relief(table.root, root_start, roll_length(wheel.form, wheel.base))
    return tip if table.tip else None, root if table.root else None


def _single_contact(wheels: WheelPair, k: int) -> tuple[float, float]:
    """Return the roll lengths between which the fewest pairs of teeth carry, at the tip's side and
    at the root's: the long relief begins there.
    """
    (start, stop), ratio = wheels.ends, wheels.contact_ratio
    overlap = (ratio - max(ceil(ratio) - 1, 0)) * wheels.pitch
    if k == 0:
        return stop - overlap, start + overlap
    return (
        float(wheels.second_length(start + overlap)),
        float(wheels.second_length(stop - overlap)),
    )


def _both(names: list[str]) -> str:
    return " and the ".join(names)
