"""Compliance that harmonics n >= 2 add at the local mesh points of a train."""

from __future__ import annotations

from solidgear.core import System
from solidgear.core.reduction.waves import local_compliance
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.local import mesh_port, superelement_of
from solidgear.trains.file.pairs import Pair


def local_give(assembly: Assembly, system: System, pair: Pair) -> dict[str, float]:
    """Return the compliance of the harmonics at the point of a mesh under a constant force of its
    teeth, m/N, by shaft that has any.
    """
    compliance = {}
    ends = assembly.mesh_ends(pair, system.parts)
    for side, (_, vector) in zip(pair.shafts, ends):
        part = superelement_of(system.parts[side])
        if part is not None and mesh_port(pair) in part.ports:
            compliance[side] = local_compliance(part, mesh_port(pair), vector.normal)
    return compliance


def local_lines(assembly: Assembly, system: System) -> tuple[str, ...]:
    """Return the share of the harmonics at every mesh point in words; empty without any."""
    pairs = [pair for pair in assembly.train.pairs if pair.mesh.local_harmonics]
    return tuple(_local_line(assembly, system, pair) for pair in pairs)


def _local_line(assembly: Assembly, system: System, pair: Pair) -> str:
    compliance, suffix = local_give(assembly, system, pair), pair.label
    listed = ", ".join(map(str, sorted(pair.mesh.local_harmonics)))
    if not compliance:
        return (
            f"Local harmonics {listed}{' of' if suffix else ''}{suffix} are left out, since neither "
            "shaft is a harmonic solid."
        )
    share = 100 * sum(compliance.values()) * assembly.contacts[pair.name].stiffness
    values = ", ".join(f"{side} {value:.2e} m/N" for side, value in compliance.items())
    return (
        f"Local mesh point{suffix}: harmonics n = {listed} on one tooth pitch of the seat add "
        f"{values}, {share:.2g} % of the mesh compliance; a mesh stiffness found on whole elastic "
        "gears includes that already."
    )
