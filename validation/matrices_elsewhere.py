"""Matrices through other programs: their solvers on what we write, and ours on what they write.

- CalculiX: a shaft by masses, springs and equations, on springs at its bearings and with a rigid
  cross on springs that ``*RIGID BODY`` ties to a point, beside the same system here (CalculiX itself
  does not take ``*MASS`` on tied nodes alone);
- CalculiX: a block of solid cells between rigid faces, stored by ``SOLVER=MATRIXSTORAGE`` and read,
  beside its own free modes;
- ROSS: the rotor of a beam on full 6x6 bearings, and a shaft condensed to a point as an element on
  another rotor, beside the same here.

Seen with CalculiX 2.20, whose frequencies have seven figures, and ROSS 2.3, of which six are compared:
2e-7 of the shaft in SI and in mm and tonnes; 2e-6 of ten modes of the block; 6e-5 of the rotor with
its bearings at sections, 2e-5 with the condensed point, by which its beams differ from ours. A bearing
in ROSS is at one node: with the mean of a seat first bending here is higher, by 1.4e-3 for
``shaft_stepped`` and 2.9 % for ``pinion_overhung``.

    python -m validation.matrices_elsewhere
"""

from __future__ import annotations

import re
import subprocess
import tempfile
from itertools import product
from pathlib import Path

import numpy as np

import solidgear as sg
from solidgear.core.frames import shift
from validation.race.installed import interpreter, missing, present

GEOMETRY = Path(__file__).resolve().parents[1] / "geometry"
SHAFT = GEOMETRY / "shaft_stepped.toml"
#: springs to ground at two points of the shaft, N/m and N m/rad
SPRINGS = {"A": (3e8, 2e8, 4e8, 1e5, 1e4, 2e5), "B": (2e8, 0.0, 2.5e8, 1e5, 0.0, 1e5)}
#: arms of a cross around a point, m, and a spring to ground at the end of each, N/m
CROSS, EACH = ((0.1, 0, 0), (-0.1, 0.05, 0), (0, 0, 0.12), (0, -0.03, -0.12)), 4e7
#: edges of a block, m, and its cells
EDGES, CELLS = (0.2, 0.4, 0.1), (3, 6, 2)


def calculix(deck: str, folder: Path, name: str = "job") -> list[float]:
    """Run a deck and return its frequencies, Hz."""
    (folder / f"{name}.inp").write_text(deck)
    done = subprocess.run(
        ["ccx", "-i", name], cwd=folder, capture_output=True, text=True, check=False, timeout=300
    )
    text = (folder / f"{name}.dat").read_text()
    rows = re.findall(r"^\s+\d+\s+\S+\s+\S+\s+(\S+)\s+\S+\s*$", text, re.M)
    if "*ERROR" in done.stdout:
        raise RuntimeError(done.stdout[-2000:])
    return [float(row) for row in rows]


def shaft_in_calculix(folder: Path, units: str = "m-kg-N") -> tuple[np.ndarray, np.ndarray]:
    """Return the frequencies, Hz, of a shaft on springs and a cross of them: by CalculiX on our
    deck, and here.
    """
    matrices = sg.port_matrices(SHAFT, modes=30)
    matrices.write(folder / "shaft.inp", "calculix", units)
    system = sg.System(
        {"shaft": matrices},
        {
            **{n: sg.BearingSpring(f"shaft.{n}", np.diag(k)) for n, k in SPRINGS.items()},
            "cross": sg.BearingSpring("shaft.port", _cross()),
        },
    )
    length = 1e-3 if units == "mm-t-N" else 1.0
    names = [*matrices.positions]
    lines, element = ["*INCLUDE, INPUT=shaft.inp"], 9000
    for name, stiffness in SPRINGS.items():
        for k, value in enumerate(stiffness):
            if not value:
                continue
            element += 1
            node = 2 * names.index(name) + 1 + k // 3
            in_units = value * length if k < 3 else value / length
            lines += [f"*ELEMENT, TYPE=SPRING1, ELSET=G{element}", f"{element}, {node}"]
            lines += [f"*SPRING, ELSET=G{element}", f"{k % 3 + 1}", f"{in_units!r}"]
    centre = matrices.positions["port"]
    lines.append("*NODE, NSET=CROSS")
    for k, arm in enumerate(CROSS, start=8001):
        lines.append(", ".join(map(str, [k, *((centre + arm) / length)])))
    for direction in (1, 2, 3):
        lines.append(f"*ELEMENT, TYPE=SPRING1, ELSET=CROSS{direction}")
        lines += [f"{10000 * direction + k}, {k}" for k in range(8001, 8001 + len(CROSS))]
        lines += [f"*SPRING, ELSET=CROSS{direction}", f"{direction}", f"{EACH * length!r}"]
    lines.append("*RIGID BODY, NSET=CROSS, REF NODE=1, ROT NODE=2")
    lines += ["*STEP", "*FREQUENCY", "9", "*END STEP", ""]
    got = np.array(calculix("\n".join(lines), folder))[:9]
    return got, system.modes(9).frequency_hz


def _cross() -> np.ndarray:
    """Return the (6, 6) stiffness of the cross about its point."""
    out = np.zeros((6, 6))
    for arm in CROSS:
        moved = shift(np.array(arm, float))[:3]
        out += EACH * moved.T @ moved
    return out


def block_from_calculix(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the elastic frequencies, Hz, of a free block: by CalculiX, and here from the matrices
    that it stores, read with two points.
    """
    nodes, lines = {}, ["*NODE, NSET=ALL"]
    for k, place in enumerate(product(*(range(n + 1) for n in CELLS)), start=1):
        nodes[place] = k
        x = [edge * i / n for edge, i, n in zip(EDGES, place, CELLS)]
        lines.append(", ".join(map(str, [k, *x])))
    first = len(nodes) + 1
    ends = {"A": (first, first + 1, 0), "B": (first + 2, first + 3, CELLS[1])}
    points = {}
    for name, (node, turned, at) in ends.items():
        centre = [EDGES[0] / 2, EDGES[1] * at / CELLS[1], EDGES[2] / 2]
        lines += [", ".join(map(str, [k, *centre])) for k in (node, turned)]
        points[name] = {"node": [node, turned], "position": centre}
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=BLOCK")
    corners = (
        (0, 0, 0),
        (1, 0, 0),
        (1, 1, 0),
        (0, 1, 0),
        (0, 0, 1),
        (1, 0, 1),
        (1, 1, 1),
        (0, 1, 1),
    )
    for k, cell in enumerate(product(*map(range, CELLS)), start=1):
        names = [nodes[tuple(np.add(cell, corner))] for corner in corners]
        lines.append(", ".join(map(str, [k, *names])))
    for name, (node, turned, at) in ends.items():
        lines.append(f"*NSET, NSET=FACE{name}")
        lines += [f"{k}," for place, k in nodes.items() if place[1] == at]
        lines.append(f"*RIGID BODY, NSET=FACE{name}, REF NODE={node}, ROT NODE={turned}")
    lines += ["*MATERIAL, NAME=STEEL", "*ELASTIC", "2.1e11, 0.3", "*DENSITY", "7850."]
    lines.append("*SOLID SECTION, ELSET=BLOCK, MATERIAL=STEEL")
    step = ["*STEP", "*FREQUENCY", "16", "*END STEP", ""]
    theirs = calculix("\n".join([*lines, *step]), folder, "free")
    step[1] += ", SOLVER=MATRIXSTORAGE"
    calculix("\n".join([*lines, *step]), folder, "block")
    matrices = sg.read_matrices(folder / "block.sti", points)
    ours = matrices.elastic[0] / (2 * np.pi)
    return np.array(theirs[6:16]), ours[:10]


def rotor_in_ross(folder: Path) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return frequencies, Hz, by ROSS and here: of a rotor on bearings of 6x6, and of a uniform rotor
    that carries another shaft by its condensed point.
    """
    scene = _on_full_bearings()
    body = sg.build(scene, "timoshenko")
    ours = sg.modes(body, scene, n=9).frequency_hz
    file = sg.export(scene, folder / "rotor_file.py", "ross")[0]
    gear = sg.export(GEOMETRY / "gear_shaft.toml", folder / "gear_file.py", "ross")[0]
    done = subprocess.run(
        [interpreter("ross"), "-c", SCRIPT, str(file.parent)],
        capture_output=True,
        text=True,
        check=True,
        timeout=600,
    )
    rows = [
        np.array([float(word) for word in line.split()[1:]])
        for line in done.stdout.splitlines()
        if line.startswith("FREQUENCIES")
    ]
    assert gear.exists()
    return [(rows[0], ours[ours > 1][: len(rows[0])]), (rows[1], _carrying()[: len(rows[1])])]


#: run where ROSS is
SCRIPT = """
import sys
sys.path.insert(0, sys.argv[1])
import numpy as np
import ross as rs
import gear_file, rotor_file

def tell(rotor):
    hertz = rotor.run_modal(0.0, sparse=False).wn / (2 * np.pi)
    hertz = np.sort(hertz[hertz > 1.0])
    print("FREQUENCIES", *hertz)

tell(rotor_file.rotor())
steel = rs.Material("steel", rho=7850.0, E=2.07e11, Poisson=0.3)
shaft = [rs.ShaftElement(0.01, 0.0, 0.06, material=steel) for _ in range(50)]
tell(rs.Rotor(shaft, disk_elements=[gear_file.condensed(20)]))
"""


def _on_full_bearings():
    """A stepped shaft on two bearings with tilt and couplings, each at a section."""
    scene = sg.load(SHAFT).with_attachment("section")
    matrix = np.diag([3e8, 2e8, 4e8, 1e5, 0.0, 2e5])
    for (i, j), value in {(0, 5): 2e6, (2, 3): -1e6, (0, 2): 5e7, (0, 1): 3e7}.items():
        matrix[i, j] = matrix[j, i] = value
    bearings = tuple(
        b.with_changes(matrix=matrix.tolist(), axial_series=(), catalogue=None)
        for b in scene.bearings
    )
    return scene.with_changes(bearings=bearings, housing=None, housing_axial=None)


def _carrying() -> np.ndarray:
    """The frequencies, Hz, of the uniform rotor with the condensed point."""
    rod = sg.Segment.cylinder("rod", length=0.5, diameter=0.06)
    free = sg.Bearing(
        name="seat", y=0.2, seat_width=0.01, attachment="section", stiffness=np.zeros((6, 6))
    )
    scene = sg.Scene.from_parts([rod], bearings=[free])
    body = sg.build(scene, "timoshenko", kappa="cowper", elements=100)
    point = sg.port_matrices(GEOMETRY / "gear_shaft.toml", ports=["gear"], bearings=True)
    system = sg.System(
        {"rod": sg.rubin(body, n=40)},
        {
            "spring": sg.BearingSpring("rod.seat", point.stiffness),
            "mass": sg.PortInertia("rod.seat", point.mass),
        },
    )
    hertz = system.modes(14).frequency_hz
    return hertz[hertz > 1]


def _line(what: str, theirs: np.ndarray, ours: np.ndarray) -> str:
    worst = np.abs(theirs / ours - 1)
    return (
        f"{what}: {len(ours)} frequencies, {worst.max():.1e} apart ({worst[:5].max():.1e} in five)"
    )


def main() -> None:
    """Print how far apart the programs are."""
    if sentence := missing("CalculiX", "ROSS"):
        print(sentence)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if present("CalculiX"):
            for units in ("m-kg-N", "mm-t-N"):
                print(_line(f"shaft in CalculiX, {units}", *shaft_in_calculix(folder, units)))
            print(_line("block from CalculiX", *block_from_calculix(folder)))
        if present("ROSS"):
            for what, pair in zip(("rotor", "condensed point"), rotor_in_ross(folder)):
                print(_line(f"{what} in ROSS", *pair))


if __name__ == "__main__":
    main()
