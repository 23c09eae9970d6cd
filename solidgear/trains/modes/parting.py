r"""Linear mesh forces compared with mean ones: where teeth part, and linear answers end.

Teeth press by the mean force and the dynamic one, ``F + sum_n Re(P_n exp(i (n x + phi_n)))`` over
the angle x of the mesh cycle, with the phases ``phi_n`` of the transmission error.  Where that is
negative at any angle they part.  The force ``k (dte - e)`` of a response is positive where teeth of
planets press, and where those of two shafts are relieved: ``P_n`` is as large with either sign.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from solidgear.core import SolidgearError
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import PlanetMesh
from solidgear.trains.load.operation import mean_forces
from solidgear.trains.response.drive import Drive
from solidgear.trains.response.response import figures

#: angles of the mesh cycle at which several orders are added
ANGLES = 256


def teeth_relief(drive: Drive, forces: Sequence[np.ndarray]) -> np.ndarray:
    """Return the (f,) largest force that the orders (f,) of a response take off the teeth that
    drive it, N.
    """
    sign = 1.0 if isinstance(drive.pair, PlanetMesh) else -1.0
    return largest_relief([sign * force for force in forces], drive.excitation.phases)


def largest_relief(forces: Sequence[np.ndarray], phases: Sequence[float] = ()) -> np.ndarray:
    """Return the (f,) largest force by which pressing orders (f,) take load off teeth over their
    cycle, N; an order without a number has none.
    """
    orders = np.nan_to_num(np.array(forces))
    if len(orders) == 1:
        return np.abs(orders[0])
    number = np.arange(1, len(orders) + 1)
    angle = 2 * np.pi * np.arange(ANGLES) / ANGLES
    turn = np.exp(1j * (np.outer(angle, number) + (phases or np.zeros(len(orders)))))
    return -(turn @ orders).real.min(axis=0)


def parting_frequency(frequency_hz: np.ndarray, relief: np.ndarray, mean: float) -> float | None:
    """Return the lowest frequency at which more than the mean force is taken off teeth,
    interpolated; None for nowhere.
    """
    parted = np.flatnonzero(relief > mean)
    if not len(parted):
        return None
    k = int(parted[0])
    if k == 0:
        return float(frequency_hz[0])
    share = (mean - relief[k - 1]) / (relief[k] - relief[k - 1])
    return float(frequency_hz[k - 1] + share * (frequency_hz[k] - frequency_hz[k - 1]))


def joint_name(mesh: Pair | PlanetMesh) -> str:
    """Return the name that the mean force of a mesh is stored by: of planets that of their stage."""
    return mesh.stage.name if isinstance(mesh, PlanetMesh) else mesh.name


def parting_lines(
    drive: Drive, frequency_hz: np.ndarray, columns: Mapping[str, np.ndarray]
) -> Iterator[str]:
    """Yield sentences on meshes whose teeth part at the operating point of a train, from the
    columns of the response.
    """
    assembly, train = drive.assembly, drive.assembly.train
    if (point := train.point) is None:
        return
    try:
        mean = mean_forces(assembly, point)
    except SolidgearError as error:
        yield f"Whether teeth part is not known: {error}."
        return
    for name, hz in _lowest(drive, frequency_hz, columns, mean).items():
        is_stage = name in {stage.name for stage in train.stages}
        suffix = "" if name == "mesh" else f" of the {name}"
        if not mean[name]:
            yield (
                f"No torque passes the {name} at {point.label}: its teeth part at any speed, and "
                "its linear forces are wrong."
            )
            continue
        rpm = ""
        if not drive.forces:
            teeth = train.per_turn(drive.pair)
            rpm = f" ({60 * hz / teeth:.0f} rpm of the {teeth.of})"
        ask = "no model here follows planets that part" if is_stage else "run solidgear nonlinear"
        yield (
            f"The teeth{suffix} part from {hz:.0f} Hz{rpm} or before, where the dynamic force passes "
            f"the mean force of {figures(mean[name])} N at {point.label}: linear forces are wrong "
            f"from there on; {ask}."
        )


def _lowest(
    drive: Drive,
    frequency_hz: np.ndarray,
    columns: Mapping[str, np.ndarray],
    mean: Mapping[str, float],
) -> dict[str, float]:
    """Return the lowest frequency at which teeth part, Hz, by joint."""
    driven = [name for name in columns if name.startswith(("mesh force [", "mesh force, order"))]
    teeth = drive.assembly.train.teeth
    reliefs = [(joint_name(drive.pair), teeth_relief(drive, [columns[n] for n in driven]))]
    reliefs += [
        (joint_name(mesh), np.abs(columns[f"mesh force{mesh.label} [N]"]))
        for mesh in teeth
        if f"mesh force{mesh.label} [N]" in columns and mesh.name != drive.first
    ]
    out: dict[str, float] = {}
    for name, relief in reliefs:
        low = parting_frequency(frequency_hz, relief, mean[name])
        if low is not None:
            out[name] = min(low, out.get(name, low))
    return out
