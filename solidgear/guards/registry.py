"""Every guard by its name.

A guard is a function of a :class:`~solidgear.guards.probe.Probe` that yields notices.  Limits were
measured by the scripts of ``validation/stability``; the name of the script stands beside its
number.
"""

from __future__ import annotations

from collections.abc import Callable

from solidgear.core.registry import added
from solidgear.guards import data, edges, elements, lumped, models
from solidgear.guards.notice import Notices
from solidgear.guards.probe import Probe

#: every guard by its name, in the order in which they speak
GUARDS: dict[str, Callable[[Probe], Notices]] = {
    guard.__name__: guard
    for guard in (
        data.load_case,
        data.units,
        data.doubtful_data,
        data.free_motions,
        data.oblique_softness,
        data.one_way,
        data.axial_support,
        data.split_pair,
        *added("guard").values(),
        models.beam_against_solid,
        models.slenderness,
        models.shoulder,
        edges.fillets,
        models.disc_head,
        models.thin_joint,
        models.point_beyond_surface,
        models.ovalising,
        models.spin,
        lumped.effective_mass,
        lumped.lumped_against_solid,
        lumped.frequency_range,
        elements.narrow_seat,
        elements.rigid_seats,
        elements.seats_on_joints,
        elements.linear_elements,
        elements.hexahedra_at_fillets,
        elements.nearly_incompressible,
        elements.uniform_at_shoulder,
        elements.memory,
        elements.renderer,
    )
}
