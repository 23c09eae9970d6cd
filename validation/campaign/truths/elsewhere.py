"""Numbers of a drawn body by elements of our own: of the program nothing is used.

Tetrahedra of second order by scikit-fem, curved, on meshes that gmsh makes of the drawing with the ends
of seats drawn into it, graded towards concave edges and ends of seats.  A seat on average moves as the
rigid motion that is nearest to that of its faces by area; the nodes of a rigid seat move as one.  Two
meshes, one finer in every place, are extrapolated at the order of sharp edges.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.sparse as sp

from solidgear.core.meshing.gmsh_session import Session, import_gmsh

#: entries of the compliance of the point, by row and column of x, y, z and the turns about them
ENTRIES = {"C_xx": (0, 0), "C_yy": (1, 1), "C_zz": (2, 2)}
ENTRIES |= {"C_thx": (3, 3), "C_thy": (4, 4), "C_thz": (5, 5)}
#: natural frequencies, by their place in the list of all
FREQUENCIES = tuple(f"f{k}" for k in range(1, 5))
#: sizes of cells of the first mesh over those of the second
FINER = 2.2
#: size of cells at singular edges over that elsewhere, and how fast it grows with the distance
AT_EDGES, GROWS = 1 / 6, 0.5
#: share of a small circle around an edge that lies in the body: more at a concave edge, all of it inside
CONCAVE, INSIDE = 0.55, 0.97
#: order of the error in sizes of cells: 2 a, with exponents a of 0.5 at the ends of rigid seats and 0.5445
#: at right-angled edges
ORDER = 1.05
#: doubt over the step beyond the second mesh: a shaft of revolution was off by 0.15 of it, halves of
#: thin sleeves by 0.8
DOUBT = 1.0
#: cells around a full circle where cells have the size of the drawing, and at least
AROUND, FEWEST = 12, 6
#: cells of the finest mesh
LEAST, MOST = 5_000, 8_500


@dataclass(frozen=True)
class Seat:
    """A seat, mm: on a cylinder about y of a diameter, between two places, or on faces of a plane, at a
    place along x, y or z, between two corners of a box.
    """

    name: str
    tie: str  #: "average" or "rigid"
    diameter: float = 0.0
    ends: tuple[float, float] = (0.0, 0.0)
    plane: int = -1
    at: float = 0.0
    box: tuple[Sequence[float], Sequence[float]] | None = None
    #: 6 stiffnesses, N/m and N m/rad; none is free, and of a hold they are infinite
    springs: Sequence[float] = field(default=(0.0,) * 6)
    clamped: bool = False

    def has(self, p: np.ndarray) -> np.ndarray:
        """Which points (3, ...) lie on it, mm."""
        hair = 1e-5 * max(abs(p).max(), 1.0)
        if self.plane < 0:
            near = np.abs(np.hypot(p[0], p[2]) - self.diameter / 2) < hair
            return near & (p[1] > self.ends[0] - hair) & (p[1] < self.ends[1] + hair)
        inside = np.abs(p[self.plane] - self.at) < hair
        for k, (low, high) in enumerate(zip(*self.box or ((), ()))):
            inside = inside & (p[k] > low - hair) & (p[k] < high + hair)
        return inside


@dataclass(frozen=True)
class Drawing:
    """A body as gmsh's kernel draws it, mm, and its seats, of which the last is the loaded point."""

    #: one after the other added or cut: "add" or "cut", "Box" or "Cylinder", what the kernel calls these
    #: by, and a turn about y, rad
    shapes: tuple[tuple[str, str, tuple[float, ...], float], ...]
    seats: tuple[Seat, ...]
    size: float  #: of cells of the finer mesh, mm
    E: float = 2.07e11
    nu: float = 0.3
    density: float = 7850.0

    def draw(self, occ: Any) -> list[tuple[int, int]]:
        """Draw it, and return its solids."""
        solids: list[tuple[int, int]] = []
        for what, kind, sizes, turn in self.shapes:
            tool = [(3, getattr(occ, f"add{kind}")(*sizes))]
            occ.rotate(tool, 0, 0, 0, 0, 1, 0, turn)
            if not solids:
                solids = tool
            else:
                join = occ.fuse if what == "add" else occ.cut
                solids, _ = join(solids, tool)
        return solids

    def imprinted(self, occ: Any) -> list[tuple[int, int]]:
        """Draw it, cut where seats end, and return its solids."""
        solids = self.draw(occ)
        planes = {(1, y) for s in self.seats if s.plane < 0 for y in s.ends}
        for seat in self.seats:
            for corner in seat.box or ():
                planes |= {(k, v) for k, v in enumerate(corner) if k != seat.plane}
        low, high = np.array(occ.getBoundingBox(*solids[0])).reshape(2, 3)
        far = float(np.abs([low, high]).max()) * 4
        tools = []
        for k, place in sorted(planes):
            if low[k] + 1e-4 < place < high[k] - 1e-4:
                face = occ.addRectangle(-far, -far, 0.0, 2 * far, 2 * far)
                if k < 2:
                    occ.rotate([(2, face)], 0, 0, 0, *((0, 1, 0), (1, 0, 0))[k], np.pi / 2)
                occ.translate([(2, face)], *(place * (j == k) for j in range(3)))
                tools.append((2, face))
        if tools:
            parts, _ = occ.fragment(solids, tools)
            occ.remove([p for p in parts if p[0] == 2], recursive=True)
            solids = [p for p in parts if p[0] == 3]
        return solids


def reference(drawing: Drawing) -> dict[str, tuple[float, float]]:
    """Numbers by their names, each with its relative uncertainty."""
    size = drawing.size
    for _ in range(6):
        finest = meshed(drawing, size)
        if LEAST < finest.nelements < MOST:
            break
        size *= (2 * finest.nelements / (LEAST + MOST)) ** (1 / 1.8)
    else:
        raise ValueError(f"no mesh of {LEAST} to {MOST} cells, the last had {finest.nelements}")
    coarse, fine = (numbers(drawing, mesh) for mesh in (meshed(drawing, FINER * size), finest))
    ahead = 1 / (FINER**ORDER - 1)
    values = {name: fine[name] + ahead * (fine[name] - coarse[name]) for name in fine}
    return {
        name: (value, DOUBT * ahead * abs(fine[name] - coarse[name]) / value)
        for name, value in values.items()
    }


def meshed(drawing: Drawing, size: float) -> Any:
    """Mesh of a drawing with the ends of seats in it, of scikit-fem, mm."""
    import skfem

    gmsh = import_gmsh()
    with Session(gmsh):
        occ = gmsh.model.occ
        solids = [tag for _, tag in drawing.imprinted(occ)]
        occ.synchronize()
        edges = [c for _, c in gmsh.model.getEntities(1) if _singular(gmsh, c, solids, drawing)]
        field = gmsh.model.mesh.field
        distance, law = field.add("Distance"), field.add("MathEval")
        field.setNumbers(distance, "CurvesList", edges)
        field.setNumber(distance, "Sampling", 60)
        field.setString(law, "F", f"Min({size}, {AT_EDGES * size} + {GROWS} * F{distance})")
        field.setAsBackgroundMesh(law)
        around = max(FEWEST, AROUND * drawing.size / size)  # in proportion: both meshes are alike
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", around)
        gmsh.option.setNumber("Mesh.HighOrderOptimize", 2)  # no cell is turned inside out
        gmsh.model.mesh.generate(3)
        tags, places, _ = gmsh.model.mesh.getNodes()
        nodes = np.zeros(int(tags.max()) + 1, int)
        nodes[tags.astype(int)] = np.arange(len(tags))
        found = gmsh.model.mesh.getElementsByType(11)[1]
        cells = nodes[found.astype(int)].reshape(-1, 10).T
    used, cells = np.unique(cells, return_inverse=True)
    points = places.reshape(-1, 3)[used].T
    cells = cells.reshape(10, -1)
    linear = skfem.MeshTet(points, cells[:4])
    corners, local = np.unique(cells[:4], return_inverse=True)
    linear = skfem.MeshTet(points[:, corners], local.reshape(4, -1), sort_t=False)
    # gmsh's order of middle nodes: of edges 01, 12, 02, 03, 23, 13
    by_edge = dict(zip(((0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3)), cells[4:]))
    element = skfem.ElementTetP2()
    dofs = skfem.Dofs(linear, element)
    doflocs = np.zeros((3, dofs.N))
    doflocs[:, dofs.element_dofs[:4]] = points[:, cells[:4]]
    for k, pair in enumerate(((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))):
        doflocs[:, dofs.element_dofs[4 + k]] = points[:, by_edge[pair]]
    return skfem.MeshTet2(np.ascontiguousarray(doflocs), dofs.element_dofs, sort_t=False)


def _singular(gmsh: Any, curve: int, solids: list[int], drawing: Drawing) -> bool:
    """Whether an edge is concave, or an end of a seat."""
    model = gmsh.model
    (low,), (high,) = model.getParametrizationBounds(1, curve)
    middle = low + 0.43 * (high - low)
    place = np.array(model.getValue(1, curve, [middle]))
    along = np.array(model.getDerivative(1, curve, [middle]))
    if not along.any():
        return False
    along /= np.linalg.norm(along)
    across = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    across /= np.linalg.norm(across)
    turn = 2 * np.pi * (np.arange(72) + 0.5) / 72
    around = np.outer(np.cos(turn), across) + np.outer(np.sin(turn), np.cross(along, across))
    points = place + 2e-2 * around
    share = sum(model.isInside(3, s, points.ravel().tolist()) for s in solids) / len(points)
    if CONCAVE < share < INSIDE:
        return True
    return share < INSIDE and any(_ends(seat, place) for seat in drawing.seats)


def _ends(seat: Seat, place: np.ndarray) -> bool:
    """Whether a point of an edge lies on the end of a seat."""
    if not seat.has(place[:, None])[0]:
        return False
    if seat.plane < 0:
        return min(abs(place[1] - y) for y in seat.ends) < 1e-4
    return True


def numbers(drawing: Drawing, mesh: Any) -> dict[str, float]:
    """Compliance of the point with all seats held, SI, and natural frequencies, Hz."""
    import pypardiso
    import skfem
    from scipy.sparse.linalg import LinearOperator, eigsh

    mesh = mesh.scaled(1e-3)
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTetP2()), intorder=4)
    stiffness, mass = _matrices(mesh, basis, drawing)
    motions: Mapping[str, Any] = {s.name: _Motion(mesh, basis, s) for s in drawing.seats}
    free = np.ones(basis.N, bool)
    columns, slaves = [], {}
    for seat in drawing.seats:
        if seat.tie == "rigid":
            free[motions[seat.name].dofs] = False
    keep = np.flatnonzero(free)
    columns.append(
        sp.csr_matrix((np.ones(len(keep)), (keep, range(len(keep)))), (basis.N, len(keep)))
    )
    count = len(keep)
    for seat in drawing.seats:
        if seat.tie == "rigid" and not seat.clamped:
            motion = motions[seat.name]
            rows = np.repeat(motion.dofs, 6)
            data = motion.rigid[motion.dofs]
            columns.append(
                sp.csr_matrix(
                    (data.ravel(), (rows, np.tile(range(6), len(motion.dofs)))), (basis.N, 6)
                )
            )
            slaves[seat.name] = count
            count += 6
    fold = sp.hstack(columns).tocsr()
    K, M = (fold.T @ (matrix @ fold) for matrix in (stiffness, mass))
    ports = {}
    for seat in drawing.seats:
        if seat.name in slaves:
            ports[seat.name] = sp.eye(count, format="csr")[
                slaves[seat.name] : slaves[seat.name] + 6
            ]
        elif not seat.clamped:
            ports[seat.name] = sp.csr_matrix(motions[seat.name].mean) @ fold
        if not seat.clamped and any(seat.springs):
            port = ports[seat.name]
            K = K + port.T @ sp.diags(list(seat.springs)) @ port
    K = ((K + K.T) / 2).tocsr()
    point = ports[drawing.seats[-1].name]
    solver, upper = pypardiso.PyPardisoSolver(mtype=2), sp.triu(K, format="csr")
    solver.factorize(upper)

    def solved(load: np.ndarray) -> np.ndarray:
        solver.set_phase(33)
        return solver._call_pardiso(upper, np.asfortranarray(load.reshape(count, -1)))

    flexibility = point @ solved(point.T.toarray())
    inverse = LinearOperator(K.shape, lambda x: solved(x).ravel(), dtype=float)
    values = eigsh(K, len(FREQUENCIES), M, sigma=0.0, OPinv=inverse, return_eigenvectors=False)
    solver.free_memory(everything=True)
    out = {name: float(flexibility[place]) for name, place in ENTRIES.items()}
    return out | dict(zip(FREQUENCIES, map(float, np.sqrt(np.sort(values)) / 2 / np.pi)))


def _matrices(mesh: Any, basis: Any, drawing: Drawing) -> tuple[Any, Any]:
    """Stiffness and mass, by products of all functions of a cell at once."""
    import skfem

    scalar = skfem.Basis(mesh, skfem.ElementTetP2(), intorder=4)
    shapes = [function[0] for function in scalar.basis]
    slope = np.array([shape.grad for shape in shapes])  # (10, 3, ne, q)
    value = np.array([np.broadcast_to(shape, scalar.dx.shape) for shape in shapes])
    count = mesh.nelements
    slope = slope.transpose(2, 0, 1, 3).reshape(count, 30, -1)
    pairs = (slope * scalar.dx[:, None]) @ slope.transpose(0, 2, 1)
    pairs = pairs.reshape(count, 10, 3, 10, 3)
    shear = drawing.E / 2 / (1 + drawing.nu)
    bulk = 2 * shear * drawing.nu / (1 - 2 * drawing.nu)
    along = np.einsum("eiajb,ab->eij", pairs, np.eye(3))
    elastic = bulk * pairs + shear * pairs.transpose(0, 1, 4, 3, 2)
    weighed = np.einsum("ieq,jeq,eq->eij", value, value, drawing.density * scalar.dx)
    heavy = np.zeros_like(elastic)
    for k in range(3):
        elastic[:, :, k, :, k] += shear * along
        heavy[:, :, k, :, k] = weighed
    places = basis.element_dofs.T  # by function, then by component
    rows = np.repeat(places, 30, axis=1).ravel(), np.tile(places, (1, 30)).ravel()
    return tuple(
        sp.coo_matrix((matrix.ravel(), rows), (basis.N, basis.N)).tocsr()
        for matrix in (elastic, heavy)
    )


class _Motion:
    """Motions of a seat: rigid ones of its nodes (n, 6), and the mean motion (6, n) of its faces."""

    def __init__(self, mesh: Any, basis: Any, seat: Seat) -> None:
        outside = mesh.boundary_facets()
        corners = 1e3 * mesh.p[:, mesh.facets[:, outside]]
        on = seat.has(corners).all(axis=0)
        if seat.plane < 0:  # not the faces at its ends
            on &= np.ptp(corners[1], axis=0) > 1e-6
        if not on.any():
            raise ValueError(f"no face on the seat of {seat.name!r}")
        nodes = _nodes(mesh, basis, outside[on])
        places = basis.doflocs[:, nodes[0]]  # (3, 6, faces)
        value, slopes, weight = _triangle()
        x = np.einsum("iq,kif->kfq", value, places)
        s, t = (np.einsum("iq,kif->kfq", slope, places) for slope in slopes)
        area = np.linalg.norm(np.cross(s, t, axis=0), axis=0) * weight
        middle = (x * area).sum(axis=(1, 2)) / area.sum()
        self.centre = middle if seat.plane >= 0 else np.array([0.0, sum(seat.ends) / 2e3, 0.0])
        rigid = _rigid(x - self.centre[:, None, None])  # (6, 3, faces, q)
        gram = np.einsum("kafq,lafq,fq->kl", rigid, rigid, area)
        shares = np.einsum("kafq,iq,fq->kaif", rigid, value, area)
        rows = np.zeros((6, basis.N))
        for k in range(6):
            np.add.at(rows[k], nodes, shares[k])
        self.mean = np.linalg.solve(gram, rows)
        self.dofs = np.unique(nodes)
        self.rigid = np.zeros((basis.N, 6))
        moved = _rigid(places - self.centre[:, None, None])
        for k in range(6):
            self.rigid[nodes, k] = moved[k]


def _nodes(mesh: Any, basis: Any, facets: np.ndarray) -> np.ndarray:
    """Unknowns (3, 6, faces) at corners of faces and at the middles of their edges 01, 12, 02."""
    corners = mesh.facets[:, facets]
    count = mesh.p.shape[1]
    order = np.argsort(mesh.edges[0] * count + mesh.edges[1])
    keys = (mesh.edges[0] * count + mesh.edges[1])[order]
    pairs = np.sort(np.array([corners[[a, b]] for a, b in ((0, 1), (1, 2), (0, 2))]), axis=1)
    edges = order[np.searchsorted(keys, pairs[:, 0] * count + pairs[:, 1])]
    return np.concatenate([basis.nodal_dofs[:, corners], basis.edge_dofs[:, edges]], axis=1)


def _triangle() -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray], np.ndarray]:
    """Functions (6, q) of second order on a triangle, their slopes and weights (q,)."""
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTri

    (u, v), weight = get_quadrature(RefTri, 6)
    w, o = 1 - u - v, 0 * u
    value = [w * (2 * w - 1), u * (2 * u - 1), v * (2 * v - 1), 4 * w * u, 4 * u * v, 4 * w * v]
    by_u = [1 - 4 * w, 4 * u - 1, o, 4 * (w - u), 4 * v, -4 * v]
    by_v = [1 - 4 * w, o, 4 * v - 1, -4 * u, 4 * u, 4 * (w - v)]
    return np.array(value), (np.array(by_u), np.array(by_v)), weight


def _rigid(away: np.ndarray) -> np.ndarray:
    """Displacements (6, 3, ...) of three shifts and three turns at places (3, ...) from the centre."""
    x, y, z = away
    o, one = 0 * x, 0 * x + 1
    shifts = [[one, o, o], [o, one, o], [o, o, one]]
    return np.array([*shifts, [o, -z, y], [z, o, -x], [-y, x, o]])
