"""Statuses of the values of a train: published, measured, identified or assumed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from solidgear.scene.train import Train


def statuses_of(train: Train) -> dict[str, str]:
    """Status of every value of the file that has one, by its key."""
    out: dict[str, Any] = {}
    for pair in train.pairs:
        mesh, name = pair.mesh, pair.name
        line = "line_of_action" if mesh.line_of_action else "contact_cells"
        line = "pressure_angle" if not (mesh.line_of_action or mesh.contact_cells) else line
        out[f"{name}.stiffness"] = mesh.status
        out[f"{name}.{line}"] = mesh.line_of_action_status
        if mesh.transmission_error is not None:
            out[f"{name}.transmission_error"] = mesh.transmission_error_status
    for name, rotor in train.rotors.items():
        out[f"{name}.inertia"] = rotor.status
        out[f"{name}.spring.stiffness"] = rotor.spring.status
    for name, table in train.planetary.items():
        out |= {f"{name}.mesh": table.mesh.status, f"{name}.planet": table.planet.status}
        if table.ring is not None:
            out[f"{name}.ring"] = table.ring.status
    out["losses"] = train.losses.status
    if train.housing is not None:
        out["housing"] = train.housing.status
        out |= {f"mount {name}": mount.status for name, mount in train.housing.mounted.items()}
    for side, shaft in train.shafts.items():
        for end, (_, head) in train.heads(side).items():
            out[end] = head.status
        for bearing in shaft.scene.bearings:
            out[f"{side} bearing {bearing.name}"] = bearing.status
    return {key: str(status) for key, status in out.items()}
