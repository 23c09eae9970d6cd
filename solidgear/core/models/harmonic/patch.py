r"""Motion of a patch of a surface of revolution by single harmonics: where teeth touch.

A port moves as the mean of a whole ring, which harmonics n >= 2 leave alone.  Teeth touch on a
patch: an arc of the circumference about the angle t0, over the length of a seat.  With ``s = t -
t0`` a displacement of harmonic n has a part that is even about the patch and one that is odd,

    u_r = U cos ns,  u_t = -V sin ns,  u_y = W cos ns,        u_r = U sin ns,  u_t = V cos ns,  ...

and its mean over the patch is that of U and W (even) and V (odd) along the meridian, times
``sin(n b) / (n b)`` with b half the arc.  A patch and not a point: the compliance of a point has no
limit as harmonics are added, that of a patch has one.

Along the patch directions turn with the surface, as those of teeth do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solidgear.core.body import Body
from solidgear.core.errors import SolidgearError
from solidgear.core.kernel.assembly import tabulate
from solidgear.core.models.harmonic.blocks import CORNERS, Work
from solidgear.core.models.harmonic.families import Family
from solidgear.core.models.harmonic.mesh import HarmonicMesh
from solidgear.core.scene import Scene


@dataclass(frozen=True)
class Patch:
    """Patch of a shaft that teeth touch."""

    first: float  #: lower end along the shaft, m
    last: float  #: upper end, m
    angle: float  #: of its middle, rad; 0 on the z axis, a quarter turn on the x axis
    arc: float  #: of the circumference, rad
    inside: bool = False  #: on the inner surface, as of a ring

    @property
    def axes(self) -> np.ndarray:
        """Radial, tangential and axial direction (3, 3) at the middle, as columns x y z."""
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([[s, c, 0.0], [0.0, 0.0, 1.0], [c, -s, 0.0]])


class PatchMotion:
    """Mean motion of a patch of a harmonic solid, harmonic by harmonic; refused for other bodies,
    and where the shaft has no such surface.
    """

    def __init__(self, scene: Scene, body: Body, patch: Patch):
        geometry = body.geometry
        if not isinstance(geometry, HarmonicMesh):
            raise SolidgearError(
                f"the {body.fidelity} body has no harmonics around its axis; use harmonic"
            )
        self.patch = patch
        self._work = Work(scene, geometry)
        self._mean = self._along()

    def _along(self) -> np.ndarray:
        """Return the mean (n,) of a scalar unknown over the meridian of the patch, weighted by
        area.
        """
        work, first, last = self._work, self.patch.first, self.patch.last
        inside = self.patch.inside
        cells, corners, radial = work.flat.outer, [1, 2], 1.0
        if inside:
            cells, corners, radial = work.flat.inner, [0, 3], 0.0
        ends = work.flat.points[1][work.flat.cells[corners][:, cells]]
        out, area = np.zeros(work.n), 0.0
        for cell, (y0, y1) in zip(cells, ends.T):
            # the share of the cell's side that lies on the patch
            low, high = np.clip((np.array([first, last]) - y0) / (y1 - y0), 0.0, 1.0)
            if high - low < 1e-9:
                continue
            points = np.vstack([np.full_like(work.g, radial), low + (high - low) * work.g])
            nodes = work.flat.points[:, work.flat.cells[:, [cell]]]
            t = tabulate(CORNERS, nodes, work.element, points)
            side = np.linalg.norm(t.tangent[:, :, :, 1], axis=2)[0]
            weight = side * work.gw * (high - low) * t.x[0][0]
            np.add.at(out, work.dofs[:, cell], np.atleast_2d(t.value) @ weight)
            area += weight.sum()
        if area == 0.0:
            raise SolidgearError(
                f"there is no {'inner' if inside else 'outer'} surface from {1e3 * first:.4g} to "
                f"{1e3 * last:.4g} mm; the patch of the teeth must lie on the shaft"
            )
        return out / area

    def rows(self, n: int) -> np.ndarray:
        """Return the mean radial (even), tangential (odd) and axial (even) motion (3, m) on the
        unknowns (p, q, w) of the block of n >= 1 waves.
        """
        half = n * self.patch.arc / 2
        # u_r = p + q, u_t = p - q, u_y = w
        parts = np.array([[1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 0.0, 1.0]])
        full_rows = np.einsum("k,ic->ikc", self._mean * np.sinc(half / np.pi), parts)
        return full_rows.reshape(3, -1)[:, Family(n).free(self._work.geometry.on_axis).ravel()]
