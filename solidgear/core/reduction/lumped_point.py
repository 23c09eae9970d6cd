"""A body seen from the lumped point in a bending plane: stiffness, first bending, condensed mass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core.body import Body, as_supports
from solidgear.core.errors import SolidgearError
from solidgear.core.solve.coupling import decoupled, groups
from solidgear.core.solve.modes import ModeSet, modes
from solidgear.core.solve.statics import condense
from solidgear.core.solve.supported import Supported

if TYPE_CHECKING:
    from solidgear.core.body.supports import Holding

PLANE = (2, 3)  # z and thx


@dataclass(frozen=True)
class LumpedPoint:
    """Constants of a body that the synthesis of lumped models needs."""

    stiffness: np.ndarray  #: (2, 2) static, on (z, thx), all other motions free
    #: (2,) (z, phi) of the lumped point in the first bending mode of unit modal mass
    motion: np.ndarray
    omega: float  #: rad/s
    total_mass: float  #: of the body, kg
    total_inertia: float  #: of the body, transverse and about the lumped point, kg m^2
    guyan: np.ndarray  #: (2, 2) mass condensed on the static shapes

    @property
    def static_share(self) -> float:
        """``v' K_a v / w1^2``, never above 1; 1 when the mode is a static shape."""
        return float(self.motion @ self.stiffness @ self.motion) / self.omega**2


def lumped_point(
    body: Body, supports: Holding, port: str, mode_set: ModeSet | None = None
) -> tuple[LumpedPoint, ModeSet]:
    """Compute static stiffness, first bending motion and condensed mass of a body at the lumped
    point, with the modes, which are solved if they are not given or have no first bending; refuse a
    body without a first bending mode or static stiffness at the port.
    """
    supports = as_supports(supports)
    condensed = condense(body, supports, port)
    c = condensed.compliance[np.ix_(PLANE, PLANE)]
    if not np.all(np.isfinite(c)):
        raise SolidgearError(
            f"port {port!r} has no static stiffness in bending: bearings leave it free; "
            "support the shaft first"
        )
    k = np.linalg.inv(c)
    if np.linalg.eigvalsh(k)[0] <= 0:
        raise SolidgearError(
            f"the stiffness at port {port!r} is indefinite in bending: {k.tolist()}; "
            "check the bearings"
        )
    if mode_set is None or not mode_set.named("bending 1"):
        mode_set = modes(body, supports, 12)
    index = body.port_index(port)
    mode, motion = _first_in_plane(body, mode_set, index)
    if mode is None:
        raise SolidgearError(
            f"no bending mode in the z plane among the first 12 of the {body.fidelity} body; "
            "effective masses need one"
        )
    inertia = body.mass_matrix() + supports.rigid_mass(body)
    y = body.ports[index].y
    about = inertia[3, 3] - 2 * y * inertia[2, 3] + y * y * inertia[2, 2]
    point = LumpedPoint(
        stiffness=k,
        motion=motion,
        omega=2 * np.pi * mode.frequency_hz,
        total_mass=float(inertia[2, 2]),
        total_inertia=float(about),
        guyan=_guyan(body, supports, index, c),
    )
    return point, mode_set


def _first_in_plane(body: Body, mode_set: ModeSet, index: int):
    """Return the first bending mode that moves the port in the z plane, and the (z, thx) there:
    unequal bearings may put one of the x plane before it.
    """
    for mode in (*mode_set.modes, *mode_set.beyond):
        if mode.family != "bending" or mode.frequency_hz == 0:
            continue
        motions = np.array([body.port_motions(v)[6 * index :][:6] for v in mode.vectors])
        size = np.array([1.0, body.length])  # a rotation counts by the motion at the other end
        z, x = (np.linalg.norm(motions[:, c] * size) for c in (list(PLANE), [0, 5]))
        if z >= 0.5 * x:
            return mode, _in_plane(motions)
    return None, None


def _in_plane(motions: np.ndarray) -> np.ndarray:
    """Return (z, thx) of the combination of a pair that moves in the z plane."""
    if len(motions) == 1:
        return motions[0][list(PLANE)]
    # The pair spans both planes: take the unit combination without motion in the x plane.
    scale = np.abs(motions).max(axis=0)
    x_plane = motions[:, [0, 5]] / np.where(scale[[0, 5]] > 0, scale[[0, 5]], 1.0)
    u, _, _ = np.linalg.svd(x_plane)
    mix = u[:, -1]
    motion = mix @ motions[:, list(PLANE)]
    return motion if motion[0] >= 0 else -motion


def _static_shapes(body: Body, supports, index: int):
    """Return the group of the z plane and the displacements under unit (F_z, M_x) at a port."""
    spring, _ = decoupled(body, supports, 1e-6)
    for group in groups(body, supports, spring):
        if any(2 in body.blocks[b].components for b in group):
            supported = Supported(body, supports, spring, group)
            parts = []
            for b in group:
                block = body.block(b)
                rows = np.zeros((2, block.size))
                n = len(block.components)
                for r, c in enumerate(PLANE):
                    if c in block.components:
                        rows[r] = (
                            block.ports[index * n + block.components.index(c)].toarray().ravel()
                        )
                parts.append(rows)
            return supported, supported.static(np.hstack(parts).T)
    raise SolidgearError(f"the {body.fidelity} body has no bending plane")


def _guyan(body: Body, supports, index: int, compliance: np.ndarray) -> np.ndarray:
    """Compute the mass on the static shapes of unit (z, phi) at the lumped point, no load elsewhere
    (Guyan 1965).
    """
    supported, fields = _static_shapes(body, supports, index)
    shapes = fields @ np.linalg.inv(compliance)
    m = shapes.T @ supported.mass(shapes)
    return (m + m.T) / 2
