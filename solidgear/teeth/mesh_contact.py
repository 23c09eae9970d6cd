r"""Contact of one mesh of a train over a mesh cycle, on its shafts, at an operating point.

**Askew.**  How far flanks open along the face before they touch, by the supports under the load that
the train at rest has, spread evenly along the face, of planets with the moment of their springs: at the
pitch line, as ``n . (u1 - u2)`` in the transverse plane.  From end to end of the face it is the
equivalent misalignment f_sh of ISO 6336-1, 7.5.2, as `deflect` has it with the face load factor that
follows, here with bending, tilting and the wind-up of both shafts within the face, which that of one
lumped point does not have.  Where teeth then carry, and how far they stay askew, is the contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import cos
from typing import Any, Self

import numpy as np

from solidgear.core.errors import SolidgearError
from solidgear.core.gears.flank_shape import shape_opening
from solidgear.core.gears.norm import NormStiffness, norm_stiffness
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.core.plain import plain
from solidgear.teeth.contact.cells import ToothedPair
from solidgear.teeth.contact.cycle import MeshCycle, mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.frame import Supports
from solidgear.trains.file.lengths import in_mm

#: orders of the transmission error that are listed
ORDERS = 5
#: normal modules that teeth may give way by: steel breaks at a thirtieth, soft plastics at a tenth;
#: pressure between hard rolling bodies that stay elastic, N/m^2 (ISO 76, roller bearings)
MOST_BENT, ELASTIC = 0.25, 4e9
#: rim that is worth a sentence, modules: one of four is 7 % softer than a solid wheel, by plane strain
THIN_RIM = 4.0
#: share of the load on corners that is worth a sentence; load of a slice that is none, of the mean;
#: face load factor from which an end that carries most is worth one
CORNER, IDLE, EDGE = 0.02, 1e-3, 1.2


@dataclass(frozen=True)
class Skew:
    """How far flanks open from one end of the face to the other in the transverse plane, m; positive
    towards larger y of the first wheel's scene, of planets and rings of the sun's.
    """

    bending: float  #: by bending and tilting of both shafts, with bearings and housing
    turning: float  #: by the wind-up of both bodies within the face
    shape: float  #: by the shapes of the flanks

    @property
    def total(self) -> float:
        """All of it, m."""
        return self.bending + self.turning + self.shape


@dataclass(frozen=True, eq=False)
class SolvedMesh:
    """The teeth of one mesh under one load, on their supports."""

    name: str
    supports: Supports
    cycle: MeshCycle
    assumed: tuple[str, ...]  #: what the file leaves open, sentences

    @cached_property
    def aligned(self) -> MeshCycle:
        """Cycle under the same torque, with wheels that are held as they lie without load."""
        cycle = self.cycle
        count = len(cycle.positions)
        return mesh_cycle(self.teeth, cycle.torque, cycle.base, cycle.slices, positions=count)

    @property
    def teeth(self) -> ToothedPair:
        """Both wheels as their contact needs them."""
        raise NotImplementedError

    @property
    def module(self) -> float:
        """Normal module, at the middle of the face, m."""
        raise NotImplementedError

    def within_reach(self) -> Self:
        """Return the same; refused for teeth that give way by so much that nothing here holds."""
        given = max(position.total / position.tangent for position in self.cycle.positions)
        if given > MOST_BENT * self.module:
            raise SolidgearError(
                f"teeth of the {self.name} would give way by {1e3 * given:.3g} mm under {self.cycle.force:.4g} "
                f"N, {given / self.module:.2g} of their module of {in_mm(self.module)}: no teeth do so "
                "and stay whole; correct torque, face width, module or bore"
            )
        return self

    @property
    def cautions(self) -> tuple[str, ...]:
        """Sentences on what the numbers leave out."""
        if self.cycle.pressure <= ELASTIC:
            return ()
        return (
            f"the largest pressure of the {self.name}, {self.cycle.pressure / 1e9:.2g} GPa, is above "
            f"{ELASTIC / 1e9:g} GPa, which no steel bears without lasting dents (ISO 76); the contact "
            "is computed as if it were elastic",
        )

    @property
    def status(self) -> str:
        """How the numbers came about, as in a file."""
        return "calculated"

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on numbers of the file that were not taken."""
        return ()

    @property
    def face_width(self) -> float:
        """Width of the face that both wheels share, m."""
        raise NotImplementedError

    @property
    def height(self) -> str:
        """What places of cells up the tooth are, in words."""
        raise NotImplementedError

    @property
    def path_ends(self) -> tuple[float, ...]:
        """Places beyond which corners of tips touch, m; none where cells have no such places."""
        return ()

    @property
    def edge(self) -> str:
        """Where contact leaves the flank: a sentence, or nothing."""
        raise NotImplementedError

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        cycle = self.cycle
        orders = cycle.orders(ORDERS)
        return plain(
            {
                "mesh": self.name,
                "status": self.status,
                "torque": cycle.torque,
                "force": cycle.force,
                "transmission_error": {
                    "phase": cycle.phases,
                    "loaded": cycle.error,
                    "unloaded": cycle.free_error,
                    "peak_to_peak": cycle.peak_to_peak,
                    "orders": np.abs(orders),
                    "angles": np.angle(orders),
                },
                "stiffness": {
                    "secant": cycle.secant,
                    "tangent": cycle.tangent,
                    "secant_with_supports": cycle.supported_secant,
                    "tangent_with_supports": cycle.supported_tangent,
                    "aligned_tangent": self.aligned.tangent,
                },
                "face_load_factor": cycle.face_load_factor,
                "line_load_factor": cycle.line_load_factor,
                "face_load": cycle.face_loads / (self.face_width / cycle.slices),
                "pressure": cycle.pressure,
                "load_share": cycle.load_share,
                "mean_lines": cycle.mean_lines,
                "corner_share": cycle.corner_share,
                "mesh_point": cycle.points,
                "line_of_action": cycle.lines_of_action,
                "assumed": self.assumed,
            }
        )


@dataclass(frozen=True, eq=False)
class MeshContact(SolvedMesh):
    """The teeth of two cylindrical wheels under one load.

    Stiffnesses are along the line of action; those of the norm, c, are converted by the face width and
    ``cos^2 beta_b``, for they count the transverse error under the transverse force.
    """

    pair: CylindricalPair
    along: int  #: 1 where face places grow along y of the first wheel's scene, else -1
    #: of both wheels from the bore to the roots, modules; None of solid ones and rings
    rims: tuple[float | None, float | None]

    @property
    def teeth(self) -> ToothedPair:
        """Both wheels as their contact needs them."""
        return self.pair

    @property
    def face_width(self) -> float:
        """Width of the face that both wheels share, m."""
        return self.wheels.face_width

    @property
    def height(self) -> str:
        """What places of cells up the tooth are, in words."""
        return "along the path of contact"

    @property
    def path_ends(self) -> tuple[float, ...]:
        """Both ends of the path of contact, m."""
        return self.wheels.ends

    @property
    def wheels(self) -> WheelPair:
        """Geometry of both wheels."""
        return self.pair.wheels

    @property
    def module(self) -> float:
        """Normal module, m."""
        return self.wheels.first.module

    @property
    def cautions(self) -> tuple[str, ...]:
        """Sentences on what the numbers leave out."""
        thin = [rim for rim in self.rims if rim is not None and rim < THIN_RIM]
        if not thin:
            return super().cautions
        return (
            *super().cautions,
            f"{self.name}: a rim of {min(thin):.2g} modules below the roots softens the teeth; it is taken "
            "as free at its bore, with nothing beside the face. What stands beside it makes the teeth "
            "stiffer, at most as stiff as on a solid wheel: the error bar holds that",
        )

    @property
    def line_load(self) -> float:
        """Transverse force per face width, N/m."""
        transverse = self.cycle.force * cos(self.wheels.base_helix)
        return transverse / self.wheels.face_width

    @cached_property
    def norm(self) -> NormStiffness:
        """Stiffnesses by ISO 6336-1."""
        first, second = (material.youngs for material in self.pair.law.materials)
        return norm_stiffness(self.wheels, self.line_load, (first, second))

    def along_line(self, specific: float) -> float:
        """Return the stiffness along the line of action, N/m, of a specific one, N/m per m."""
        return specific * self.wheels.face_width / cos(self.wheels.base_helix) ** 2

    @cached_property
    def skew(self) -> Skew:
        """How the flanks lie askew under the load of the train at rest."""
        supports, face = self.supports, self.wheels.face_width
        points = np.column_stack([np.zeros((2, 2)), [-face / 2, face / 2]])
        normals = np.tile(self.cycle.positions[0].cells.normal[0], (2, 1))
        first, last = supports.opening(points, normals)
        across = self.along * (last - first) / cos(self.wheels.base_helix)
        motion = supports.motion + supports.compliance @ supports.spread
        turning = float(across @ supports.turning @ motion)
        shape = self.along * shape_opening(self.wheels, self.pair.shapes)
        return Skew(float(across @ motion) - turning, turning, shape)

    @property
    def edge(self) -> str:
        """Where contact leaves the flank: a sentence, or nothing."""
        cycle, parts = self.cycle, []
        if cycle.corner_share > CORNER:
            parts.append(
                f"corners of tips carry up to {100 * cycle.corner_share:.0f} % of the load: tip "
                "relief would take it off them"
            )
        loads = cycle.face_loads
        if min(loads[0], loads[-1]) <= IDLE * loads.mean():
            carrying = float(np.mean(loads > IDLE * loads.mean()))
            parts.append(f"only {100 * carrying:.0f} % of the face carries load")
        if max(loads[0], loads[-1]) == loads.max() and self.cycle.face_load_factor > EDGE:
            parts.append("the load is largest at an end of the face")
        return "; ".join(parts)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data in SI for JSON."""
        skew = self.skew
        data = super().as_dict()
        data |= plain(
            {
                "contact_ratio": self.wheels.contact_ratio,
                "overlap_ratio": self.wheels.overlap_ratio,
                "skew": {
                    "bending": skew.bending,
                    "turning": skew.turning,
                    "shape": skew.shape,
                    "total": skew.total,
                },
            }
        )
        data["stiffness"] |= plain(
            {
                "norm_single": self.along_line(self.norm.single),
                "norm_mesh": self.along_line(self.norm.mesh),
            }
        )
        return data
