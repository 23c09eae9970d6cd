"""A second harmonic solid, written apart from the product's: nodal elements of high order on any
quadrilaterals.

With y the axis, ``u_r = U cos t, u_t = -V sin t, u_y = W cos t`` and ``p = (U + V)/2, q = (U -
V)/2, w = W``; strains of harmonic 1, times cos t or sin t,

    e_rr = p,r + q,r    e_tt = 2 q / r      e_yy = w,y
    g_rt = q,r - p,r - 2 q / r     g_ty = q,y - p,y - w / r      g_ry = p,y + q,y + w,r

of harmonic 0 ``u_r,r, u_r / r, u_y,y, u_r,y + u_y,r``, and of torsion with ``u_t = r f``: ``r
f,r`` and ``r f,y``. Basis: Lagrange at the Gauss-Lobatto points, so that unknowns are values at
nodes and neighbours share them whichever way their cells are numbered.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from solidgear.core.body import Block, Body, Port
from solidgear.core.kernel.attachment import tie_rigidly
from solidgear.core.models.spectrum import elastic_scale
from solidgear.core.scene import Scene
from validation.campaign.truths.corner_mesh import CornerMesh

#: local edges of a cell in the direction in which its nodes are counted
EDGES = ((0, 1), (1, 2), (3, 2), (0, 3))


def spectral(scene: Scene, mesh: CornerMesh, order: int) -> Body:
    """Free body of a scene on a mesh, with the ties of the scene."""
    work = _Work(scene, mesh, order)
    ports = tuple(Port(s.name, s.y, s.attachment) for s in scene.stations)
    bending = work.block("bending_z", (2, 3), 1)
    blocks = (
        bending,
        bending.mirrored("bending_x", (0, 5), 0, (1.0, -1.0)),
        work.block("axial", (1,), 0),
        work.block("torsion", (4,), -1),
    )
    facts = {"element": f"Q{order}", "order": order, "cells": len(mesh.cells)}
    facts |= {"pair_tolerance": 1e-9}
    return Body("harmonic", blocks, ports, elastic_scale(scene), scene.length, facts)


def lobatto(order: int) -> np.ndarray:
    """Gauss-Lobatto points on 0 .. 1."""
    legendre = np.polynomial.legendre.Legendre.basis(order)
    return np.concatenate([[0.0], np.sort((legendre.deriv().roots().real + 1) / 2), [1.0]])


def lagrange(nodes: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, len(x)) values and derivatives of the Lagrange polynomials, through Legendre's for the
    sake of rounding.
    """
    n = len(nodes)
    of_nodes = np.polynomial.legendre.legvander(2 * nodes - 1, n - 1)
    value = np.polynomial.legendre.legvander(2 * x - 1, n - 1)
    slope = np.column_stack(
        [2 * np.polynomial.legendre.Legendre.basis(k).deriv()(2 * x - 1) for k in range(n)]
    )
    return np.linalg.solve(of_nodes.T, value.T), np.linalg.solve(of_nodes.T, slope.T)


class _Work:
    """Nodes, their numbering and tabulated functions."""

    def __init__(self, scene: Scene, mesh: CornerMesh, order: int):
        self.scene, self.mesh, self.p = scene, mesh, order
        self.nodes = lobatto(order)
        x, w = np.polynomial.legendre.leggauss(order + 3)
        self.x, self.w = (x + 1) / 2, w / 2
        self.value, self.slope = lagrange(self.nodes, self.x)
        self.corner = mesh.points[mesh.cells]  # (cells, 4, 2)
        self.dofs = self._numbering()
        self.n = int(self.dofs.max()) + 1
        self.pattern = None
        self.place = np.zeros((self.n, 2))
        a, b = np.meshgrid(self.nodes, self.nodes, indexing="ij")
        self.place[self.dofs] = _bilinear(self.corner, a.ravel(), b.ravel())[0]
        self.place[np.abs(self.place[:, 0]) < 1e-12 * mesh.points[:, 0].max(), 0] = 0.0

    def _numbering(self) -> np.ndarray:
        """(cells, (p + 1)^2) node numbers; node i, j of a cell lies i along its first direction
        and j along its second.
        """
        cells, p = self.mesh.cells, self.p
        out = np.full((len(cells), p + 1, p + 1), -1)
        for corner, at in enumerate(((0, 0), (p, 0), (p, p), (0, p))):
            out[:, at[0], at[1]] = cells[:, corner]
        count = len(self.mesh.points)
        ends = np.stack([cells[:, e] for e in EDGES], axis=1)  # (cells, 4, 2)
        _, number = np.unique(np.sort(ends, axis=2).reshape(-1, 2), axis=0, return_inverse=True)
        number = number.reshape(-1, 4)
        inner = np.arange(p - 1)
        sides = (out[:, 1:p, 0], out[:, p, 1:p], out[:, 1:p, p], out[:, 0, 1:p])
        for e, side in enumerate(sides):
            forward = (ends[:, e, 0] < ends[:, e, 1])[:, None]
            along = np.where(forward, inner, inner[::-1])
            side[:] = count + number[:, e, None] * (p - 1) + along
        count += (int(number.max()) + 1) * (p - 1)
        inside = np.arange(len(cells) * (p - 1) ** 2).reshape(len(cells), p - 1, p - 1)
        out[:, 1:p, 1:p] = count + inside
        # points of the coarse mesh that no cell uses would be unknowns without stiffness
        flat = out.reshape(len(cells), -1)
        return np.unique(flat, return_inverse=True)[1].reshape(flat.shape)

    def _batches(self):
        """Yields (cells, material, values (nb, nq), gradients in r and in y (m, nb, nq), r (m,
        nq), weights (m, nq)).
        """
        a, b = (g.ravel() for g in np.meshgrid(self.x, self.x, indexing="ij"))
        value = np.einsum("ix,jy->ijxy", self.value, self.value).reshape(-1, len(a))
        along = np.einsum("ix,jy->ijxy", self.slope, self.value).reshape(-1, len(a))
        across = np.einsum("ix,jy->ijxy", self.value, self.slope).reshape(-1, len(a))
        weight = np.outer(self.w, self.w).ravel()
        for index, segment in enumerate(self.scene.segments):
            mine = np.flatnonzero(self.mesh.segment == index)
            for part in np.array_split(mine, max(1, len(mine) // 16)):
                x, jac = _bilinear(self.corner[part], a, b)
                det = jac[..., 0, 0] * jac[..., 1, 1] - jac[..., 0, 1] * jac[..., 1, 0]
                inv = (jac / det[..., None, None])[:, None]
                gr = inv[..., 1, 1] * along - inv[..., 1, 0] * across
                gy = inv[..., 0, 0] * across - inv[..., 0, 1] * along
                yield part, segment.material, value, gr, gy, x[..., 0], det * weight

    def _pattern(self):
        """(row starts, columns, place of every entry of every element matrix) of the nodes'
        connectivity.
        """
        if self.pattern is None:
            key = self.dofs[:, :, None] * self.n + self.dofs[:, None, :]
            there, place = np.unique(key, return_inverse=True)
            starts = np.searchsorted(there // self.n, np.arange(self.n + 1))
            self.pattern = starts, there % self.n, place.ravel()
        return self.pattern

    def _assembled(self, values: np.ndarray) -> sp.csr_matrix:
        """Matrix of (c, c, cells, nb, nb) element matrices, unknowns grouped by node."""
        starts, columns, place = self._pattern()
        c = len(values)
        entries = values.reshape(c * c, -1)
        data = [np.bincount(place, weights=v, minlength=len(columns)) for v in entries]
        blocks = np.reshape(data, (c, c, -1)).transpose(2, 0, 1)
        size = self.n * c
        return sp.bsr_matrix((blocks, columns, starts), shape=(size, size)).tocsr()

    def block(self, name: str, components: tuple[int, ...], n: int) -> Block:
        """Harmonic 1, 0 (axial) or, as -1, torsion."""
        share = {1: (2.0, 2.0, 1.0), 0: (1.0, 1.0), -1: (1.0,)}[n]
        c, nb = len(share), self.dofs.shape[1]
        stiff, heavy = np.empty((c, c, len(self.dofs), nb, nb)), np.empty((len(self.dofs), nb, nb))
        for part, material, value, gr, gy, r, dv in self._batches():
            w = (np.pi if n == 1 else 2 * np.pi) * dv * (r**3 if n == -1 else r)
            root = np.sqrt(w)[:, None]
            f = np.stack([value * root / r[:, None], gr * root, gy * root], axis=1)
            f = f.reshape(len(part), 3 * nb, -1)
            gram = (f @ f.transpose(0, 2, 1)).reshape(-1, 3, nb, 3, nb)
            energy = _energy(n, material)
            stiff[:, :, part] = np.einsum("ikjl,ekalb->ijeab", energy, gram, optimize=True)
            heavy[part] = (value * (material.density * w)[:, None]) @ value.T
        stiffness = self._assembled(stiff)
        mass = self._assembled(heavy[None, None] * np.diag(share)[:, :, None, None, None])
        keep = np.ones((self.n, c), bool)
        axis = self.place[:, 0] == 0
        if n == 1:
            keep[axis, 1:] = False
        elif n == 0:
            keep[axis, 0] = False
        keep = keep.ravel()
        rigid = self._rigid(n, len(components))[keep]
        ports, ties = [], []
        for i, station in enumerate(self.scene.stations):
            if station.attachment == "rigid":
                seat = np.zeros((self.n, c), bool)
                seat[np.unique(self._seat(station)[0])] = True
                ties.append((i, station.y, seat.ravel()[keep]))
                ports.append(np.zeros((len(components), keep.sum())))
            else:
                ports.append(self._mean(n, station).reshape(len(components), -1)[:, keep])
        y = np.repeat(self.place[:, 1], c)[keep]
        matrices = stiffness[keep][:, keep], mass[keep][:, keep]
        at = sp.csr_matrix(np.vstack(ports))
        return tie_rigidly(Block(name, components, *matrices, rigid, y, at), ties)

    def _rigid(self, n: int, count: int) -> np.ndarray:
        (r, y), zero, one = self.place.T, np.zeros(self.n), np.ones(self.n)
        if n == -1:
            return one[:, None]
        motions = [[one, zero, zero], [y, zero, -r]] if n == 1 else [[zero, one]]
        return np.array(motions).transpose(2, 1, 0).reshape(-1, count)

    def _lines(self, wanted) -> list[tuple[np.ndarray, np.ndarray]]:
        """(node numbers, ends) of each cell edge whose ends and cell centre `wanted` accepts."""
        p, out = self.p, []
        local = self.dofs.reshape(len(self.dofs), p + 1, p + 1)
        for e, (i, j) in enumerate(EDGES):
            nodes = (local[:, :, 0], local[:, p, :], local[:, :, p], local[:, 0, :])[e]
            ends = self.corner[:, [i, j]]
            chosen = wanted(ends, self.corner.mean(axis=1))
            out += list(zip(nodes[chosen], ends[chosen]))
        return out

    def _seat(self, station) -> tuple[np.ndarray, np.ndarray]:
        """(edges, p + 1) nodes and (edges, 2, 2) ends on the outer surface between lo and hi."""
        tol = 1e-9 * self.scene.length

        def wanted(ends, centre):
            y = ends[:, :, 1]
            good = (
                (y.min(axis=1) >= station.lo - tol)
                & (y.max(axis=1) <= station.hi + tol)
                & (np.ptp(y, axis=1) > 1e-3 * tol)
            )
            for k in np.flatnonzero(good):
                segment = next(s for s in self.scene.segments if s.y0 <= centre[k, 1] <= s.y1)
                outer = [segment.radius_at(v)[1] for v in np.clip(y[k], segment.y0, segment.y1)]
                good[k] = np.abs(ends[k, :, 0] - outer).max() <= 1e-9 * max(outer)
            return good

        return self._stacked(wanted, station)

    def _section(self, station) -> tuple[np.ndarray, np.ndarray]:
        """The same in the plane of the station, as part of the cells below it (above it at the
        first end face).
        """
        tol = 1e-9 * self.scene.length
        side = 1.0 if station.y > tol else -1.0

        def wanted(ends, centre):
            return (np.abs(ends[:, :, 1] - station.y).max(axis=1) < tol) & (
                side * (station.y - centre[:, 1]) > 0
            )

        return self._stacked(wanted, station)

    def _stacked(self, wanted, station):
        found = self._lines(wanted)
        if not found:
            raise ValueError(f"no surface found for {station.name!r}")
        return np.array([f[0] for f in found]), np.array([f[1] for f in found])

    def _mean(self, n: int, station) -> np.ndarray:
        """Least-squares rigid motion of a seat or section, (components, nodes, c)."""
        nodes, ends = (
            self._section(station) if station.attachment == "section" else self._seat(station)
        )
        at = (1 - self.x)[None, :, None] * ends[:, :1] + self.x[None, :, None] * ends[:, 1:]
        r, h = at[..., 0], at[..., 1] - station.y
        ds = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)[:, None] * self.w

        def integral(weight):
            row = np.zeros(self.n)
            np.add.at(row, nodes, (weight * ds) @ self.value.T)
            return row

        if n == -1:
            return (integral(r**3) / (r**3 * ds).sum())[None, :, None]
        if n == 0:
            out = np.zeros((1, self.n, 2))
            out[0, :, 1] = integral(r) / (r * ds).sum()
            return out
        load = np.zeros((2, self.n, 3))
        load[0, :, 0] = 2 * integral(r)
        load[1, :, 0], load[1, :, 2] = 2 * integral(r * h), -integral(r * r)
        cross = 2 * (r * h * ds).sum()
        gram = np.array(
            [[2 * (r * ds).sum(), cross], [cross, (r * (2 * h * h + r * r) * ds).sum()]]
        )
        return np.linalg.solve(gram, load.reshape(2, -1)).reshape(2, self.n, 3)


def _bilinear(corner: np.ndarray, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions (m, q, 2) and Jacobians (m, q, 2, 2), position along reference coordinates, of
    (m, 4, 2) corners.
    """
    shape = np.array([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b])
    first = np.array([-(1 - b), 1 - b, b, -b])
    second = np.array([-(1 - a), -a, a, 1 - a])
    jac = np.stack([np.einsum("mkd,kq->mqd", corner, s) for s in (first, second)], axis=3)
    return np.einsum("mkd,kq->mqd", corner, shape), jac


def _energy(n: int, material) -> np.ndarray:
    """(c, 3, c, 3) coefficients of twice the strain energy: unknown i by function k, unknown j by
    function l.

    Functions are ``phi / r``, ``phi,r`` and ``phi,y``; for torsion the weight holds ``r^2``.
    """
    lame = material.E * material.nu / ((1 + material.nu) * (1 - 2 * material.nu))
    mu = material.E / (2 * (1 + material.nu))
    over, dr, dy = np.eye(3)
    none = np.zeros(3)
    if n == -1:
        normal, shear = [], [(dr,), (dy,)]
    elif n == 0:
        normal, shear = [(dr, none), (over, none), (none, dy)], [(dy, dr)]
    else:
        normal = [(dr, dr, none), (none, 2 * over, none), (none, none, dy)]
        shear = [(-dr, dr - 2 * over, none), (-dy, dy, -over), (dy, dy, dr)]
    strains = [(2 * mu, np.array(e)) for e in normal] + [(mu, np.array(g)) for g in shear]
    if normal:
        strains.append((lame, sum(np.array(e) for e in normal)))
    return sum(modulus * np.multiply.outer(e, e) for modulus, e in strains)
