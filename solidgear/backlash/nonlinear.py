"""A train whose teeth have backlash, over speed, from a path, tables or an object."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias, Unpack

from solidgear.backlash import train as study
from solidgear.backlash.periodic import Backlash
from solidgear.backlash.speed_run import ramp_of, speed_run
from solidgear.backlash.study import BacklashStudy
from solidgear.core import SceneError, Sheeted, SolidgearError, Source, show
from solidgear.core.scene.units import quantity
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.assembly.slips import unit_slips
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.tables import TEETH
from solidgear.trains.file.train import Train, named_pair
from solidgear.trains.options import Models, Reducing, Settings, assembled
from solidgear.trains.options import mix as read_mix

#: speeds of a sweep in time, and mean forces of a map: each takes seconds
MOST_RUNS = 200
#: at which branches apart are looked for
SPEEDS = 32
#: a text with a unit or a number in SI; None where it is not given
Quantity: TypeAlias = str | float | None


@dataclass(frozen=True, eq=False, repr=False)
class Nonlinear(Sheeted):
    """A train with backlash over speed, with the train that was solved."""

    sheeted: ClassVar[str] = "backlash.sheet:nonlinear_sheet"

    assembly: Assembly
    study: BacklashStudy
    cautions: tuple[str, ...]

    @property
    def judge(self) -> Backlash:
        """The first mix of models."""
        return self.study.judge

    @property
    def sentences(self) -> list[str]:
        """Conclusions."""
        return self.study.sentences()


def nonlinear(
    train: Source | Train,
    models: Models = None,
    *,
    settings: Settings = None,
    backlash: Quantity = None,
    mean_force: Quantity = None,
    error: Quantity = None,
    mesh: str | None = None,
    min_frequency: float | None = None,
    against: Iterable[str | Sequence[str]] | None = None,
    apart: int = SPEEDS,
    in_time: int = 0,
    run_up: Iterable[float] = (),
    contact_loss: float | None = None,
    forces: int = 0,
    progress: Callable[[str], None] = lambda text: None,
    **reduced: Unpack[Reducing],
) -> Nonlinear:
    """Teeth with backlash: where they part, jumps over speed, and the error of the linear answer.

    Parameters
    ----------
    train, models, settings, **reduced
        As of :func:`solidgear.system_modes`.
    backlash, mean_force, error : str or float, optional
        Backlash along the line of action, mean force of the teeth, and transmission error, as
        ``"100 um"`` or numbers in SI; by default those of the train.
    mesh : str, optional
        Mesh that they belong to, whose transmission error drives the train; the first by default.
    min_frequency : float, optional
        Hz; a hundredth of the highest by default.
    against : iterable of str, optional
        Further models to judge, such as ``"euler+euler"``; lumped and Timoshenko shafts by default.
    apart : int
        Speeds at which separate branches are searched; 0 for none.
    in_time : int
        Speeds at which the motion is checked by integration in time.
    run_up : iterable of float
        Rates, rpm/s of the engine's shaft, of runs through the range in time.
    contact_loss : float, optional
        Hz at which a damper in contact only has the loss factor of the mesh.
    forces : int
        Mean forces for a map of jumps over speed and torque.
    progress : callable
        Called with a sentence at every step.

    Returns
    -------
    Nonlinear
        ``judge``, the branch by the first models, and ``sentences``; ``write(folder)`` makes a page,
        the branch and its chart.

    Raises
    ------
    SolidgearError
        For a train without backlash, unknown shafts or models, and numbers that are not usable.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.nonlinear("geometry/axle_overhung.toml", "lumped", against=(), apart=0,
    ...     backlash="100 um", mean_force="5 kN", max_frequency=500.0)
    >>> bool(found.judge.teeth.mean_force == 5000.0)
    True
    """
    assembly, first = assembled(train, models, settings, reduced)
    driver = named_pair(assembly.train, mesh)
    # nonlinear motion sees the stiffness of its own teeth vary
    assembly = _over_cycle(assembly, driver)
    further_mixes = _usual(assembly)
    if against is not None:
        further_mixes = [
            tuple(assembly.models_by_shaft(read_mix(text)).values()) for text in against
        ]
    assembly = _with_teeth(assembly, driver, backlash, error)
    if contact_loss is not None and not contact_loss > 0:
        raise SolidgearError(f"`contact_loss` {contact_loss:g}: give a frequency above 0 Hz")
    teeth = study.teeth_of(
        assembly, _read("`mean_force`", mean_force, "load"), contact_loss, driver.name
    )
    for option, count in (("`apart`", apart), ("`in_time`", in_time), ("`forces`", forces)):
        if not 0 <= count <= MOST_RUNS:
            raise SolidgearError(f"{option} {count}: give 0 to {MOST_RUNS}")
    limit = reduced.get("max_frequency")
    low, high = study.ends(assembly, limit, min_frequency)
    passing = assembly.train.per_turn(driver)
    ramps = [ramp_of(rpm, passing, low, high) for rpm in run_up]
    judged = tuple(
        study.with_backlash(assembly, mix, teeth, limit, min_frequency, progress, apart)
        for mix in [first, *(mix for mix in further_mixes if mix != first)]
    )
    result = BacklashStudy(
        train=assembly.train,
        mixes=judged,
        lever=study.torque_of(assembly, driver.name, 1.0).torque,
        in_time=study.in_time(judged[0], in_time, progress) if in_time else (),
        over_force=study.over_force(judged[0], forces, progress) if forces else (),
        runs=tuple(speed_run(judged[0], ramp, progress) for ramp in ramps),
    )
    cautions = [*unit_slips(assembly), *assembly.cautions(*first)]
    if assembly.train.planetary:
        cautions.append("teeth of planets are springs that never part")
    cautions += _beside_torque(assembly, mean_force)
    return Nonlinear(assembly, result, tuple(cautions))


def _over_cycle(assembly: Assembly, driver: Pair) -> Assembly:
    """Return the same train with the stiffness of the driven teeth over their cycle, where they give it."""
    asked = assembly.asked_train
    if asked.point is None or named_pair(asked, driver.name).mesh.stiffness != TEETH:
        return assembly
    return assembly.with_train(assembly.teeth.over_cycle(asked.point, driver.name))


def _beside_torque(assembly: Assembly, mean_force: Quantity) -> list[str]:
    """Return cautions on further loads in a loop of meshes, which divide the torque differently."""
    point, looped = assembly.train.point, None in assembly.train.flows.values()
    if not looped or mean_force is not None or point is None or not (point.weight or point.force):
        return []
    return [
        "weight and forces on shafts, which change the force of each mesh in a loop, are left "
        "out; run solidgear deflect"
    ]


def _usual(assembly: Assembly) -> list[tuple[str, ...]]:
    """Return the models compared by default; shafts in a housing cannot be lumped."""
    usual = ("timoshenko",) if assembly.train.housed else ("lumped", "timoshenko")
    return [(model,) * len(assembly.train.shafts) for model in usual]


def _with_teeth(assembly: Assembly, driver: Pair, backlash: Quantity, error: Quantity) -> Assembly:
    """Return the same train with the given teeth of one mesh."""
    width, size = _read("`backlash`", backlash, "length"), _read("`error`", error, "length")
    if width is None and size is None:
        return assembly
    for option, value, text in (("`backlash`", width, backlash), ("`error`", size, error)):
        if value is not None and value < 0:
            raise SolidgearError(f"{option} {show(text, 40)}: it must not be negative")
    changes: dict[str, Any] = {} if width is None else {"backlash": width}
    if size is not None:
        changes["transmission_error"] = size
    meshes = [
        pair.mesh.with_changes(**changes) if pair.name == driver.name else pair.mesh
        for pair in assembly.train.pairs
    ]
    solved = assembly.train.solved_meshes
    train = assembly.train.with_changes(meshes=tuple(meshes))
    return assembly.with_train(train.with_solved_meshes(solved))


def _read(option: str, text: Quantity, dimension: str) -> float | None:
    """Return a quantity of an option in SI."""
    if text is None:
        return None
    try:
        return quantity(text, dimension)
    except SceneError as error:
        raise SolidgearError(f"{option} {show(text, 40)}: {error}") from None
