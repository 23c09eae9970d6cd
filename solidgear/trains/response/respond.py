"""Steady response of a train over frequency: columns, orders, and where its teeth part."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from solidgear.core import pinned
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.local_give import local_lines
from solidgear.trains.assembly.meshes import mesh_bars
from solidgear.trains.assembly.spin import spin_moved
from solidgear.trains.modes.parting import parting_lines
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.excitation import meeting_cautions
from solidgear.trains.response.response import TrainResponse

LITERAL = (
    "damping: C = zeta K takes the ratios as seconds, so that at {0:.0f} Hz the mesh has a loss "
    "factor of {1:.0f}; use --damping hysteretic (loss factors 2 zeta) unless this is wanted"
)


@pinned
def respond(
    assembly: Assembly,
    *models: str,
    highest_hz: float | None = None,
    damping: str = "hysteretic",
    matched_hz: float = 0.0,
    forces: Mapping[str, np.ndarray] | None = None,
    frequency_hz: np.ndarray | None = None,
    mesh: str | None = None,
    together: bool = False,
    turns: float | None = None,
) -> TrainResponse:
    """Compute the steady response of a train with the shafts by models, up to a frequency that is
    by default that of the file, on an adaptive grid unless frequencies are given; further
    arguments are those of :class:`Drive`. `turns` of the engine's shaft in a second, for the
    spin of modes, are by default those at the fastest operating point.

    Examples
    --------
    >>> import solidgear as sg
    >>> assembly = Assembly(sg.load_train("geometry/axle_overhung.toml"))
    >>> found = respond(assembly, "timoshenko", "timoshenko", highest_hz=1000.0)
    >>> found.peaks[0].mode, round(found.peaks[0].frequency_hz)
    ('load torsion 1', 16)
    """
    highest = highest_hz or assembly.highest_hz or assembly.train.ask.max_frequency
    assembly.follow(*models, highest_hz=highest)
    drive = Drive(
        assembly,
        *models,
        damping=damping,
        matched_hz=matched_hz,
        forces=forces,
        mesh=mesh,
        together=together,
    )
    hz = drive.grid(highest) if frequency_hz is None else np.asarray(frequency_hz, float)
    by_name = drive.columns(hz)
    driven = list(by_name)[:2]  # columns of the mesh that drives stand before its orders
    columns = {name: by_name.pop(name) for name in driven}
    for order, force in enumerate(drive.over_cycle(hz, highest)[1:], start=2):
        columns[f"mesh force, order {order} [N]"] = force
    columns |= by_name
    by_shaft = assembly.models_by_shaft(models)
    cautions = [*assembly.cautions(*models), *local_lines(assembly, drive.system)]
    spin = spin_moved(assembly, drive.system, by_shaft, highest, turns)
    cautions += [spin.sentence] if spin else []
    if not forces:
        cautions += meeting_cautions(assembly, drive.pair, together)
    if damping == "literal":
        limit_hz = float(highest)
        cautions.append(LITERAL.format(limit_hz, np.pi * limit_hz * assembly.train.losses.mesh))
    parting = tuple(parting_lines(drive, hz, columns))
    curves = tuple(drive.curve(hz, order) for order in range(1, drive.orders + 1))
    seconds = assembly.build_seconds(*models)
    return TrainResponse(
        models=by_shaft,
        damping=damping,
        frequency_hz=hz,
        columns=columns,
        orders=curves,
        parting=parting,
        cautions=tuple(cautions),
        seconds=seconds,
        bars=_bars_by_mode(drive, by_shaft, highest),
    )


def _bars_by_mode(drive: Drive, models: dict[str, str], highest_hz: float) -> dict[str, float]:
    """Return the error bars of the modes up to a frequency by the meshes of harmonic shafts."""
    below = int((drive.system.elastic[0] <= 2 * np.pi * highest_hz).sum())
    bars = mesh_bars(drive.assembly, drive.system, models, below) if below else None
    if bars is None:
        return {}
    modes, names = drive.named_modes(drive.reach(highest_hz))
    return dict(zip(names[modes.rigid :], bars.tolist()))
