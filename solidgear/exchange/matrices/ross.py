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

from solidgear.core import Scene, SolidgearError, as_supports, build
from solidgear.core.body import Supports
from solidgear.core.machine.whole_file import write_files
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
'''


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
    condensed = port_matrices(scene, ports=ports, bearings=bearings, **wanted)
    supports = as_supports(scene)
    lines = ["Rotor of ROSS (6 motions a node, axis z), in SI.", *header(condensed, SI)]
    lines.append("axes: z, x, y here are x, y, z there; every bearing is at one node")
    if grounded(SHAFT, supports).keys() & {f"{SHAFT}.bearings"}:
        lines.append("the housing that couples the bearings is in the condensed point alone")
    lines = [f"# {line}" for line in lines]
    lines += ["", HEAD, "", *_rotor(scene, supports), "", ""]
    lines += [*_condensed(condensed, ports[0])]
    lines += [
        "",
        "",
        'if __name__ == "__main__":',
        "    modal = rotor().run_modal(0.0, sparse=False)",
    ]
    lines.append("    print(np.unique((modal.wn / (2 * np.pi)).round(2))[:12], 'Hz')")
    return write_files({Path(path): ("\n".join(lines) + "\n").encode()})


def _rotor(scene: Scene, supports: Supports) -> Iterator[str]:
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
        rows.append(f"        rs.ShaftElement({values}, material=materials[{number}]),")
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
        stiffness, mass = supports.stiffness[rows_of, rows_of], supports.masses[rows_of, rows_of]
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
