"""Matrices of a shaft, a train, a superelement or a system in the motions of its ports."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from solidgear.core import (
    LADDER,
    Body,
    Document,
    Scene,
    SolidgearError,
    System,
    as_supports,
    build,
    explained,
    is_train,
    listed,
    load,
    nearest,
    number_cautions,
    rubin,
    show,
)
from solidgear.core.body import Supports
from solidgear.core.body.supports import masses_alone
from solidgear.core.reduction.craig_bampton import craig_bampton
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.core.reduction.superelement import Superelement
from solidgear.core.scene.units import quantity
from solidgear.core.solve.spin import couplings
from solidgear.core.system.links import grounded
from solidgear.core.system.port_coordinates import port_coordinates
from solidgear.trains.assembly.assembly import KEPT, Assembly
from solidgear.trains.file.train import Train
from solidgear.trains.loading import load_train

CRAIG_BAMPTON, FREE_INTERFACE = "craig-bampton", "free-interface"
METHODS = (CRAIG_BAMPTON, FREE_INTERFACE)
#: name of a shaft among the parts
SHAFT = "shaft"
MODEL = "timoshenko"


@dataclass(frozen=True)
class Wanted:
    """What of a body is wanted in its matrices; options of :func:`port_matrices`."""

    model: str | Mapping[str, str] = ""
    modes: int = 0
    method: str = CRAIG_BAMPTON
    ports: tuple[str, ...] = ()
    bearings: bool | None = None
    speed: float | None = None  #: rad/s
    loss: float = 0.0

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise SolidgearError(
                f"method {show(self.method, 30)} is unknown{nearest(self.method, METHODS)}; use "
                f"{' or '.join(METHODS)}"
            )
        if not isinstance(self.modes, int) or self.modes < 0:
            raise SolidgearError(f"modes = {self.modes} is not a number of modes; give 0 or more")
        if self.modes == 0 and self.method == FREE_INTERFACE:
            raise SolidgearError(f"{FREE_INTERFACE} is a basis of modes; ask for 1 mode or more")
        if not (np.isfinite(self.loss) and 0 <= self.loss < 1):
            raise SolidgearError(f"loss = {self.loss}: a loss factor lies between 0 and 1")

    @property
    def most_modes(self) -> int | None:
        """Modes with the ports held; None to keep every coordinate of the basis."""
        return None if self.method == FREE_INTERFACE else self.modes

    def words(self, part: Superelement | None = None) -> str:
        """Return the basis in a sentence, with the modes that a superelement has."""
        if not self.modes:
            return "condensed to its points (Guyan): stiffness exact, mass in static shapes"
        if self.method == FREE_INTERFACE:
            return (
                f"free-interface (Rubin), {self.modes} modes of the free body and residual fields"
            )
        count = self.modes if part is None else part.size - 6 * len(part.ports)
        return f"Craig-Bampton, {min(count, self.modes)} modes with all points held"


def port_matrices(
    source: Any,
    *,
    model: str | Mapping[str, str] = "",
    modes: int = 0,
    method: str = CRAIG_BAMPTON,
    ports: str | Iterable[str] = (),
    bearings: bool | None = None,
    speed: float | str | None = None,
    loss: float = 0.0,
    **options: Any,
) -> PortMatrices:
    """Return mass and stiffness of a body in the motions of its ports, x y z thx thy thz of each.

    Parameters
    ----------
    source : path, dict, Scene, Train, Body, Superelement or System
    model : str or mapping, optional
        Model of the shaft, timoshenko by default; of a train by shaft.
    modes : int
        Modes beside the ports, no half of a pair; with none, the stiffness is exact and the mass
        that of static shapes. A superelement keeps all its coordinates unless modes are given.
    method : str
        ``craig-bampton``: modes with all ports held. ``free-interface``: modes of the free body (of
        a train: of every shaft) with residual fields, by :func:`solidgear.rubin`.
    ports : str or iterable of str, optional
        Ports to keep, of a train or a system as ``part.port``; all of a shaft and of all shafts by
        default.
    bearings : bool, optional
        Whether bearings hold the body. By default a shaft is free and a train is not: whoever takes
        a superelement of a shaft has bearings. Rigid masses on a shaft belong to it.
    speed : float or str, optional
        Of a shaft, rad/s or a text such as ``"3000 rpm"``, for the gyroscopic matrix.
    loss : float
        Loss factor of a shaft, for the damping; trains have losses in their file.
    **options
        Of the model, as :func:`solidgear.build` takes them.

    Returns
    -------
    PortMatrices

    Raises
    ------
    SolidgearError
        For a port that there is not, ports that cannot move apart, or unusable numbers.

    Examples
    --------
    >>> import solidgear as sg
    >>> gear = sg.port_matrices("geometry/gear_shaft.toml", ports=["gear"], bearings=True)
    >>> gear.stiffness.shape
    (6, 6)
    >>> scene = sg.load("geometry/gear_shaft.toml")
    >>> condensed = sg.condense(sg.build(scene, "timoshenko"), scene, port="gear").stiffness
    >>> bool(abs(gear.stiffness[0, 0] / condensed[0][0] - 1) < 1e-9)
    True
    """
    chosen = (ports,) if isinstance(ports, str) else tuple(ports)
    turning = None if speed is None else quantity(speed, "speed")
    wanted = Wanted(model, modes, method, chosen, bearings, turning, loss)
    if isinstance(source, PortMatrices):
        return source
    if isinstance(source, (Superelement, System)):
        if model or bearings is not None or speed is not None or loss or options:
            raise SolidgearError(
                f"a {type(source).__name__} takes modes and ports alone; it has a model already"
            )
        if isinstance(source, System):
            return _of_system(source, {}, wanted, modes)
        ports_of = _all_ports("body", source)
        return _of_system(System({"body": source}), ports_of, wanted, modes or None)
    if isinstance(source, Body):
        return _of_shaft(source, Supports((), np.zeros((0, 0))), wanted, "body")
    loaded = _loaded(source)
    with explained(source):
        if isinstance(loaded, Train):
            return _of_train(loaded, wanted, options)
        return _of_scene(loaded, wanted, options)


def _loaded(source: Any) -> Scene | Train:
    """Return the scene or the train of a path, tables or an object, bearings settled."""
    if isinstance(source, Train):
        return load_train(source)
    if isinstance(source, Scene):
        return load(source)
    if isinstance(source, (str, os.PathLike, Mapping, Document)):
        return load_train(source) if is_train(source) else load(source)
    raise SolidgearError(
        f"{type(source).__name__} has no matrices; give a file, its tables, a scene, a train, a "
        "superelement or a system"
    )


def read_shaft(source: Any) -> Scene:
    """Return the scene of one shaft; refuse a train."""
    loaded = _loaded(source)
    if isinstance(loaded, Train):
        raise SolidgearError(f"{loaded.name} is a train; this is for one shaft")
    return loaded


def _of_scene(scene: Scene, wanted: Wanted, options: dict) -> PortMatrices:
    """Return the matrices of a shaft by one model."""
    model = wanted.model or MODEL
    if not isinstance(model, str):
        raise SolidgearError("a shaft has one model, such as timoshenko; several are for trains")
    supports = as_supports(scene) if wanted.bearings else masses_alone(scene)
    matrices = _of_shaft(build(scene, model, **options), supports, wanted, scene.name)
    return replace(matrices, cautions=tuple(number_cautions(scene, model=model)))


def _of_shaft(body: Body, supports: Supports, wanted: Wanted, name: str) -> PortMatrices:
    """Return the matrices of a shaft with what holds it and the masses on it."""
    names = [port.name for port in body.ports]
    chosen = _chosen(wanted.ports or names, dict.fromkeys(names), name)
    springs = bool(np.any(supports.stiffness))
    needed = list(dict.fromkeys([*chosen, *supports.ports]))
    if wanted.method == FREE_INTERFACE:
        part = rubin(body, wanted.modes, needed)
    else:
        part = craig_bampton(body, max(wanted.modes, 1), needed)
    system = System({SHAFT: part}, grounded(SHAFT, supports))
    notes = [f"shaft by the model {body.fidelity}, {wanted.words(part)}"]
    notes.append(
        "held: stiffness of its bearings is included" if springs else "free: without its bearings"
    )
    if supports.inertia is not None and np.any(supports.inertia):
        notes.append("rigid masses on it are included")
    losses = {SHAFT: wanted.loss} if wanted.loss else None
    swirl: np.ndarray | None = None
    if wanted.speed is not None:
        if not any(block.swirl is not None for block in body.blocks):
            raise SolidgearError(
                f"the {body.fidelity} model gives no gyroscopic matrix; use timoshenko or harmonic"
            )
        coupling = couplings(body, supports, _unit_shapes(part))
        # d/dt of the kinetic energy counts the coupling twice
        swirl = 2 * wanted.speed * coupling
        notes.append(f"gyroscopic at {wanted.speed:.6g} rad/s about y")
    ends = {port: f"{SHAFT}.{port}" for port in chosen}
    return port_coordinates(system, ends, wanted.most_modes, losses, swirl, name, notes)


def _unit_shapes(part: Superelement) -> list[dict[int, np.ndarray]]:
    fields = part.expand(np.eye(part.size))
    return [
        {block: field[:, k] for block, field in fields.items() if field[:, k].any()}
        for k in range(part.size)
    ]


def _of_train(train: Train, wanted: Wanted, options: dict) -> PortMatrices:
    """Return the matrices of a train on its bearings, assembled, in the axes of the first shaft."""
    if wanted.speed is not None:
        raise SolidgearError("speed is for one shaft; shafts of a train turn at several")
    if wanted.loss:
        raise SolidgearError("loss is for one shaft; a train has [losses] in its file")
    reduction = "rubin" if wanted.method == FREE_INTERFACE else "craig_bampton"
    shaft_modes = max(wanted.modes, KEPT) if wanted.method == CRAIG_BAMPTON else wanted.modes
    models = wanted.model or MODEL
    by_shaft = (
        {side: models for side in train.shafts}
        if isinstance(models, str)
        else {side: models.get(side, MODEL) for side in train.shafts}
    )
    settings: dict[str | tuple[str, str], dict[str, Any]] = {
        model: LADDER[model].checked(options) for model in {*by_shaft.values()} if options
    }
    assembly = Assembly(train, reduction, shaft_modes, settings)
    system = assembly.system(*by_shaft.values(), bearings=wanted.bearings is not False)
    ends = {
        f"{side}.{station.name}": f"{side}.{station.name}"
        for side, scene in assembly.scenes.items()
        for station in scene.stations
    }
    all_ports = {end: end for part in system.parts for end in _all_ports(part, system.parts[part])}
    chosen = _chosen(wanted.ports or ends, all_ports, train.name)
    notes = [
        f"train: {', '.join(f'{side} {model}' for side, model in by_shaft.items())}, {wanted.words()}",
        "axes of the first shaft's scene",
        "held: bearings, mesh stiffness and springs are included"
        if wanted.bearings is not False
        else "free: without bearings, meshes included",
    ]
    losses = assembly.loss_factors()
    chosen_ends = {end: end for end in chosen}
    matrices = port_coordinates(
        system, chosen_ends, wanted.most_modes, losses, None, train.name, notes
    )
    return replace(matrices, cautions=assembly.cautions_at_rest(*by_shaft.values()))


def _of_system(
    system: System, ends: dict[str, str], wanted: Wanted, modes: int | None
) -> PortMatrices:
    """Return the matrices of a system that is assembled already."""
    all_ports = ends or {
        end: end for name, part in system.parts.items() for end in _all_ports(name, part)
    }
    chosen = _chosen(wanted.ports or all_ports, all_ports, "the system")
    notes = [wanted.words() if modes is not None else "every coordinate of the superelement"]
    return port_coordinates(system, {name: all_ports[name] for name in chosen}, modes, notes=notes)


def _all_ports(part: str, body: Any) -> dict[str, str]:
    """Return ``part.port`` by itself; of a body alone by the name of the port."""
    if part == "body":
        return {name: f"{part}.{name}" for name in body.ports}
    return {f"{part}.{name}": f"{part}.{name}" for name in body.ports}


def _chosen(wanted: Iterable[str], all_ports: Mapping[str, Any], name: str) -> list[str]:
    """Return wanted ports, each once; refuse one that there is not."""
    out = list(wanted)
    for port in out:
        if port not in all_ports:
            raise SolidgearError(
                f"{name} has no port {show(port, 40)}{nearest(port, all_ports)}; it has "
                f"{listed(all_ports, 12)}"
            )
        if out.count(port) > 1:
            raise SolidgearError(f"the port {port!r} is given twice; give it once")
    if not out:
        raise SolidgearError(f"{name} has no ports")
    return out
