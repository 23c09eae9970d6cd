"""Steady motion of a train, by its transmission error or by forces on ports, from a path, tables or an
object.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from math import isfinite
from typing import Any, TypeAlias, Unpack

import numpy as np

from solidgear.core import DOF_NAMES, SolidgearError, Source, show
from solidgear.trains.assembly.orders import order_map
from solidgear.trains.file.train import Train
from solidgear.trains.modes.modes import train_modes
from solidgear.trains.options import Models, Reducing, Settings, assembled, mix
from solidgear.trains.response import receptance as ends
from solidgear.trains.response.at_speed import NEAR, at_speed
from solidgear.trains.response.loudest import loudest
from solidgear.trains.response.receptance import End
from solidgear.trains.response.respond import respond
from solidgear.trains.response.sheet import Receptances, Responses
from solidgear.trains.response.speed import Speed

#: forces by port and component, or texts such as ``gear.gear:z=100``, N and N m
Forces: TypeAlias = Mapping[str, float] | Iterable[str] | None
#: further models of all shafts, each in their sequence or as ``euler+euler``
Mixes: TypeAlias = Iterable[str | Sequence[str]]


def response(
    train: Source | Train,
    models: Models = None,
    *,
    against: Mixes = (),
    forces: Forces = None,
    together: bool = False,
    orders: int | None = None,
    speed: str | None = None,
    of: str | None = None,
    measured: str | os.PathLike | None = None,
    fit_speed: float | None = None,
    within: float | None = None,
    damping: str = "hysteretic",
    matched_at: float | None = None,
    mesh: str | None = None,
    settings: Settings = None,
    **reduced: Unpack[Reducing],
) -> Responses:
    """Steady response of a train to the transmission error: mesh force, reactions, motions.

    Parameters
    ----------
    train, models, settings, **reduced
        As of :func:`solidgear.system_modes`.
    against : iterable of str
        Further models of all shafts to solve as well, such as ``"euler+euler"``.
    forces : mapping of str to float, optional
        Forces on ports in place of the transmission error, such as ``{"gear.gear:z": 100.0}``, N
        and N m.
    together : bool
        Whether all meshes at the frequencies of the mesh drive, each at its phase.
    orders : int, optional
        Orders of the mesh in the map of orders.
    speed, of : str, optional
        Speed such as ``"3000 rpm"``, and its shaft; by default those of the operating point and the
        engine's shaft.
    measured : path, optional
        CSV file of a spectrum at this speed: frequency in Hz, amplitude.
    fit_speed : float, optional
        Share within which the speed is fitted to the mesh order in the spectrum.
    within : float, optional
        Share of a natural frequency within which an order is listed.
    damping : str
        ``"hysteretic"``, ``"viscous"``, ``"modal"`` or ``"literal"``.
    matched_at : float, optional
        Hz at which viscous losses match.
    mesh : str, optional
        Mesh whose transmission error drives the train; the first by default.

    Returns
    -------
    Responses
        ``responses``, that of the models first; ``write(folder)`` makes a page, tables and charts.

    Raises
    ------
    SolidgearError
        For unknown shafts, ports, meshes and models, and together with forces, or with meshes whose
        phases the file leaves open.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.response("geometry/axle_overhung.toml", "timoshenko", max_frequency=1000.0)
    >>> peak = found.responses[0].peaks[0]
    >>> peak.mode, round(peak.frequency_hz)
    ('load torsion 1', 16)
    """
    assembly, first = assembled(train, models, settings, reduced)
    at = Speed(speed, of, measured, fit_speed, within)
    (turns, origin), spectrum = at.turns(assembly.train), at.spectrum()
    driver = assembly.train.named_mesh(mesh)
    limit = reduced.get("max_frequency")
    on_ports = _forces(forces)
    if on_ports and together:
        raise SolidgearError("`together` adds up errors of meshes, and `forces` takes their place")
    options = {"highest_hz": limit, "mesh": driver.name, **_losses(damping, matched_at)}
    options["together"] = together
    responses = [
        respond(assembly, *names, forces=on_ports, turns=turns or None, **options)
        for names in [first, *map(mix, against)]
    ]
    # a force on a port has no order of the mesh
    lines = None if on_ports else order_map(assembly, *first, mesh_orders=orders, **options)
    modes = (lines or train_modes(assembly, *first, max_frequency=limit)).modes
    share = NEAR if within is None else within
    given = None
    if turns:
        given = at_speed(assembly.train, modes, turns, origin, share, spectrum, fit_speed)
    title = assembly.train.called
    if together:
        title += f", driven by all meshes at the frequencies of the {driver.name}"
    elif driver.label and not on_ports:
        title += f", driven by the {driver.name}"
    return Responses(
        assembly=assembly,
        title=title,
        teeth=assembly.train.per_turn(driver),
        responses=responses,
        loudest=loudest(
            responses[0], modes, assembly.train, assembly.scenes, not on_ports, driver.name
        ),
        orders=lines,
        speed=given,
    )


def receptance(
    train: Source | Train,
    from_: str | End,
    to: str | End,
    models: Models = None,
    *,
    against: Mixes = (),
    damping: str = "hysteretic",
    matched_at: float | None = None,
    mesh: str | None = None,
    settings: Settings = None,
    **reduced: Unpack[Reducing],
) -> Receptances:
    """Receptance between any two ports of a train.

    Parameters
    ----------
    train, models, settings, **reduced
        As of :func:`solidgear.system_modes`.
    from_, to : str
        Where a unit force acts and where the motion is read, as port and component in the axes of
        the port's own shaft, such as ``"gear.gear:z"``.
    against, damping, matched_at
        As of :func:`solidgear.response`.
    mesh : str, optional
        Mesh whose teeth give speeds; the first by default.

    Returns
    -------
    Receptances
        ``receptances``, that of the models first, each with ``frequency_hz`` and ``value``;
        ``write(folder)`` makes a page, a table and a chart.

    Raises
    ------
    SolidgearError
        For unknown ports, directions in which a port does not move, and ends that do not move each
        other.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.receptance("geometry/axle_overhung.toml", "gear.gear:z", "pinion.pinion:x",
    ...     "timoshenko", max_frequency=1000.0).receptances[0]
    >>> found.unit, [mode for _, _, mode in found.peaks][:2]
    ('m/N', ['load torsion 1', 'gear torsion 1'])
    """
    assembly, first = assembled(train, models, settings, reduced)
    begin, end = _end("`from_`", from_), _end("`to`", to)
    limit, losses = reduced.get("max_frequency"), _losses(damping, matched_at)
    receptances = [
        ends.receptance(assembly, *names, from_=begin, to=end, highest_hz=limit, **losses)
        for names in [first, *map(mix, against)]
    ]
    teeth = assembly.train.per_turn(assembly.train.named_mesh(mesh))
    return Receptances(assembly, receptances, teeth)


def _losses(damping: str, matched_at: float | None) -> dict[str, Any]:
    """Return the kind of losses, and the Hz at which viscous ones match."""
    return {"damping": damping, "matched_hz": matched_at or 0.0}


def _forces(given: Forces) -> dict[str, np.ndarray]:
    """Return six components at ports, from texts such as ``gear.gear:z=100`` or a mapping."""
    if isinstance(given, Mapping):
        given = [f"{end}={float(value)!r}" for end, value in given.items()]
    out: dict[str, np.ndarray] = {}
    for text in given or ():
        end, _, value = text.partition("=")
        try:
            number = float(value)
        except ValueError:
            number = float("nan")
        if not isfinite(number):
            raise SolidgearError(
                f"`forces` {show(text, 40)}: write PORT:COMPONENT=VALUE, such as gear.gear:z=100"
            )
        port, dof = _end("`forces`", end, "=100")
        out.setdefault(port, np.zeros(6))[DOF_NAMES.index(dof)] += number
    return out


def _end(option: str, text: str | End, more: str = "") -> End:
    """Read port and component from a text such as ``gear.gear:z``; `more` completes the example in
    an error.
    """
    port, dof = text.partition(":")[::2] if isinstance(text, str) else text
    if not port or dof not in DOF_NAMES:
        raise SolidgearError(
            f"{option} {show(text, 40)}: write PORT:COMPONENT{'=VALUE' if more else ''}, such as "
            f"gear.gear:z{more}; components are {' '.join(DOF_NAMES)}"
        )
    return port, dof
