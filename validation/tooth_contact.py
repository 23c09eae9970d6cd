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
from solidgear.teeth.contact.local import LineContact
from solidgear.teeth.contact.solver import Loads, loads
from validation.common import kept
from validation.race.calculix import _nodes, _wrapped, execute

MODULE, FACE = 4e-3, 4e-3
#: rim below the roots, modules
RIM = 4.0
#: arc of the first wheel on its base cylinder, m: CalculiX takes the second flank as flat triangles,
#: which stand back from it by up to 0.2 um
ARC = 60e-6
#: pressure by overlap of CalculiX's surfaces, N/m^3: at a tenth of it the torque is 0.7 % less
SLOPE = 3e16
#: mesh of CalculiX: the half-width of contact is more than a cell
FINE = Fineness(fillet=4, flank=70, across=10)
LAYERS = 2
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


def condensed_contact(pair: WheelPair, **options) -> Loads:
    """Return the loads under which the first wheel turns by the arc."""
    wheels = pair.first, pair.second
    teeth = [
        OnePitch(wheel, hold=wheel.root - RIM * MODULE, hand=hand, **options)
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
    with tempfile.TemporaryDirectory(prefix="ccx-") as name:
        folder = Path(name)
        text, holding = deck(pair)
        (folder / "teeth.inp").write_text(text)
        _, printed = execute(folder, "teeth", limit=1800, threads=1)
    rows = re.findall(r"^\s*(\d+)\s+(\S+E\S+)\s+(\S+E\S+)\s+(\S+E\S+)\s*$", printed, re.M)
    table = np.array(rows, float)
    places = holding[table[:, 0].astype(int) - 1]
    return float(np.sum(places[:, 1] * table[:, 1] - places[:, 0] * table[:, 2]))


def deck(pair: WheelPair) -> tuple[str, np.ndarray]:
    """Return the input of CalculiX, and the places (n, 3) of all nodes, m."""
    wheels = pair.first, pair.second
    pitch_radii = pair.first_radius(pair.pitch_point), pair.second_radius(pair.pitch_point)
    turns = (
        -float(wheels[0].half_angle(pitch_radii[0])),
        np.pi - float(wheels[1].half_angle(pitch_radii[1])),
    )
    centres = np.zeros(3), np.array([0.0, pair.distance, 0.0])
    lines, places, elements = [], [], 0
    later = []
    for number, (wheel, turn, centre) in enumerate(zip(wheels, turns, centres), 1):
        mesh = swept(wheel, 1 if number == 1 else -1)
        solid = mesh.solid
        nodes = solid.nodes.T.copy()
        nodes[:, :2] = turned(nodes[:, :2], turn)
        first = sum(len(p) for p in places) + 1
        places.append(nodes + centre)
        order = node_order(solid.element.doflocs, ELEMENTS["hex20"].vtk)
        cells = solid.dofs[order].T + first
        lines += [f"*NODE, NSET=N{number}", *_nodes(places[-1], first)]
        lines.append(f"*ELEMENT, TYPE=C3D20R, ELSET=E{number}")
        for k, cell in enumerate(cells, elements + 1):
            lines += _wrapped([k, *cell])
        flank = np.zeros(len(nodes), bool)
        flank[mesh.nodes_of(mesh.plane.flank)[0]] = True
        later.append(f"*SURFACE, NAME=S{number}, TYPE=ELEMENT")
        on_flank = flank[solid.dofs[order].T]
        for face, corners in enumerate(FACES, 1):
            chosen = np.flatnonzero(on_flank[:, corners].all(axis=1))
            later += [f"{k + elements + 1}, S{face}" for k in chosen]
        holding = mesh.nodes_of(mesh.plane.circle)[0] + first
        later += [f"*NSET, NSET=H{number}", *_wrapped(holding.tolist())]
        elements += len(cells)
    everything = np.concatenate(places)
    holding_first = swept(pair.first, 1).nodes_of(swept(pair.first, 1).plane.circle)[0]
    angle = ARC / pair.first.base
    driven = []
    for node in holding_first:
        x, y, _ = everything[node]
        c, s = np.cos(angle), np.sin(angle)
        moved = (c * x + s * y - x, -s * x + c * y - y, 0.0)
        driven += [f"{node + 1}, {k + 1}, {k + 1}, {u:.12e}" for k, u in enumerate(moved)]
    text = [
        *lines,
        *later,
        "*MATERIAL, NAME=STEEL",
        "*ELASTIC",
        "2.06e11, 0.3",
        "*SOLID SECTION, ELSET=E1, MATERIAL=STEEL",
        "*SOLID SECTION, ELSET=E2, MATERIAL=STEEL",
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
    return "\n".join(text) + "\n", everything


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
            "torque_calculix": by_calculix,
            "torque": by_cells.torque,
            "ratio": by_calculix / by_cells.torque,
        }
        print(row, flush=True)
        kept("tooth_contact", {f"helix {helix:g}": row})


if __name__ == "__main__":
    main()
