"""Contact of two teeth by CalculiX, against finite elements that are read at a depth and a local law.

    python -m validation.tooth_contact [--helix 0 15]

One pitch of each wheel, with free sides, holding at a cylinder four modules below the roots; the first
wheel's cylinder is turned by the arc of 60 um on its base cylinder.  CalculiX has C3D20R elements that
are fine on the flanks, and contact from surface to surface; ours have the usual mesh, cells on the
contact line, and the local law between.  What is compared is the torque.  Rows go to
validation/results/tooth_contact.json; a minute or two of processor time each.
"""

from __future__ import annotations

import argparse
import re
import shutil
import tempfile
from dataclasses import dataclass
from math import radians
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from solidgear.core.elements import ELEMENTS
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.show.outputs import node_order
from solidgear.teeth.compliance.mesh import Fineness
from solidgear.teeth.compliance.solid import SolidTeeth
from solidgear.teeth.compliance.solid_mesh import SweptPitch, turned
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.local import Elasticity, LineContact
from solidgear.teeth.contact.solver import Loads, loads
from validation.common import kept
from validation.race.calculix import _nodes, _wrapped, execute

MODULE, FACE = 4e-3, 4e-3
#: rim below the roots, modules
RIM = 4.0
#: arc of the first wheel on its base cylinder, m: CalculiX takes the second flank as flat triangles,
#: which stand back from it by up to 0.2 um
ARC = 60e-6
#: pressure by overlap of CalculiX's surfaces, N/m^3: they overlap by 0.02 um
SLOPE = 3e16
STEEL = Elasticity()
#: mesh of CalculiX, in which the half-width of contact is more than a cell, and ours.  Rims are fine:
#: a single pitch is a column that bends, singular in the corners at its foot
FINE, USUAL = Fineness(fillet=4, flank=70, across=10, rim=2.5), Fineness(4, 8, 6, rim=3.0)
LAYERS = 2
#: thickness of our layers, modules
LAYER = 0.25
#: faces of CalculiX's hexahedra by their corners, in its numbering
FACES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5), (1, 2, 5, 6), (2, 3, 6, 7), (0, 3, 4, 7))


@dataclass(frozen=True)
class OnePitch(SolidTeeth):
    """A pitch whose sides are free, with the motion of its rim."""

    def without_rim(self, tooth: int) -> np.ndarray:
        pitch = self.pitch()
        places = slice(-6)
        if tooth != 0:
            return np.zeros_like(pitch.direct[places, places])
        moved = np.linalg.solve(pitch.stiffness, pitch.loads[:, places])
        return pitch.direct[places, places] + pitch.readings[places] @ moved


def pair_of(helix: float) -> WheelPair:
    """Return 23 and 57 teeth of 4 mm with a helix angle, rad."""
    first, second = (Wheel(teeth, MODULE, helix, face_width=FACE) for teeth in (23, 57))
    return WheelPair(first, second)


def condensed_contact(pair: WheelPair) -> Loads:
    """Return the loads under which the first wheel turns by the arc."""
    wheels = pair.first, pair.second
    teeth = [
        OnePitch(
            wheel,
            hold=wheel.root - RIM * MODULE,
            elasticity=STEEL,
            hand=hand,
            fineness=USUAL,
            layer=LAYER,
        )
        for wheel, hand in zip(wheels, (1, -1))
    ]
    law = LineContact(tuple(t.elasticity for t in teeth), tuple(t.depth for t in teeth))
    slices = teeth[0].slices
    contact = CylindricalPair(pair, tuple(teeth), law, slices=slices, beyond=0.0)

    def excess(torque: float) -> float:
        return loads(contact, torque, 0.0).rotation * pair.first.base - ARC

    return loads(contact, brentq(excess, 0.1, 1e4, rtol=1e-6), 0.0)


def calculix(pair: WheelPair) -> float:
    """Return the torque on the first wheel by CalculiX, N m."""
    parts = parts_of(pair)
    with tempfile.TemporaryDirectory(prefix="ccx-") as name:
        folder = Path(name)
        (folder / "teeth.inp").write_text(deck(pair, parts))
        _, printed = execute(folder, "teeth", limit=1800, threads=1)
    rows = re.findall(r"^\s*(\d+)\s+(\S+E\S+)\s+(\S+E\S+)\s+(\S+E\S+)\s*$", printed, re.M)
    table = np.array(rows, float)
    places = parts[0].places[table[:, 0].astype(int) - 1]
    return float(np.sum(places[:, 1] * table[:, 1] - places[:, 0] * table[:, 2]))


@dataclass(frozen=True, eq=False)
class Part:
    """Mesh of one wheel in CalculiX's numbering."""

    mesh: SweptPitch
    places: np.ndarray  #: (n, 3) of the nodes, m
    number: int  #: of the part
    node: int  #: of its first node
    element: int  #: of its first element

    @property
    def cells(self) -> np.ndarray:
        """(m, 20) nodes of the elements, in CalculiX's order, from 0."""
        solid = self.mesh.solid
        return solid.dofs[node_order(solid.element.doflocs, ELEMENTS["hex20"].vtk)].T

    @property
    def holding(self) -> np.ndarray:
        """(k,) nodes of the cylinder that is held, from 0."""
        return self.mesh.nodes_of(self.mesh.plane.circle)[0]

    def volume(self) -> list[str]:
        """Return the lines of nodes and elements."""
        lines = ["*NODE", *_nodes(self.places, self.node)]
        lines.append(f"*ELEMENT, TYPE=C3D20R, ELSET=E{self.number}")
        for k, cell in enumerate(self.cells + self.node, self.element):
            lines += _wrapped([k, *cell])
        return [*lines, f"*SOLID SECTION, ELSET=E{self.number}, MATERIAL=STEEL"]

    def surface(self) -> list[str]:
        """Return the lines of the flank and of the cylinder that is held."""
        flank = np.zeros(len(self.places), bool)
        flank[self.mesh.nodes_of(self.mesh.plane.flank)[0]] = True
        lines = [f"*SURFACE, NAME=S{self.number}, TYPE=ELEMENT"]
        for face, corners in enumerate(FACES, 1):
            on_flank = np.flatnonzero(flank[self.cells[:, corners]].all(axis=1))
            lines += [f"{k + self.element}, S{face}" for k in on_flank]
        nodes = (self.holding + self.node).tolist()
        return [*lines, f"*NSET, NSET=H{self.number}", *_wrapped(nodes)]


def parts_of(pair: WheelPair) -> tuple[Part, Part]:
    """Return both wheels where their flanks touch in the pitch point."""
    place = pair.pitch_point
    radii = pair.first_radius(place), pair.second_radius(place)
    lean = [float(w.half_angle(r)) for w, r in zip((pair.first, pair.second), radii)]
    first, second = swept(pair.first, 1), swept(pair.second, -1)
    nodes = [mesh.solid.nodes.T.copy() for mesh in (first, second)]
    for places, angle in zip(nodes, (-lean[0], np.pi - lean[1])):
        places[:, :2] = turned(places[:, :2], angle)
    nodes[1][:, 1] += pair.distance
    node, element = len(nodes[0]) + 1, first.solid.mesh.nelements + 1
    return Part(first, nodes[0], 1, 1, 1), Part(second, nodes[1], 2, node, element)


def deck(pair: WheelPair, parts: tuple[Part, Part]) -> str:
    """Return the input of CalculiX."""
    first, second = parts
    start = first.places[first.holding]
    moved = turned(start[:, :2], ARC / pair.first.base) - start[:, :2]
    driven = []
    for node, (x, y) in zip(first.holding + first.node, moved):
        driven += [f"{node}, 1, 1, {x:.12e}", f"{node}, 2, 2, {y:.12e}", f"{node}, 3, 3"]
    text = [
        "*MATERIAL, NAME=STEEL",
        "*ELASTIC",
        f"{STEEL.youngs}, {STEEL.poisson}",
        *first.volume(),
        *second.volume(),
        *first.surface(),
        *second.surface(),
        "*SURFACE INTERACTION, NAME=TOUCH",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        f"{SLOPE:.3e}",
        "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE",
        "S1, S2",
        "*BOUNDARY",
        "H2, 1, 3",
        "*STEP",
        "*STATIC",
        "1.0, 1.0",
        "*BOUNDARY",
        *driven,
        "*NODE PRINT, NSET=H1",
        "RF",
        "*END STEP",
    ]
    return "\n".join(text) + "\n"


def swept(wheel: Wheel, hand: int) -> SweptPitch:
    """Return CalculiX's mesh of one pitch."""
    options = {"hold": wheel.root - RIM * MODULE, "fineness": FINE, "hand": hand}
    return SolidTeeth(wheel, layer=FACE / MODULE / LAYERS, **options).mesh


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--helix", nargs="*", type=float, default=[0.0, 15.0], metavar="DEGREES")
    helices = parser.parse_args().helix
    if shutil.which("ccx") is None:
        raise SystemExit("CalculiX is missing: apt-get install calculix-ccx")
    for helix in helices:
        pair = pair_of(radians(helix))
        by_calculix, by_cells = calculix(pair), condensed_contact(pair)
        row = {
            "helix_deg": helix,
            "arc_um": 1e6 * ARC,
            "torque_calculix": by_calculix,
            "torque": by_cells.torque,
            "ratio": by_calculix / by_cells.torque,
        }
        print(row, flush=True)
        kept("tooth_contact", {f"helix {helix:g}": row})


if __name__ == "__main__":
    main()
