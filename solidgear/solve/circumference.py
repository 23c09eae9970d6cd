"""Motion of a shape of a 3D mesh around the axis: its parts in cos nt and sin nt, whatever the
mesh.

Nodes are gathered in bins of like (r, y), divided until each has just enough of them to separate
the waves, so that the profile over the meridian may be anything; in each bin the radial, tangential
and axial motions are fitted by waves around.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from solidgear.body import Body

MOST = 16  # waves around that are separated, where the mesh has the nodes for them
BINS = 512


class Circumference:
    """Fit of nodal displacements by waves around the axis.

    Parameters
    ----------
    nodes : (3, n) ndarray
        m.
    weight : (n,) ndarray
        Share of each node in the mass, or in the volume.

    Attributes
    ----------
    waves : int
        Highest number of waves that the nodes can resolve.

    Examples
    --------
    A ring that moves sideways is one wave around, whatever its radius:

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
        outside = self._r > 1e-6 * self._r.max()  # on the axis there is no radial direction
        self.waves = self._resolved()
        least = 2 * (2 * self.waves + 1)
        self._bins = []
        for own in _divided(
            np.column_stack([self._r, y]),
            np.flatnonzero(outside),
            max(least, outside.sum() // BINS),
        ):
            basis = self._basis(own) * np.sqrt(weight[own])[:, None]
            self._bins.append(
                (own, np.linalg.pinv(basis, rcond=1e-3) * np.sqrt(weight[own]), basis.T @ basis)
            )

    def _resolved(self) -> int:
        rim = self._r > (1 - 1e-6) * self._r.max()
        angles = np.unique(np.round(self._angle[rim] % (2 * np.pi - 1e-9), 6))
        return int(min(MOST, max(2, len(angles) // 2 - 1)))

    def _basis(self, own):
        n = np.arange(1, self.waves + 1)
        at = self._angle[own, None] * n
        return np.hstack([np.ones((len(own), 1)), np.cos(at), np.sin(at)])

    def __call__(self, shape: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Amplitudes of one shape.

        Parameters
        ----------
        shape : (n, 3) ndarray
            Displacements x, y, z.

        Returns
        -------
        profile : (waves + 1, bins * 3) complex ndarray
            Row n: radial, tangential and axial motion ``Re(c exp(i n t))``, bin by bin, weighted so
            that the squared norm of a row is the share of the mass that moves so.
        share : (waves + 1, 3) ndarray
            Those squared norms by direction of motion.
        """
        c, s = np.cos(self._angle), np.sin(self._angle)
        # z = r cos t, x = r sin t
        motion = np.column_stack(
            [shape[:, 2] * c + shape[:, 0] * s, shape[:, 0] * c - shape[:, 2] * s, shape[:, 1]]
        )
        n = self.waves
        out = np.zeros((n + 1, len(self._bins), 3), complex)
        for k, (own, fit, gram) in enumerate(self._bins):
            found = fit @ motion[own]
            size = np.sqrt(np.diag(gram))[:, None]
            out[0, k] = found[0] * size[0]
            # cosine and sine weigh alike but for the placing of nodes
            weight = np.sqrt((size[1 : n + 1] ** 2 + size[n + 1 :] ** 2) / 2)
            out[1:, k] = (found[1 : n + 1] - 1j * found[n + 1 :]) * weight
        return out.reshape(n + 1, -1), (np.abs(out) ** 2).sum(axis=1)


def _divided(key, own, least: int):
    """Halve a set of points across its longer side until less than two times ``least`` are left;
    equal keys stay together.
    """
    stack, done = [own], []
    while stack:
        own = stack.pop()
        for axis in np.argsort(-np.ptp(key[own], axis=0)):
            values = key[own, axis]
            low = values <= np.median(values) + 1e-9 * np.ptp(values)
            if low.sum() >= least and (~low).sum() >= least:
                stack += [own[low], own[~low]]
                break
        else:
            done.append(own)
    return done


def of_body(body: Body) -> tuple[Circumference, Callable[[np.ndarray], np.ndarray]] | None:
    """The fit for a body of one 3D block that knows its mesh, kept with the body.

    Returns
    -------
    (Circumference, callable) or None
        The fit, and a function from the body's vectors (n,) to nodal displacements (nodes, 3); None
        for any other body.
    """
    block = body.blocks[0]
    nodes = getattr(body.geometry, "nodes", None)
    if len(body.blocks) != 1 or nodes is None or getattr(body.geometry, "dofs", None) is None:
        return None
    fit = body.cache.get(Circumference, lambda: Circumference(nodes, _volumes(body.geometry)))

    def displacements(vector):
        return (vector if block.expand is None else block.expand @ vector).reshape(-1, 3)

    return fit, displacements


def _volumes(geometry) -> np.ndarray:
    """(n,) share of each node in the volume, roughly: corner 0 of tetrahedra and hexahedra alike is
    joined to corners 1, 2 and 3.
    """
    corners = geometry.nodes[:, geometry.dofs[:4]]
    a, b, c = (corners[:, k] - corners[:, 0] for k in (1, 2, 3))
    volume = np.abs(np.einsum("ie,ie->e", a, np.cross(b, c, axis=0)))
    out = np.zeros(geometry.nodes.shape[1])
    np.add.at(out, geometry.dofs, np.broadcast_to(volume, geometry.dofs.shape))
    return out / out.sum()
