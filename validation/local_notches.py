"""Local stress at grooves, cross holes and keyways beside published factors, and beside CalculiX.

    python -m validation.local_notches

Largest stress over the nominal stress that the source uses, with the error bar of the solid; in
torsion of holes and keyways the largest shear stress.  Sources:

- U grooves in round bars, over the section at the floor: fits by Pilkey (Peterson's Stress
  Concentration Factors, 2nd ed. 1997) to charts that rest on Neuber's formulas; coefficients as two
  public calculators print them.
- A groove that is small beside the shaft: half circle in a half plane, 3.065 in tension (Ling 1947)
  and 2 in shear (exact, by conformal mapping).
- Cross holes over the plain shaft: the fits of Pilkey to Jessop, Snell and Allison (1959); over the
  section left: DIN 743-2:2012, 5.2.3.
- A hole that is small beside the shaft, over the section left: 3 in tension (Kirsch), exact without lateral contraction,
  which adds up to 5 % inside of a thick wall.
- A keyway of d/4 by d/8 at its sides with r/d = 1/48 over the plain shaft: 2.14 in bending, 2.62 in torsion
  (Fessler, Rogers and Stanley 1969, as Peterson's chart 5.1 has them, from memory).
- A long keyway in torsion: Prandtl's stress function on the cross-section, by triangles, here.

The meshes of a hole and a keyway go to CalculiX too, with the same forces and planes of symmetry.
Rows go to validation/results/local_notches.json; some two minutes of processor time.
"""

from __future__ import annotations

import math
import shutil
import tempfile
import time
from pathlib import Path

import numpy as np

from solidgear.core.elements import ELEMENTS
from solidgear.core.scene import Material, Segment
from solidgear.cuts.features import CrossHole, Keyway
from solidgear.cuts.features.cut import Cut
from solidgear.cuts.local.mesh import local_mesh
from solidgear.cuts.local.solid import (
    LOADS,
    displacements,
    forces_on,
    free_surface,
    held_unknowns,
    lame_of,
    solution_on,
)
from solidgear.cuts.local.surface_stress import larger, largest_shear, surface_stress
from solidgear.show.outputs import node_order
from solidgear.strength.stress.groove import GrooveFactors, groove_factors
from solidgear.strength.stress.groove_mesh import GrooveShape
from solidgear.strength.stress.local_factors import (
    LocalFactors,
    local_factors,
    local_shape,
)
from validation.common import kept
from validation.race.calculix import _wrapped, execute

DIAMETER = 0.048
#: h/r, 2 h/D of U grooves
GROOVES = ((0.5, 0.1), (1.0, 0.1), (1.0, 0.2), (2.0, 0.2), (4.0, 0.2), (2.0, 0.4))
#: Pilkey's coefficients of 1, sqrt(h/r) and h/r in C_1 to C_4 up to h/r = 2, and beyond
U_GROOVE = {
    ("tension", 0): (
        (0.89, 2.208, -0.094),
        (-0.923, -6.678, 1.638),
        (2.893, 6.448, -2.516),
        (-1.912, -1.944, 0.963),
    ),
    ("bending", 0): (
        (0.594, 2.958, -0.520),
        (0.422, -10.545, 2.692),
        (0.501, 14.375, -4.486),
        (-0.613, -6.573, 2.177),
    ),
    ("torsion", 0): (
        (0.966, 1.056, -0.022),
        (-0.192, -4.037, 0.674),
        (0.808, 5.321, -1.231),
        (-0.567, -2.364, 0.566),
    ),
    ("tension", 1): (
        (1.037, 1.967, 0.002),
        (-2.679, -2.980, -0.053),
        (3.090, 2.124, 0.165),
        (-0.424, -1.153, -0.106),
    ),
    ("bending", 1): (
        (0.965, 1.926, 0.0),
        (-2.773, -4.414, -0.017),
        (4.785, 4.681, 0.096),
        (-1.995, -2.241, -0.074),
    ),
    ("torsion", 1): (
        (1.089, 0.924, 0.018),
        (-1.504, -2.141, -0.047),
        (2.486, 2.289, 0.091),
        (-1.056, -1.104, -0.059),
    ),
}
#: d/D of cross holes
HOLES = (0.1, 0.2, 0.3)
#: coefficients of powers of d/D in a solid shaft, over the plain shaft; of torsion the largest
#: normal stress over nominal shear
CHARTS = {"bending": (3.0, -6.25, 41.0, -45.0), "torsion": (4.0, -6.055, 32.764, -38.33)}
KEYWAY = {"bending": 2.14, "torsion": 2.62}


def shaft(nu: float = 0.3) -> Segment:
    """Return a long cylinder of steel with a Poisson's ratio."""
    steel = Material(E=2.1e11, nu=nu, density=7850.0)
    return Segment.cylinder("shaft", length=60 * DIAMETER, diameter=DIAMETER, material=steel)


def pilkey_groove(load: str, ratio: float, share: float) -> float:
    """Return the factor of a U groove of a depth over its radius, and twice it over D."""
    rows = np.array(U_GROOVE[load, int(ratio > 2)]) @ [1.0, math.sqrt(ratio), ratio]
    return float(rows @ share ** np.arange(4))


def row(what: str, load: str, found: GrooveFactors | LocalFactors, source: str, value: float):
    """Return a row: a factor beside a published one, both over the nominal stress of the source."""
    factor = found.factors[load]
    return {
        "what": what,
        "load": load,
        "solid": round(factor.value, 4),
        "bar": round(factor.bar, 4),
        "published": round(value, 4),
        "per cent": round(100 * (factor.value / value - 1), 2),
        "source": source,
    }


def grooves() -> list[dict]:
    """Return rows of grooves of revolution."""
    rows = []
    for ratio, share in GROOVES:
        depth = share * DIAMETER / 2
        shape = GrooveShape(depth, depth / ratio)
        found = groove_factors("groove", shaft(), shape, 1.0)
        for load in ("tension", "bending", "torsion"):
            what = f"U groove, h/r {ratio:g}, 2h/D {share:g}"
            rows.append(row(what, load, found, "Pilkey", pilkey_groove(load, ratio, share)))
    tiny = groove_factors("groove", shaft(), GrooveShape(1e-4, 1e-4), 1.0)
    left = 1 - 1e-4 / (DIAMETER / 2)
    rows.append(row("half circle, r/D 0.002", "tension", tiny, "Ling", 3.065 * left**2))
    rows.append(row("half circle, r/D 0.002", "torsion", tiny, "exact", 2.0 * left**3))
    return rows


def holes(tolerance: float) -> list[dict]:
    """Return rows of cross holes."""
    rows = []
    for share in HOLES:
        hole = CrossHole(name="hole", segment="shaft", y=1.0, diameter=share * DIAMETER)
        found = local_factors(shaft(), hole, tolerance)
        gross = found.nominal.of_plain(DIAMETER / 2, 0.0)
        powers = share ** np.arange(4)
        what = f"cross hole, d/D {share:g}"
        for load, coefficients in CHARTS.items():
            value = float(powers @ coefficients) / (2 if load == "torsion" else 1)
            rows.append(row(what, load, found, "Pilkey", value * gross[load]))
        root = math.sqrt(share)
        norm = {
            "tension": 3 - share,
            "bending": 3 + 1.4 * share - 2.8 * root,
            "torsion": 2.023 - 1.125 * root,
        }
        rows += [row(what, load, found, "DIN 743-2", value) for load, value in norm.items()]
    small = CrossHole(name="hole", segment="shaft", y=1.0, diameter=0.02 * DIAMETER)
    for nu in (0.0, 0.3):
        found = local_factors(shaft(nu), small, tolerance)
        what = f"cross hole, d/D 0.02, nu {nu:g}"
        rows.append(row(what, "tension", found, "Kirsch", 3.0))
    return rows


def keyway(length: float = 1.2) -> Keyway:
    """Return a keyway of a length in diameters, a width of d/4 and a depth of d/8 at its sides."""
    width, radius = DIAMETER / 4, DIAMETER / 2
    crown = radius - math.sqrt(radius**2 - width**2 / 4)
    return Keyway(
        name="key",
        segment="shaft",
        y=0.5,
        length=length * DIAMETER,
        width=width,
        depth=DIAMETER / 8 + crown,
        radius=DIAMETER / 48,
    )


def keyways(tolerance: float) -> list[dict]:
    """Return rows of keyways."""
    found = local_factors(shaft(), keyway(), tolerance)
    rows = [row("keyway", load, found, "Fessler", value) for load, value in KEYWAY.items()]
    long = local_factors(shaft(), keyway(4.0), tolerance)
    value = prandtl(DIAMETER, keyway().width, keyway().depth, DIAMETER / 48)
    rows.append(row("keyway of 4 D", "torsion", long, "Prandtl", value))
    return rows


def prandtl(diameter: float, width: float, depth: float, radius: float) -> float:
    """Return the largest shear of a keyed section in torsion over that of the plain one."""
    from skfem import Basis, ElementTriP2, FacetBasis, condense, solve
    from skfem.assembly import BilinearForm, LinearForm
    from skfem.helpers import dot, grad

    basis = Basis(keyed_section(diameter, width, depth, radius), ElementTriP2())
    stiffness = BilinearForm(lambda u, v, _: dot(grad(u), grad(v))).assemble(basis)
    load = LinearForm(lambda v, _: 2 * v).assemble(basis)
    stress = solve(*condense(stiffness, load, D=basis.get_dofs()))
    slope = FacetBasis(basis.mesh, ElementTriP2()).interpolate(stress).grad
    twist = float(load @ stress)  # J of the section, twice the volume below the function
    return float(np.hypot(*slope).max()) / twist * math.pi * diameter**3 / 16


def keyed_section(diameter: float, width: float, depth: float, radius: float):
    """Mesh the section of a shaft with a keyway by triangles, fine at both of its corners."""
    import gmsh
    from skfem import MeshTri

    floor, half = diameter / 2 - depth, width / 2
    gmsh.initialize(["gmsh", "-v", "0"], interruptible=False)
    occ = gmsh.model.occ
    disc = occ.addDisk(0, 0, 0, diameter / 2, diameter / 2)
    top = diameter
    corners = [(-half, top), (-half, floor + radius), (-half + radius, floor)]
    corners += [(-x, z) for x, z in corners[::-1]]
    points = [occ.addPoint(x, z, 0) for x, z in corners]
    first, second = (occ.addPoint(s * (half - radius), floor + radius, 0) for s in (-1, 1))
    lines = [
        occ.addLine(points[0], points[1]),
        occ.addCircleArc(points[1], first, points[2]),
        occ.addLine(points[2], points[3]),
        occ.addCircleArc(points[3], second, points[4]),
        occ.addLine(points[4], points[5]),
        occ.addLine(points[5], points[0]),
    ]
    slot = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    occ.cut([(2, disc)], [(2, slot)])
    occ.synchronize()
    size = gmsh.model.mesh.field.add("MathEval")
    x, z = half - radius, floor + radius
    away = f"Max(0,Sqrt((Sqrt(x^2)-({x}))^2+(y-({z}))^2)-({radius}))"
    formula = f"Min({diameter / 25},{radius / 30}+0.2*{away})"
    gmsh.model.mesh.field.setString(size, "F", formula)
    gmsh.model.mesh.field.setAsBackgroundMesh(size)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
    gmsh.model.mesh.generate(2)
    tags, places, _ = gmsh.model.mesh.getNodes()
    _, _, cells = gmsh.model.mesh.getElements(2)
    gmsh.finalize()
    used, numbers = np.unique(cells[0].astype(int), return_inverse=True)
    place = dict(zip(tags.astype(int).tolist(), places.reshape(-1, 3)[:, :2]))
    return MeshTri(
        np.ascontiguousarray(np.array([place[tag] for tag in used.tolist()]).T),
        np.ascontiguousarray(numbers.reshape(-1, 3).T),
    )


def beside_calculix(what: str, cut: Cut, size: float) -> list[dict]:
    """Return rows of the largest stress on one mesh, refined where a first one has it, by us and by
    CalculiX.
    """
    segment = shaft()
    shape = local_shape(segment, cut)
    leading = solution_on(shape, segment.material.nu).leading
    mesh = local_mesh(shape, [(leading, size * shape.size)])
    moved = displacements(mesh, shape, segment.material.nu)
    ours = surface_stress(mesh, free_surface(mesh, shape), moved, *lame_of(segment.material.nu))
    rows = []
    for k, load in enumerate(LOADS):
        held = held_unknowns(mesh, shape, load)
        theirs = stress_by_calculix(mesh, segment, held, forces_on(mesh, shape)[:, k])
        peak = (largest_shear if load == "torsion" else larger)(ours.plane[k]).argmax()
        node = int(((mesh.nodes - ours.x[:, peak, None]) ** 2).sum(axis=0).argmin())
        value, peer = (_size(tensor, load) for tensor in (ours.sigma[k, peak], theirs[node]))
        rows.append(
            {
                "what": what,
                "load": load,
                "unknowns": len(moved),
                "solid": round(value, 4),
                "CalculiX": round(peer, 4),
                "per cent": round(100 * (value / peer - 1), 3),
            }
        )
    return rows


def _size(tensor: np.ndarray, load: str) -> float:
    """Return the largest shear of a stress tensor in torsion, else its largest principal stress."""
    stresses = np.linalg.eigvalsh(tensor)
    return float(np.ptp(stresses) / 2 if load == "torsion" else np.abs(stresses).max())


def stress_by_calculix(mesh, segment: Segment, held: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Return the stress (n, 3, 3) at the nodes by CalculiX under forces (3 n,), while unknowns under
    a mask are held.
    """
    order = node_order(mesh.element.doflocs, ELEMENTS["tet10"].vtk)
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{k}, {x:.12e}, {y:.12e}, {z:.12e}" for k, (x, y, z) in enumerate(mesh.nodes.T, 1)]
    lines.append("*ELEMENT, TYPE=C3D10, ELSET=PART")
    for k, cell in enumerate(mesh.dofs.T[:, order] + 1, 1):
        lines += _wrapped([k, *cell.tolist()])
    nu = segment.material.nu
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"{2 * (1 + nu):.10e}, {nu:.10e}"]
    lines += ["*SOLID SECTION, ELSET=PART, MATERIAL=M", "*BOUNDARY"]
    lines += [f"{k // 3 + 1}, {k % 3 + 1}, {k % 3 + 1}" for k in np.flatnonzero(held)]
    lines += ["*STEP", "*STATIC", "*CLOAD"]
    lines += [f"{k // 3 + 1}, {k % 3 + 1}, {force[k]:.12e}" for k in np.flatnonzero(force)]
    lines += ["*EL FILE", "S", "*END STEP"]
    with tempfile.TemporaryDirectory(prefix="ccx-") as name:
        folder = Path(name)
        (folder / "notch.inp").write_text("\n".join(lines) + "\n")
        execute(folder, "notch", limit=900, threads=1)
        return stress_in((folder / "notch.frd").read_text(), mesh.nodes.shape[1])


def stress_in(text: str, count: int) -> np.ndarray:
    """Return the stress (n, 3, 3) at the nodes in a result file of CalculiX."""
    out = np.zeros((count, 3, 3))
    lines = iter(text[text.index(" -4  STRESS") :].splitlines())
    pairs = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))
    for line in lines:
        if line.startswith(" -3"):
            break
        if line.startswith(" -1"):
            node = int(line[3:13]) - 1
            for k, (i, j) in enumerate(pairs):
                out[node, i, j] = out[node, j, i] = float(line[13 + 12 * k : 25 + 12 * k])
    return out


def main() -> None:
    """Compute all rows, print and keep them."""
    if shutil.which("ccx") is None:
        raise SystemExit("CalculiX is missing: apt-get install calculix-ccx")
    rows: dict[str, list[dict]] = {}
    studies = {
        "grooves": grooves,
        "cross holes": lambda: holes(0.02),
        "keyways": lambda: keyways(0.03),
        "CalculiX": lambda: [
            *beside_calculix(
                "hole",
                CrossHole(name="h", segment="shaft", y=1.0, diameter=0.2 * DIAMETER),
                0.1,
            ),
            *beside_calculix("keyway", keyway(), 0.1),
        ],
    }
    for name, study in studies.items():
        start = time.process_time()
        rows[name] = study()
        for line in rows[name]:
            print(*line.values(), sep="  ", flush=True)
        print(f"{name}: {time.process_time() - start:.1f} s", flush=True)
    kept("local_notches", rows)


if __name__ == "__main__":
    main()
