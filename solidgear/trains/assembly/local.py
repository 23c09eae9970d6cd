r"""Harmonics n >= 2 at a local mesh point: modes that averaged ports cannot drive.

The teeth push on a patch, one tooth pitch of the circumference over the seat of the lumped point,
and not on the mean of a ring.  The part of that push which has n = 0 and 1 waves around is what the
port takes, moment included; harmonics from 2 on come in by coordinates of their own.  The mesh then
stretches by

    dte = h_p q_p + n u_p - h_g q_g - n u_g,

u the mean motion of each patch by the harmonics.  With none of them, and on a rigid shaft, that is
the present model.

A mesh stiffness that was found on whole elastic gears holds the static give of these harmonics
already; the compliance that they add is printed, so that it can be taken out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from solidgear.core import Body, Scene, SolidgearError, modes
from solidgear.core.models.harmonic.patch import Patch, PatchMotion
from solidgear.core.reduction.superelement import Superelement
from solidgear.core.reduction.waves import own_waves, with_waves
from solidgear.core.system.parts import Part, Placed
from solidgear.trains.file.pairs import Pair

#: port of a part at the point of the only mesh; no station can be called so, for names hold no dot
TEETH = "mesh.point"
#: waves around the axis that are looked for among those that nothing drives, at most
MOST_WAVES = 16
#: a light mesh finds the lowest frequency of a family too high by less than this
LIGHT = 1.15
#: modes of a family that are looked for
FEW = 8


def mesh_port(pair: Pair) -> str:
    """Return the name of a part's port at the mesh point of a gear."""
    return TEETH + pair.label


def patch_of(pair: Pair, side: str, scene: Scene, point: np.ndarray) -> Patch:
    """Return the patch of a shaft that teeth push on: one tooth pitch around the mesh point (3,),
    m, from the lumped point in the axes of the scene, over the seat of the gear.
    """
    first = side == pair.shafts[0]
    seat = next(s for s in scene.stations if s.name == pair.ports[not first])
    angle = float(np.arctan2(point[0], point[2]))
    return Patch(seat.lo, seat.hi, angle, 2 * np.pi / (pair.pinion if first else pair.gear).teeth)


def local_teeth(
    side: str,
    scene: Scene,
    part: Part,
    body: Body,
    meshes: Sequence[tuple[Pair, np.ndarray]],
) -> Superelement:
    """Add to a shaft the harmonics that the teeth drive, and the port of each mesh; a seat that is
    tied rigidly has no waves and is refused.
    """
    assert isinstance(part, Superelement)
    rigid = [s.name for s in scene.stations if s.attachment == "rigid"]
    if rigid:
        raise SolidgearError(
            f"[mesh] local_harmonics: the seat {rigid[0]} of the {side}'s shaft is tied rigidly, "
            "which suppresses all waves around it; use attachment average or section"
        )
    seats: dict[tuple[str, int], np.ndarray] = {}
    mesh_ports = []
    for pair, point in meshes:
        patch, port = patch_of(pair, side, scene, point), pair.ports[side != pair.shafts[0]]
        motion = PatchMotion(scene, body, patch)
        rows = {n: motion.rows(n) for n in sorted(pair.mesh.local_harmonics)}
        seats |= {(port, n): seat_rows for n, seat_rows in rows.items()}
        mesh_ports.append((port, point, patch.axes, rows, mesh_port(pair)))
    # gears of one shaft squeeze it together: fields of all seats that drive a harmonic
    waves = {n for _, n in seats}
    fields = {
        n: np.vstack([seat_rows for (_, m), seat_rows in seats.items() if m == n]) for n in waves
    }
    for port, point, axes, rows, name in mesh_ports:
        part = with_waves(part, body, port, point, axes, rows, name, fields=fields)
    return part


def superelement_of(part: Part) -> Superelement | None:
    """Return the superelement that a part is, or is placed from; None for another kind."""
    inner = part.part if isinstance(part, Placed) else part
    return inner if isinstance(inner, Superelement) else None


def waves_of(part: Part) -> dict[int, np.ndarray]:
    """Return the coordinates of the harmonics n >= 2 of a part, by n."""
    inner = superelement_of(part)
    return {} if inner is None else own_waves(inner)


def undriven(
    body: Body, highest_hz: float, driven: tuple[int, ...] = ()
) -> dict[int, tuple[float, ...]]:
    """Return the free modes with two and more nodal diameters that no port of a harmonic solid
    drives, Hz, by their number of waves; driven harmonics are left out.
    """
    if body.further is None:
        return {}
    out = {}
    for n in _reaching(body.further, highest_hz):
        if n in driven:
            continue
        frequencies = modes(body.family(n), (), n=2 * FEW).frequency_hz
        low = tuple(float(hz) for hz in frequencies if hz <= highest_hz)
        if low:
            out[n] = low
    return out


def _reaching(further, highest_hz: float):
    """Yield numbers of waves whose first mode may lie below a frequency."""
    light: Callable[[int], float] = further.light
    for n in range(2, MOST_WAVES + 1):
        if further.bound(n) > highest_hz:
            return
        if light(n) < LIGHT * highest_hz:
            yield n
