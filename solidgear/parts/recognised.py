"""A part from a file and the body of revolution inside it, as far as a scene needs them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from solidgear.core import SceneError, listed
from solidgear.core.scene.parts import Material, Segment
from solidgear.core.scene.places import Seat
from solidgear.parts.body_file import BodyFile

if TYPE_CHECKING:
    from solidgear.core.scene.places import Places

#: least share of the cylinder of a seat, and the share below which a remark gives it: chords of
#: eight to a turn lack 2.6 %
LEAST_SEAT, WHOLE_SEAT = 0.5, 0.97
#: share of the cylinder of a seat that faces have by chance, where the section is not round at all
NO_SEAT = 0.01
#: relative difference of the mass of a part from mass_check
MASS_CHECK = 1e-2
#: relative difference of diameters that are one
SAME_DIAMETER = 1e-3


def mean_material(materials: Sequence[Material], shares: Sequence[tuple[int, float]]) -> Material:
    """Return one material for several side by side, given by place and share of the volume, which is
    as stiff as they are stretched together, and as heavy.

    Examples
    --------
    >>> steel = Material(E=200e9, nu=0.3, density=8000)
    >>> light = Material(E=100e9, nu=0.3, density=2000)
    >>> mean = mean_material([steel, light], [(0, 0.25), (1, 0.75)])
    >>> mean.E, mean.density
    (125000000000.0, 3500.0)
    """
    if len(shares) == 1:
        return materials[shares[0][0]]
    parts = [(materials[place], share) for place, share in shares]
    modulus = sum(share * m.E for m, share in parts)
    return Material(
        E=modulus,
        nu=sum(share * m.E * m.nu for m, share in parts) / modulus,
        density=sum(share * m.density for m, share in parts),
    )


class Recognised(NamedTuple):
    """A part and the body of revolution inside it."""

    body: BodyFile
    walls: tuple[tuple[float, ...], ...]  #: frusta end to end from y = 0, m
    origin: float  #: where the origin of the body lies, m from the lower end
    cylinders: tuple[tuple[float, float, float], ...]  #: of its surface, m
    #: ``seat_share(radius, lo, hi)``: area of the surface that lies on a cylinder between two
    #: places, over that of the cylinder
    seat_share: Callable[[float, float, float], float]
    #: of each frustum: groups of the body and their shares; empty for a body without groups
    shares: tuple[tuple[tuple[int, float], ...], ...] = ()

    def segments(self, material: Material) -> list[Segment]:
        """Return the frusta, named s1, s2 and so on, in a scene of some material."""
        names = ("y0", "y1", "outer0", "outer1", "inner0", "inner1")
        materials = self.body.materials(material)
        shares = self.shares or [((0, 1.0),)] * len(self.walls)
        return [
            Segment(
                name=f"s{k}",
                material=mean_material(materials, share),
                **dict(zip(names, wall)),
            )
            for k, (wall, share) in enumerate(zip(self.walls, shares), 1)
        ]

    def lay_out(self, usual: Material, places: Places) -> list[Segment]:
        """Return the frusta, and enter their datums in the places of a file."""
        segments = self.segments(usual)
        places.datums |= {"start": 0.0, "end": segments[-1].y1, "origin": self.origin}
        for s in segments:
            middle = (s.y0 + s.y1) / 2
            places.datums |= {f"{s.name}.start": s.y0, f"{s.name}.end": s.y1}
            places.datums[f"{s.name}.middle"] = middle
            places.surface[s.name] = (s.y0, s.y1)
        return segments

    def usual_material(self) -> Material:
        """Return a material for a scene without one, where all groups have one."""
        groups = [g for g in self.body.groups if g.material is None]
        if groups:
            raise SceneError(
                f"{groups[0].label}, {1e6 * groups[0].volume:.4g} cm^3, has no material: name its groups "
                "here, or write [material] for all the rest",
                path=("body", "materials"),
            )
        return next(g.material for g in self.body.groups if g.material is not None)

    def check_mass(self, expected: float | None, usual: Material) -> None:
        """Refuse a part that does not have the expected mass, kg."""
        mass = self.body.mass(usual)
        if expected is not None and abs(mass / expected - 1) > MASS_CHECK:
            raise SceneError(
                f"the part has {mass:.5g} kg ({1e6 * self.body.volume:.5g} cm^3 of "
                f"{mass / self.body.volume:.5g} kg/m^3), {100 * (mass / expected - 1):+.3g} % from that",
                path=("body", "mass_check"),
            )

    def span(self, seat: Seat) -> tuple[float, float]:
        """Return the ends of a seat, m from the lower end; refuse a cylinder that is not half there."""
        lo, hi = seat.from_ + self.origin, seat.to + self.origin
        near = [c for c in self.cylinders if abs(c[0] / seat.diameter - 1) <= SAME_DIAMETER]
        if not near:
            diameters = listed(
                f"{1e3 * d:.6g} mm" for d in sorted({round(c[0], 7) for c in self.cylinders})
            )
            raise SceneError(
                "the part has no cylinder of this diameter about its axis; it has "
                f"{diameters or 'none'}",
                path=("diameter",),
            )
        share = self.seat_share(near[0][0] / 2, lo, hi)
        if share < LEAST_SEAT:
            raise SceneError(
                f"only {100 * share:.0f} % of this cylinder is there, at least "
                f"{100 * LEAST_SEAT:.0f} % is wanted; cylinders of this diameter reach from "
                + ", ".join(
                    f"{1e3 * (a - self.origin):.6g} to {1e3 * (b - self.origin):.6g} mm"
                    for _, a, b in near
                ),
                path=("from",),
            )
        return lo, hi


def with_seats(part: Recognised, stations: Iterable, segments: Sequence[Segment]) -> BodyFile:
    """Return a part with remarks on seats that are not whole."""
    if part.body.edges is not None:
        return part.body
    remarks = []
    for s in stations:
        carriers = [g for g in segments if g.y1 > s.lo and g.y0 < s.hi]
        radii = {r for g in carriers for r in (g.outer0, g.outer1)}
        if s.attachment == "section" or len(radii) != 1 or not s.hi > s.lo:
            continue
        radius = radii.pop()
        share = part.seat_share(radius, s.lo, s.hi)
        if share < NO_SEAT:
            raise SceneError(
                f"the seat of {s.name!r}, from {1e3 * s.lo:.6g} to {1e3 * s.hi:.6g} mm, lies where no "
                f"face of the part is round about its axis (mean diameter {2e3 * radius:.6g} mm): "
                "move it to a cylinder of the part"
            )
        if share < WHOLE_SEAT:
            remarks.append(
                f"the seat of {s.name!r} has {100 * share:.3g} % of its cylinder's area 2 pi r b; "
                "its motion is the mean over that part"
            )
    return part.body.model_copy(update={"remarks": (*part.body.remarks, *remarks)})
