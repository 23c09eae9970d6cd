"""Guards on seats and elements of the solids, and on the machine that solves them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np

from solidgear.core import (
    LADDER,
    Quantity,
    SolidgearError,
    change,
    listed,
    number_cautions,
    without_axis,
)
from solidgear.core.elements import SOLVED_AS
from solidgear.core.judge.quantities import in_words
from solidgear.core.machine.memory import available_mb
from solidgear.core.meshing.corners import sharpest_corner
from solidgear.core.quantity import C_ZZ, FIRST_BENDING
from solidgear.core.scene.shaft import on_face
from solidgear.core.solve.backends import BACKENDS, INSTALL, missing
from solidgear.core.solve.backends.memory_law import law
from solidgear.core.solve.choice import FASTEST, SMALL
from solidgear.guards.notice import Notice, Notices, beyond, everything, solids
from solidgear.guards.probe import Probe

if TYPE_CHECKING:
    from solidgear.core.scene import Material

# odd_geometry.py's shaft, softer than a seat of half the diameter: 5 % in C_zz at a bearing, 1.2 %
# in C_thx at the lumped point; then 1 to 2 % more at each halving, without limit (ties.py)
NARROW, NARROW_POINT = (0.1, 5.0), (0.02, 1.2)


def narrow_seat(probe: Probe) -> Notices:
    """Yield notices on seats that tie like a line, those of one kind in one sentence."""
    narrow: dict[tuple[float, float], dict[str, float]] = {}
    for s in probe.seats:
        width = (s.hi - s.lo) / probe.diameter(s.y)
        rule = NARROW_POINT if s in probe.points else NARROW
        if width < rule[0] and s.attachment != "section" and not on_face(s):
            narrow.setdefault(rule, {})[s.name] = width
    for (limit, softer), seats in narrow.items():
        several = len(seats) > 1
        widths = listed([f"{width:.2g}" for width in seats.values()])
        yield Notice(
            "caution",
            probe.solids,
            f"the {'seats' if several else 'seat'} of {listed(map(repr, seats))} "
            f"{'are' if several else 'is'} {widths} diameters of the shaft wide: below {limit:g} "
            f"{'they tie' if several else 'it ties'} like a line, {softer:g} % softer than a seat "
            'of 0.5; give the real width, or attachment = "section"',
        )


def rigid_seats(probe: Probe) -> Notices:
    """Yield a notice on the change of numbers by rigid seats against averaged ones; rigid seats are
    the stiff bound, and what is held is meant to be rigid.
    """
    chosen = [
        repr(s.name)
        for s in probe.scene.stations
        if s.attachment == "rigid" and getattr(s, "hold", None) is None
    ]
    if not probe.scene.bearings or not chosen:
        return
    try:
        stiff = probe.tied("rigid")
    except SolidgearError:
        return  # seats of other bearings touch, and the scene does not ask for all of them rigid
    moved = {
        name: value
        for name in (C_ZZ, Quantity("C_thx"), FIRST_BENDING)
        if (value := change(stiff, probe.tied("average"), name)) is not None
    }
    words = ", ".join(
        f"{in_words(name, probe.main)} by {100 * value:+.3g} %" for name, value in moved.items()
    )
    if max(map(abs, moved.values()), default=0.0) > 0.01:
        yield Notice(
            "caution",
            solids(),
            f"rigid seats at {', '.join(chosen)}: against averaged ones, rigid seats everywhere "
            f'change {words}, limit 1 %; they are a stiff bound, use attachment = "average"',
        )


def seats_on_joints(probe: Probe) -> Notices:
    """Yield notices on rigid seats whose end decides numbers, a much softer material under it."""
    for sentence in number_cautions(probe.whole):
        yield Notice("caution", solids(), sentence)


# linear_elements.py: error in first bending over that of the quadratic element of the same shape at
# 9000 unknowns
LINEAR = {"tet4": ("tet10", 116), "hex8": ("hex20", 138)}


def linear_elements(probe: Probe) -> Notices:
    """Yield notices on elements that answer curvature with shear."""
    element, file = probe.body.mesh.get("element"), probe.whole.body
    if file is not None and file.element in SOLVED_AS:
        yield Notice(
            "fact",
            ("solid",),
            f"cells of {file.name} are {file.element}, which lock in bending, and are solved as "
            f"{SOLVED_AS[file.element]} with flat sides",
        )
    if element in LINEAR:
        better, factor = LINEAR[element]
        yield Notice(
            "caution",
            ("solid",),
            f"element = {element} has {factor} times the error of {better} in first bending at "
            f"9000 unknowns, more on longer cells; use {better}",
        )
    elif element == "Q1":
        yield Notice(
            "caution",
            ("harmonic",),
            "order = 1 is 4 % too stiff in bending where order 2 is within 0.03 %; use order = 2 or more",
        )


def hexahedra_at_fillets(probe: Probe) -> Notices:
    """Yield a notice on hexahedra whose layers do not converge beside fillets as error bars ask."""
    element, corners = str(probe.body.mesh.get("element", "")), probe.scene.outline.corners
    if probe.body.fidelity == "solid" and element.startswith("hex") and corners:
        names = ", ".join(f'{c.kind} "{c.name}"' for c in corners)
        yield Notice(
            "open",
            ("solid",),
            f"element = {element} converges unevenly at {names}, so that it has no error bar; use "
            "element = tet10, the default here, or the harmonic solid",
        )


# nearly_incompressible.py: share that the bending compliance lacks, over nu
NU = np.array([0.3, 0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999])
LOCKING = {
    "tet4": (0.079, 0.103, 0.142, 0.309, 0.712, 0.947, 0.993),
    "hex8": (0.0107, 0.0228, 0.0446, 0.145, 0.468, 0.855, 0.982),
    "Q1": (0.040, 0.053, 0.0755, 0.191, 0.597, 0.918, 0.989),
    "tet10": (2.2e-4, 5.5e-4, 8.9e-4, 1.6e-3, 3.1e-3, 8.5e-3, 0.032),
    "hex20": (4.8e-4, 1.2e-3, 2.2e-3, 5.5e-3, 0.0186, 0.056, 0.096),
    "hex27": (3.7e-4, 9.9e-4, 1.8e-3, 3.7e-3, 5.6e-3, 7.3e-3, 0.0114),
}
LOCKED, SOFT = 0.01, 0.45


def nearly_incompressible(probe: Probe) -> Notices:
    """Yield notices on elements that lock as nu goes to 1/2; the harmonic solid from order 2 on
    does not.
    """
    by_model = {"solid": _element_of_solid(probe), "harmonic": "Q5"}
    if probe.body.fidelity in solids():
        by_model[probe.body.fidelity] = probe.body.mesh["element"]
    if without_axis(probe.whole):
        del by_model["harmonic"]
    for material, owner in _soft_materials(probe):
        for model, element in by_model.items():
            error = locking(element, material.nu)
            if error > LOCKED:
                yield Notice(
                    beyond(error, probe.scene.ask.tolerance),
                    (model,),
                    f"nu = {material.nu:g} of {owner}: element {element} locks and is about "
                    f"{100 * error:.2g} % too stiff in bending, limit {100 * LOCKED:g} %; use "
                    f"{_locks_less(probe, material.nu)}",
                )


def _element_of_solid(probe: Probe) -> str:
    """Return the element of the 3D solid of a scene: that of the mesh file, or its default."""
    file = probe.whole.body
    if file is not None and file.element:
        return SOLVED_AS.get(file.element, file.element)
    return str(LADDER["solid"].given(probe.whole, {}).get("element", "hex20"))


def locking(element: str, nu: float) -> float:
    """Return the share of the bending compliance that an element lacks; 0 for elements that were
    not measured.
    """
    if element not in LOCKING:
        return 0.0
    return float(np.exp(np.interp(-np.log(0.5 - nu), -np.log(0.5 - NU), np.log(LOCKING[element]))))


def _soft_materials(probe: Probe) -> Iterator[tuple[Material, str]]:
    """Yield nearly incompressible materials, each with the part made of it."""
    body = probe.whole.body
    if body is not None and without_axis(probe.whole):
        groups = [g.label for g in body.groups] or [body.name]
        named = list(zip(body.materials(probe.whole.material), groups))
    else:
        named = [(s.material, f"segment {s.name!r}") for s in probe.scene.segments]
    first_owner = {material: owner for material, owner in reversed(named)}
    yield from ((material, owner) for material, owner in first_owner.items() if material.nu >= SOFT)


def _locks_less(probe: Probe, nu: float) -> str:
    """Return advice in place of an element that locks."""
    if not without_axis(probe.whole):
        return "the harmonic solid of order 3 or more"
    body = probe.whole.body
    better = "hex27" if body is not None and body.kind == "block" else "tet10"
    return f"{better}, which is {100 * locking(better, nu):.2g} % too stiff"


def uniform_at_shoulder(probe: Probe) -> Notices:
    """Yield a notice on a harmonic mesh that is not graded towards a re-entrant corner."""
    angle, exponent = sharpest_corner(probe.scene)
    if probe.body.mesh.get("layers") == 0 and not probe.body.mesh.get("plain") and exponent < 1:
        yield Notice(
            "caution",
            ("harmonic",),
            f"layers = 0 at a corner of {np.degrees(angle):.0f} degrees: the mesh converges with "
            f"order {2 * exponent:.2f}, whatever the elements' order; use layers = 2 or more",
        )


GOOD_TO = 1.5  # of the laws, whose estimates are 0.75 to 1.35 of analysis or measurement


def memory(probe: Probe) -> Notices:
    """Yield notices on the factor of the 3D solid: which program makes it, and whether it fits into
    memory.
    """
    try:
        size = probe.solid_size
    except SolidgearError as error:
        yield Notice("avoid", ("solid",), f"the 3D solid has no mesh: {error}")
        return
    largest = max(unknowns for unknowns, _ in size.matrices)
    absent, forced = [], os.environ.get("SOLIDGEAR_BACKEND")
    candidates = FASTEST if largest > SMALL else ("superlu",)
    if forced in BACKENDS:
        candidates = (forced,)
    for name in candidates:
        if not missing(name):
            break
        absent.append(INSTALL[name])
    need = float(f"{sum(law(name, *matrix) for matrix in size.matrices):.2g}")  # good to GOOD_TO
    free = available_mb()
    smaller = "the harmonic solid, or --set refinement=0.7"
    if not LADDER["harmonic"].can_model(probe.whole):
        smaller = " or ".join([*(m for m in probe.solids if m != "solid"), "a coarser mesh"])
    # a mesh file is the only mesh there is
    single = probe.body.fidelity == "solid" or getattr(probe.meshed.body, "one_mesh", False)
    article = "the" if single else "the default"
    yield Notice(
        "fact",
        ("solid",),
        f"{article} 3D solid, {size.unknowns} unknowns, is factored by {name} in about {need:.0f} MB"
        + (f"; faster: {absent[0]}" if absent else ""),
    )
    if free is not None and GOOD_TO * need > free:
        yield Notice(
            "avoid" if need > free else "caution",
            ("solid",),
            f"{article} 3D solid needs about {need:.0f} MB (to a factor of {GOOD_TO:g}), and "
            f"{free:.0f} MB are free; use {smaller}",
        )


def renderer(probe: Probe) -> Notices:
    """Yield a notice where no pictures can be drawn."""
    if find_spec("pyvista") is None:
        yield Notice(
            "fact",
            everything(),
            "pyvista is not installed: no pictures of modes will be drawn",
        )
