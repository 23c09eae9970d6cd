r"""Linear mesh forces beside mean ones: where teeth part, and linear answers end.

Teeth press by the mean force and the dynamic one, ``F + sum_n Re(P_n exp(i (n x + phi_n)))`` over
the angle x of the mesh cycle, with the phases ``phi_n`` of the transmission error.  Where that is
negative at any angle they part.  The force ``k (dte - e)`` of a response is positive where teeth of
planets press, and where those of two shafts are relieved: ``P_n`` is as large with either sign.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from solidgear.errors import SolidgearError
from solidgear.scene.gears import Pair
from solidgear.scene.planetary import PlanetMesh
from solidgear.studies.train.operation import mean_forces
from solidgear.studies.train.response import figures

if TYPE_CHECKING:
    from solidgear.studies.train.respond import Drive

#: angles of the mesh cycle at which several orders are added
ANGLES = 256


def taken_off(drive: Drive, forces: Sequence[np.ndarray]) -> np.ndarray:
    """(f,) largest force that the orders (f,) of a response take off the teeth that drive it, N."""
    way = 1.0 if isinstance(drive.pair, PlanetMesh) else -1.0
    return released([way * force for force in forces], drive.error.phases)


def released(forces: Sequence[np.ndarray], phases: Sequence[float] = ()) -> np.ndarray:
    """(f,) largest force by which pressing orders (f,) take load off teeth over their cycle, N; an
    order without a number has none.
    """
    orders = np.nan_to_num(np.array(forces))
    if len(orders) == 1:
        return np.abs(orders[0])
    number = np.arange(1, len(orders) + 1)
    angle = 2 * np.pi * np.arange(ANGLES) / ANGLES
    turn = np.exp(1j * (np.outer(angle, number) + (phases or np.zeros(len(orders)))))
    return -(turn @ orders).real.min(axis=0)


def parts_from(frequency_hz: np.ndarray, released: np.ndarray, mean: float) -> float | None:
    """Lowest frequency at which more than the mean force is taken off teeth, between those given."""
    beyond = np.flatnonzero(released > mean)
    if not len(beyond):
        return None
    k = int(beyond[0])
    if k == 0:
        return float(frequency_hz[0])
    share = (mean - released[k - 1]) / (released[k] - released[k - 1])
    return float(frequency_hz[k - 1] + share * (frequency_hz[k] - frequency_hz[k - 1]))


def joint_of(mesh: Pair | PlanetMesh) -> str:
    """Name by which the mean force of a mesh is told: of planets that of their stage."""
    return mesh.stage.name if isinstance(mesh, PlanetMesh) else mesh.name


def parting_lines(
    drive: Drive, frequency_hz: np.ndarray, columns: Mapping[str, np.ndarray]
) -> Iterator[str]:
    """Sentences on meshes whose teeth part at the operating point of a train, from the columns of its
    response.
    """
    shop, train = drive.workshop, drive.workshop.train
    if (point := train.point) is None:
        return
    try:
        mean = mean_forces(shop, point)
    except SolidgearError as error:
        yield f"Whether teeth part is not known: {error}."
        return
    for name, low in _lowest(drive, frequency_hz, columns, mean).items():
        planets = name in {stage.name for stage in train.stages}
        of = "" if name == "mesh" else f" of the {name}"
        if not mean[name]:
            yield (
                f"No torque passes the {name} at {point.label}: its teeth part at any speed, and its "
                "linear forces do not hold."
            )
            continue
        rpm = ""
        if not drive.forces:
            teeth = train.per_turn(drive.pair)
            rpm = f" ({60 * low / teeth:.0f} rpm of the {teeth.of})"
        ask = "no model here follows planets then" if planets else "ask solidgear nonlinear"
        yield (
            f"The teeth{of} part at the latest from {low:.0f} Hz{rpm}, where the dynamic force passes "
            f"the mean one, {figures(mean[name])} N at {point.label}: linear forces do not hold from "
            f"there on; {ask}."
        )


def _lowest(
    drive: Drive,
    frequency_hz: np.ndarray,
    columns: Mapping[str, np.ndarray],
    mean: Mapping[str, float],
) -> dict[str, float]:
    """Lowest frequency at which teeth part, Hz, by joint."""
    driven = [name for name in columns if name.startswith(("mesh force [", "mesh force, order"))]
    teeth = drive.workshop.train.teeth
    each = [(joint_of(drive.pair), taken_off(drive, [columns[n] for n in driven]))]
    each += [
        (joint_of(mesh), np.abs(columns[f"mesh force{mesh.label} [N]"]))
        for mesh in teeth
        if f"mesh force{mesh.label} [N]" in columns and mesh.name != drive.first
    ]
    out: dict[str, float] = {}
    for name, taken in each:
        low = parts_from(frequency_hz, taken, mean[name])
        if low is not None:
            out[name] = min(low, out.get(name, low))
    return out
