"""Contact of a pair of cylindrical wheels without shafts."""

from __future__ import annotations

from collections.abc import Iterable

from solidgear.core import SolidgearError
from solidgear.core.gears.flank_shape import FlankShape
from solidgear.core.gears.wheel_pair import WheelPair
from solidgear.teeth.compliance.slices import HelicalSlices
from solidgear.teeth.contact.cycle import MeshCycle, mesh_cycle
from solidgear.teeth.contact.cylindrical import CylindricalPair
from solidgear.teeth.contact.local import Elasticity, LineContact
from solidgear.trains.file.flanks import ReliefTable
from solidgear.trains.file.mesh_teeth import reliefs
from solidgear.trains.file.tip_rules import cut_caution, is_cutting


def pair_contact(
    wheels: WheelPair, loads: Iterable[float], tip: float = 0.0, slices: int = 1
) -> tuple[MeshCycle, ...]:
    """Contact of the teeth of a pair of wheels over a mesh cycle, without shafts.

    Teeth have their compliance in plane strain of the whole wheel; straight teeth under an even load
    need one slice of the face.

    Parameters
    ----------
    wheels : WheelPair
        With their face widths.
    loads : iterable of float
        Normal forces for each metre of the face, N/m.
    tip : float
        Relief at the tips of both wheels, m, which begins where a second pair of teeth comes in.
    slices : int
        Of the face.

    Returns
    -------
    tuple of MeshCycle
        One for each load.

    Raises
    ------
    SolidgearError
        For wheels without a face width, or tips that cut into the other wheel.

    Examples
    --------
    Relief of the tips that is right for a load makes the transmission error small there:

    >>> import solidgear as sg
    >>> wheels = sg.WheelPair(*(sg.Wheel(z, 4e-3, face_width=20e-3) for z in (23, 57)))
    >>> (bare,), (relieved,) = (sg.pair_contact(wheels, [200e3], tip) for tip in (0.0, 10e-6))
    >>> bool(relieved.peak_to_peak < 0.2 * bare.peak_to_peak)
    True
    """
    first, second = wheels.first, wheels.second
    if not (first.face_width and second.face_width):
        raise SolidgearError("pair_contact: both wheels need a face_width")
    for k in range(2):
        if is_cutting(wheels, k):
            raise SolidgearError(cut_caution(wheels, k, ("first wheel", "second wheel")))
    face, base = min(first.face_width, second.face_width), first.base
    teeth = HelicalSlices.of(first, face, slices), HelicalSlices.of(second, face, slices)
    law = LineContact((Elasticity(), Elasticity()), (teeth[0].depth, teeth[1].depth))
    begin = reliefs(wheels, 0, ReliefTable(tip=tip))[0], reliefs(wheels, 1, ReliefTable(tip=tip))[0]
    shapes = FlankShape(face_width=face, tip=begin[0]), FlankShape(face_width=face, tip=begin[1])
    pair = CylindricalPair(wheels, teeth, law, shapes, slices=slices)
    return tuple(mesh_cycle(pair, load * face * base, base, slices) for load in loads)
