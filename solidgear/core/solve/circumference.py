"""Motion of a shape of a 3D mesh around the axis: the parts in cos nt and sin nt, whatever the
mesh.

Nodes are gathered in bins of equal (r, y), divided until each has just enough of them to separate
the waves, so that the profile over the meridian may be anything; in each bin the radial, tangential
and axial motions are fitted by waves around.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from solidgear.core.body import Body

MOST = 16  # waves around that are separated, where the mesh has the nodes for them
BINS = 512
#: least eigenvalue of the Gram matrix of waves that nodes separate: 0.4 to 0.9 where they do, 0.04
#: and less where they do not
APART = 0.2
#: of the largest singular value of a bin, below which the nodes of one near the axis, which happen to
#: lie to one side, would make many waves out of one
SCATTERED = 0.1


class Circumference:
    """Fit of displacements of nodes (3, n), m, by waves around the axis; the weight (n,) is the
    share of each node in the mass, or in the volume.

    Examples
    --------
    A ring that moves sideways is one wave around, whatever the radius:

    >>> t = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)
    >>> ring = np.array([0.1 * np.sin(t), 0 * t, 0.1 * np.cos(t)])
    >>> fit = Circumference(ring, np.full(16, 1 / 16))
    >>> profile, share = fit(np.tile([1.0, 0.0, 0.0], (16, 1)))
    >>> int(np.argmax(share.sum(axis=1)))
    1
    """

    def __init__(self, nodes: np.ndarray, weight: np.ndarray):
        x, y, z = nodes
        self._r, self._angle = np.hypot(x, z), np.arctan2(x, z)
        # on the axis there is no radial direction
        outside = np.flatnonzero(self._r > 1e-6 * self._r.max())
        #: highest number of waves that the nodes can resolve
        self.waves = self._resolved_waves(outside, weight)
        least = 2 * (2 * self.waves + 1)
        self._bins = []
        for members in _divided(
            np.column_stack([self._r, y]),
            outside,
            max(least, len(outside) // BINS),
        ):
            basis = _basis(self._angle[members], self.waves) * np.sqrt(weight[members])[:, None]
            self._bins.append(
                (
                    members,
                    np.linalg.pinv(basis, rcond=SCATTERED) * np.sqrt(weight[members]),
                    basis.T @ basis,
                )
            )

    def _resolved_waves(self, members: np.ndarray, weight: np.ndarray) -> int:
        """Return the most waves that nodes can separate, wherever they lie: of waves that are equal
        on them, as eleven and thirteen are on 24 places around, the Gram matrix has an eigenvalue
        near zero.
        """
        basis = _basis(self._angle[members], MOST) * np.sqrt(weight[members])[:, None]
        basis /= np.linalg.norm(basis, axis=0)
        gram = basis.T @ basis
        for n in range(MOST, 2, -1):
            columns = np.r_[: n + 1, MOST + 1 : MOST + 1 + n]
            if np.linalg.eigvalsh(gram[np.ix_(columns, columns)])[0] > APART:
                return n
        return 2

    def __call__(self, shapes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return amplitudes of shapes (..., n, 3), displacements x, y, z: profiles (..., waves + 1,
        bins * 3), of which row n is the radial, tangential and axial motion ``Re(c exp(i n t))``,
        bin by bin, weighted so that the squared norm of a row is the share of the mass that moves
        so; and those squared norms by direction of motion (..., waves + 1, 3).
        """
        c, s = np.cos(self._angle), np.sin(self._angle)
        x, y, z = np.moveaxis(shapes, -1, 0)
        # z = r cos t, x = r sin t
        motion = np.stack([z * c + x * s, x * c - z * s, y], axis=-1)
        n, of_shapes = self.waves, shapes.shape[:-2]
        out = np.zeros((*of_shapes, n + 1, len(self._bins), 3), complex)
        for k, (members, fit, gram) in enumerate(self._bins):
            amplitudes = fit @ motion[..., members, :]
            size = np.sqrt(np.diag(gram))[:, None]
            out[..., 0, k, :] = amplitudes[..., 0, :] * size[0]
            # cosine and sine weigh alike but for the placing of nodes
            weight = np.sqrt((size[1 : n + 1] ** 2 + size[n + 1 :] ** 2) / 2)
            waves = amplitudes[..., 1 : n + 1, :] - 1j * amplitudes[..., n + 1 :, :]
            out[..., 1:, k, :] = waves * weight
        return out.reshape(*of_shapes, n + 1, -1), (np.abs(out) ** 2).sum(axis=-2)


def _basis(angle: np.ndarray, waves: int) -> np.ndarray:
    """Return (n, 2 waves + 1) constants, cosines and sines of angles."""
    angles = angle[:, None] * np.arange(1, waves + 1)
    return np.hstack([np.ones((len(angle), 1)), np.cos(angles), np.sin(angles)])


def _divided(key, members, least: int):
    """Halve a set of points across the longer side until less than two times ``least`` are left;
    equal keys stay together.
    """
    stack, bins = [members], []
    while stack:
        members = stack.pop()
        for axis in np.argsort(-np.ptp(key[members], axis=0)):
            values = key[members, axis]
            low = values <= np.median(values) + 1e-9 * np.ptp(values)
            if low.sum() >= least and (~low).sum() >= least:
                stack += [members[low], members[~low]]
                break
        else:
            bins.append(members)
    return bins


#: shape by blocks -> (nodes, 3) displacements
Displacements = Callable[[Mapping[int, np.ndarray]], np.ndarray]


def circumference_of(body: Body) -> tuple[Circumference, Displacements] | None:
    """Return the fit for a 3D body that knows its mesh, whole or as the half beside a mirror plane,
    kept with the body, and a function from shapes to displacements of the nodes; None for any other
    body.
    """
    geometry: Any = body.geometry
    motion = getattr(geometry, "motion", None)
    if motion is None:
        return None
    fit = body.cache.get(Circumference, lambda: Circumference(geometry.nodes, _volumes(geometry)))
    plain = body.without_results()  # names, which the body keeps, keep what is returned
    return fit, lambda vectors: motion(plain.mesh_unknowns(vectors))


def _volumes(geometry) -> np.ndarray:
    """Return the (n,) share of each node in the volume, roughly: corner 0 of tetrahedra and
    hexahedra is joined to corners 1, 2 and 3.
    """
    corners = geometry.nodes[:, geometry.dofs[:4]]
    a, b, c = (corners[:, k] - corners[:, 0] for k in (1, 2, 3))
    volume = np.abs(np.einsum("ie,ie->e", a, np.cross(b, c, axis=0)))
    out = np.zeros(geometry.nodes.shape[1])
    np.add.at(out, geometry.dofs, np.broadcast_to(volume, geometry.dofs.shape))
    return out / out.sum()
