"""Loaded transmission error of two whole gears as finite elements, beside teeth, contact and train.

    python -m validation.teeth_pair [--calculix]

23 and 57 teeth of 4 mm on bores of 20 and 60 mm radius, every tooth meshed, in plane strain: the bore of
the second is held, that of the first turned by a torque, at 32 positions of a mesh cycle, without relief
and with long tip relief on both wheels.  There the pressure is resolved (:mod:`validation.whole_gears`);
ours has the teeth of one pitch read at a depth, the local law, and the same bodies.  CalculiX has the
same gears on other meshes, with the tips in contact too, at a few positions (`--calculix`, some minutes
of processor time each).
Rows go to validation/results/teeth_pair.json; half a minute of processor time.
"""

from __future__ import annotations

import argparse
import re
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core.gears.flank_shape import FlankShape, Relief
from solidgear.core.gears.wheel import Wheel
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.compliance.mesh import Fineness
from solidgear.teeth.compliance.plane import PlaneTeeth
from solidgear.teeth.compliance.slices import Slices
from solidgear.teeth.compliance.solid_mesh import turned
from solidgear.teeth.contact.cycle import MeshCycle, mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.local import Elasticity, LineContact
from validation.common import kept, stamp
from validation.race.calculix import _nodes, _wrapped, execute
from validation.whole_gears import POISSON, YOUNGS, WholeGear, WholePair

FACE = 20e-3
#: radii of both bores, m
HOLDS = (20e-3, 60e-3)
POSITIONS, ORDERS = 32, 3
#: load per face width, N/m, and long tip relief of both wheels, m
CASES = ((1e5, 0.0), (3e5, 0.0), (9e5, 0.0), (3e5, 20e-6), (9e5, 20e-6))
#: cases and positions in pitches that CalculiX solves
BY_CALCULIX = ((3e5, 0.0, 0.0), (3e5, 0.0, 0.3), (3e5, 0.0, -0.1875), (3e5, 20e-6, 0.4))
#: its meshes of teeth that may touch and of others, pressure by overlap, N/m^3, and width, m
FINENESS = (Fineness(fillet=6, flank=80, across=8), Fineness(fillet=2, flank=2, across=2))
SLOPE, WIDTH = 3e16, 1e-3


@dataclass(frozen=True)
class Case:
    """Both gears under one load."""

    load: float  #: per face width, N/m
    relief: float  #: at both tips, from where two pairs of teeth carry, m

    @property
    def name(self) -> str:
        """Load and relief in words."""
        relief = f"relief {1e6 * self.relief:g} um" if self.relief else "no relief"
        return f"{1e-3 * self.load:g} N/mm, {relief}"

    @property
    def wheels(self) -> WheelPair:
        """Both wheels at their distance without backlash."""
        return WheelPair(Wheel(23, 4e-3, face_width=FACE), Wheel(57, 4e-3, face_width=FACE))

    @property
    def shapes(self) -> tuple[FlankShape, FlankShape]:
        """Both flanks."""
        wheels = self.wheels
        start, stop = wheels.ends
        return (
            FlankShape(tip=Relief(self.relief, start + wheels.pitch, stop)),
            FlankShape(
                tip=Relief(
                    self.relief,
                    float(wheels.second_length(stop - wheels.pitch)),
                    float(wheels.second_length(start)),
                )
            ),
        )

    @property
    def torque(self) -> float:
        """Torque on the first wheel per face width, N."""
        return self.load * self.wheels.first.base

    def cycle(self, body: bool = True) -> MeshCycle:
        """Return the cycle by teeth that are read at a depth and a local law, with their bodies or
        without.
        """
        wheels, steel = self.wheels, Elasticity(YOUNGS, POISSON)
        first, second = (
            Slices(PlaneTeeth(wheel, hold=hold, elasticity=steel, body=body), FACE, 1)
            for wheel, hold in zip((wheels.first, wheels.second), HOLDS)
        )
        law = LineContact((steel, steel), (first.depth, second.depth))
        pair = CylindricalPair(wheels, (first, second), law, self.shapes, slices=1)
        return mesh_cycle(pair, FACE * self.torque, wheels.first.base, 1, positions=POSITIONS)

    def whole(self) -> np.ndarray:
        """Return the (p,) loaded transmission error of both whole gears, m."""
        pair = WholePair.of(self.wheels, HOLDS, self.shapes)
        phases = np.arange(POSITIONS) / POSITIONS
        centred = np.where(phases < 0.5, phases, phases - 1)
        base = self.wheels.first.base
        return base * np.array([pair.rotation(float(p), self.torque) for p in centred])


def figures(error: np.ndarray) -> dict[str, float]:
    """Return mean, peak to peak and orders of a transmission error, um."""
    micro = 1e6 * np.asarray(error)
    orders = 2 * np.abs(np.fft.rfft(micro)) / len(micro)
    out = {"mean": float(micro.mean()), "peak to peak": float(np.ptp(micro))}
    return out | {f"order {n}": float(orders[n]) for n in range(1, ORDERS + 1)}


def calculix(case: Case, phase: float, arc: float) -> tuple[float, float]:
    """Return the torques per face width on both wheels by CalculiX, N, while the first bore is turned
    by an arc on its base circle, m.
    """
    pair = WholePair.of(case.wheels, HOLDS, case.shapes, FINENESS)
    centres = np.zeros(2), np.array([0.0, pair.wheels.distance])
    places = [
        turned(gear.points, turn) + centre
        for gear, turn, centre in zip(pair.gears, pair.turns(phase), centres)
    ]
    with tempfile.TemporaryDirectory(prefix="ccx-") as name:
        folder = Path(name)
        (folder / "gears.inp").write_text(deck(pair, places, arc / pair.wheels.first.base))
        _, printed = execute(folder, "gears", limit=3000, threads=1)
    rows = re.findall(r"^\s*(\d+)\s+(\S+E\S+)\s+(\S+E\S+)\s+(\S+E\S+)\s*$", printed, re.M)
    table = np.array(rows, float)
    nodes, forces = table[:, 0].astype(int) - 1, table[:, 1:3]
    levers = np.concatenate([place - centre for place, centre in zip(places, centres)])[nodes]
    moments = (levers[:, 1] * forces[:, 0] - levers[:, 0] * forces[:, 1]) / WIDTH
    on_first = nodes < len(places[0])
    return float(moments[on_first].sum()), float(moments[~on_first].sum())


def deck(pair: WholePair, places: list[np.ndarray], angle: float) -> str:
    """Return the input of CalculiX: the first bore turned clockwise by an angle, rad."""
    lines, later, nodes, elements = [], [], 0, 0
    for number, (gear, place) in enumerate(zip(pair.gears, places), 1):
        lines += ["*NODE", *_nodes(np.column_stack([place, np.zeros(len(place))]), nodes + 1)]
        lines.append(f"*ELEMENT, TYPE=CPE8, ELSET=E{number}")
        for k, cell in enumerate(gear.cells[:, :8] + nodes + 1, elements + 1):
            lines += _wrapped([k, *cell])
        later.append(f"*SURFACE, NAME=S{number}, TYPE=ELEMENT")
        later += [f"{cell + elements + 1}, S{edge}" for cell, edge in outside(gear)]
        later += [f"*NSET, NSET=H{number}", *_wrapped((gear.bore + nodes + 1).tolist())]
        later += [f"*SOLID SECTION, ELSET=E{number}, MATERIAL=STEEL", f"{WIDTH}"]
        nodes += len(place)
        elements += len(gear.cells)
    bore = pair.gears[0].bore
    moved = angle * places[0][bore] @ [[0.0, -1.0], [1.0, 0.0]]
    text = [
        *("*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNGS}, {POISSON}"),
        *lines,
        *later,
        *("*NSET, NSET=H", "H1, H2"),
        *("*SURFACE INTERACTION, NAME=TOUCH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"),
        f"{SLOPE:.3e}",
        *("*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE", "S1, S2"),
        *("*BOUNDARY", "H2, 1, 2", "*STEP", "*STATIC", "1.0, 1.0", "*BOUNDARY"),
        *(f"{n + 1}, {k}, {k}, {u[k - 1]:.12e}" for n, u in zip(bore, moved) for k in (1, 2)),
        *("*NODE PRINT, NSET=H", "RF", "*END STEP"),
    ]
    return "\n".join(text) + "\n"


def outside(gear: WholeGear) -> list[tuple[int, int]]:
    """Return cells and their edges, from 1, on the right flanks that may touch and on their tips."""
    touches = np.zeros(len(gear.points), bool)
    tips = [gear.points[nodes[-1]] for nodes in gear.flanks.values()]
    radii = np.hypot(gear.points[:, 0], gear.points[:, 1])
    tip = np.hypot(*tips[0])
    near = min(abs(tip - radii).max(), gear.wheel.module)
    for nodes, corner in zip(gear.flanks.values(), tips):
        touches[nodes] = True
        beside = np.hypot(*(gear.points - corner).T) < near
        touches |= beside & (abs(radii - gear.wheel.tip) < 1e-5 * tip)
    corners = gear.cells[:, :4]
    out = []
    for edge in range(4):
        ends = corners[:, [edge, (edge + 1) % 4]]
        out += [(int(cell), edge + 1) for cell in np.flatnonzero(touches[ends].all(axis=1))]
    return out


def compared(case: Case) -> dict[str, Any]:
    """Return both transmission errors of a case and by how much ours is larger."""
    whole, cycle = case.whole(), case.cycle()
    reference, teeth = figures(whole), figures(cycle.error)
    return {
        "load": case.load,
        "relief": case.relief,
        "whole gears": [1e6 * e for e in whole],
        "figures": reference,
        "teeth": teeth,
        "excess": {name: teeth[name] / reference[name] - 1 for name in reference},
        "corners": cycle.corner_share,
    }


def main() -> None:
    """Solve all cases, print and keep the rows."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--calculix", action="store_true", help="a few positions by CalculiX too")
    if not parser.parse_args().calculix:
        rows = {}
        for load, relief in CASES:
            case = Case(load, relief)
            rows[case.name] = row = compared(case)
            print(case.name)
            for name, value in row["figures"].items():
                print(f"  {name:12} {value:8.4f} um, ours {100 * row['excess'][name]:+.2f} %")
        kept("teeth_pair", {"cases": rows, "made": stamp()})
        return
    if shutil.which("ccx") is None:
        raise SystemExit("CalculiX is missing: apt-get install calculix-ccx")
    peers = []
    for load, relief, phase in BY_CALCULIX:
        case = Case(load, relief)
        pair = WholePair.of(case.wheels, HOLDS, case.shapes)
        arc = case.wheels.first.base * pair.rotation(phase, case.torque)
        first, second = calculix(case, phase, arc)
        turns = second / first * case.wheels.first.teeth / case.wheels.second.teeth
        row = {"case": case.name, "phase": phase, "torque": first / case.torque, "second": turns}
        peers.append(row)
        print(row, flush=True)
        kept("teeth_pair", {"calculix": peers, "calculix made": stamp()})


if __name__ == "__main__":
    main()
