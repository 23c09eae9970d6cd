"""The load of a shaft alone: that of its scene at the port, and torques along the shaft."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from solidgear.core import DOF_NAMES, SolidgearError
from solidgear.show.units import Units
from solidgear.trains.assembly.components import FORCE_UNITS
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.train import ALONE, Train

#: operating point of a shaft alone: no torque, and the load of its scene
AT_REST = OperatingPoint(torque=0.0, of=ALONE)


@dataclass(frozen=True, eq=False)
class LoadAtPort:
    """Load of a scene at its port, and torques that the port takes out."""

    port: str
    load: np.ndarray  #: (6,) N and N m
    #: N m, by the place where each enters
    drive: Mapping[str, float] = field(default_factory=dict)

    def words(self, units: Units) -> str:
        """Return the load in words, such as ``Under z 2000 N at pinion``."""
        parts = [
            f"{name} {units.text(float(value), si, 4)}"
            for name, value, si in zip(DOF_NAMES, self.load, FORCE_UNITS)
            if value
        ]
        words = f"Under {', '.join(parts) or 'no force'} at {self.port}"
        for name, torque in self.drive.items():
            words += f", and {units.text(torque, 'N m', 4)} from {name} to {self.port}"
        return words


def load_alone(train: Train, drive: Mapping[str, float] | None = None) -> LoadAtPort | None:
    """Return the load of a shaft alone; None for a train, whose loads are those of its operating
    point. A shaft without load is refused, and a torque that enters where the port takes it out.
    """
    if not train.is_one_shaft:
        return None
    scene, drive = train.shafts[ALONE].scene, drive or {}
    port = scene.port.name
    if scene.load is None:
        raise SolidgearError(
            'there is no load; write [load] with forces at the port, such as z = "2 kN", or give '
            "`load`"
        )
    if port in drive:
        raise SolidgearError(
            f'the torque at "{port}" enters where the gear takes it out; name the bearing, mass '
            "or point of the coupling or spline"
        )
    return LoadAtPort(port, np.array(scene.load.six), drive)
