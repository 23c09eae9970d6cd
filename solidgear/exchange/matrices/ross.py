"""ROSS: a Python file with the rotor of the beam, and the shaft condensed to a point as an element.

The axis of a rotor in ROSS is z; x, y, z there are z, x, y here, a turn of the axes, so that a 6x6 of
a point keeps its signs.  ROSS has no bearing with tilt or with couplings of six motions, but takes
any 6x6 of a disk: every bearing, mass and condensed shaft is an element of that kind.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import Scene, SolidgearError, as_supports, build, listed
from solidgear.core.body import Supports
from solidgear.core.machine.whole_file import write_files
from solidgear.core.models.beam.element import shear_coefficient
from solidgear.core.reduction.matrix_units import SI
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.core.system.links import grounded
from solidgear.exchange.matrices.header import header
from solidgear.exchange.matrices.source import SHAFT, port_matrices, read_shaft

#: places of x y z thx thy thz of ROSS among those of here
TURN = np.array([2, 0, 1, 5, 3, 4])
HEAD = '''\
import numpy as np
import ross as rs


class PointElement(rs.DiskElement):
    """Stiffness and mass (6, 6) of one node, order x y z alpha beta theta, SI."""

    def __init__(self, n, stiffness, mass, tag=None):
        self.stiffness, self.inertia = np.array(stiffness, float), np.array(mass, float)
        super().__init__(n, m=self.inertia[0, 0], Id=0.0, Ip=0.0, tag=tag)

    def K(self):
        return self.stiffness

    def M(self):
        return self.inertia

    def __hash__(self):
        return id(self)

    def __eq__(self, other):
        return self is other


class BeamElement(rs.ShaftElement):
    """Shaft element with a shear coefficient of Hutchinson (2001), whatever ROSS takes."""

    def __init__(self, *sizes, shear, **more):
        super().__init__(*sizes, **more)
        self.phi, self.kappa = self.phi * self.kappa / shear, shear
'''


#: what the file prints where it is run
MAIN = (
    *("", "", 'if __name__ == "__main__":'),
    "    modal = rotor().run_modal(0.0, sparse=False)",
    "    print(np.unique((modal.wn / (2 * np.pi)).round(2))[:12], 'Hz')",
)


def write_ross(source: Any, path: str | os.PathLike, units: str, **wanted: Any) -> list[Path]:
    """Write the file of a shaft: its rotor on all its nodes, and its condensed point."""
    if units != SI.name:
        raise SolidgearError(f"ROSS computes in SI; leave units = {units!r} out")
    if wanted.get("modes"):
        raise SolidgearError("an element of ROSS at one node has no modes; leave modes out")
    scene = read_shaft(source)
    ports = [*wanted.pop("ports", ())] or [scene.port.name]
    if len(ports) > 1:
        raise SolidgearError(f"an element of ROSS is at one node, not at {', '.join(ports)}")
    bearings = wanted.pop("bearings", None)
    bearings = True if bearings is None else bearings
    supports = as_supports(scene)
    condensed = port_matrices(scene, ports=ports, bearings=bearings, **wanted)
    lines = ["Rotor of ROSS (6 motions a node, axis z), in SI.", *header(condensed, SI)]
    lines += ["axes: z, x, y here are x, y, z there", *rotor_remarks(scene, held=bearings)]
    lines = [f"# {line}" for line in lines]
    lines += ["", HEAD, "", *_condensed(condensed, ports[0])]
    if not (bearings and _is_coupled(supports)):
        lines += ["", "", *_rotor(scene, supports, held=bearings), *MAIN]
    return write_files({Path(path): ("\n".join(lines) + "\n").encode()})


def rotor_remarks(scene: Scene, *, held: bool) -> list[str]:
    """Return in what the rotor of the file is another model than the beam here, or why there is none."""
    if held and _is_coupled(as_supports(scene)):
        return [
            "there is no rotor, only the condensed point: the housing makes the bearings act on one "
            "another, and an element of ROSS is at one node; leave [housing] out of the file for a rotor "
            "without it"
        ]
    wide = [b.name for b in scene.bearings if b.seat_width and b.attachment != "section"]
    if not (held and wide):
        return []
    return [
        f"the rotor has {listed(wide)} at one node each, where the beam here takes the mean of its seat, "
        "and the condensed point too: frequencies of the rotor are lower, by 0.1 to 3 % on shipped shafts"
    ]


def _is_coupled(supports: Supports) -> bool:
    """Return True where a housing makes the bearings act on one another."""
    return f"{SHAFT}.bearings" in grounded(SHAFT, supports)


def _rotor(scene: Scene, supports: Supports, *, held: bool) -> Iterator[str]:
    """Yield the function that makes the rotor, on the nodes of the beam."""
    body = build(scene, "timoshenko")
    nodes = [float(y) for y in body.geometry.nodes]  # type: ignore[union-attr]
    materials: dict[tuple[float, float, float], int] = {}
    rows = []
    for left, right in zip(nodes, nodes[1:]):
        middle = (left + right) / 2
        segment = next(s for s in scene.segments if s.y0 <= middle <= s.y1)
        ends = [segment.radius_at(min(max(y, segment.y0), segment.y1)) for y in (left, right)]
        diameters = [2 * float(radius) for radii in ends for radius in radii]
        steel = (segment.material.E, segment.material.nu, segment.material.density)
        number = materials.setdefault(steel, len(materials))
        values = ", ".join(map(repr, [right - left, *diameters]))
        bore, radius = (float(r) for r in segment.radius_at(middle))
        shear = float(shear_coefficient(segment.material.nu, radius, bore))
        rows.append(
            f"        BeamElement({values}, shear={shear!r}, material=materials[{number}]),"
        )
    yield from [
        "def rotor():",
        '    """Return the rotor of all its elements."""',
        "    materials = [",
    ]
    for young, poisson, density in materials:
        name = f"material{materials[young, poisson, density]}"
        yield f"        rs.Material({name!r}, rho={density!r}, E={young!r}, Poisson={poisson!r}),"
    yield from [
        "    ]",
        "    # length, then inner and outer diameter, left and right",
        "    shaft = [",
    ]
    yield from [*rows, "    ]", "    points = ["]
    places = {station.name: station.y for station in scene.stations}
    for k, name in enumerate(supports.ports):
        rows_of = slice(6 * k, 6 * k + 6)
        node = int(np.argmin(np.abs(np.array(nodes) - places[name])))
        stiffness, mass = (m[rows_of, rows_of] for m in (supports.stiffness, supports.masses))
        if not held:
            stiffness = np.zeros((6, 6))
        yield f"        PointElement({node}, {_turned(stiffness)}, {_turned(mass)}, tag={name!r}),"
    yield from ["    ]", "    return rs.Rotor(shaft, disk_elements=points)"]


def _condensed(matrices: PortMatrices, port: str) -> Iterator[str]:
    """Yield the function that makes the condensed point."""
    yield "def condensed(n):"
    yield '    """Return the shaft condensed to a point as an element of node n."""'
    yield f"    stiffness = {_turned(matrices.stiffness)}"
    yield f"    mass = {_turned(matrices.mass)}"
    yield f"    return PointElement(n, stiffness, mass, tag={port!r})"


def _turned(matrix: np.ndarray) -> str:
    return repr(np.asarray(matrix)[np.ix_(TURN, TURN)].tolist())
