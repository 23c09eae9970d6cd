"""Load of a shaft on a bearing or on the lumped point."""

from __future__ import annotations

from typing import Any

from solidgear.core.errors import SceneError, show
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import Newtons, Torque

#: names that people give a moment about the axis
ABOUT_AXIS = ("thy", "my", "ty", "torque", "torsion", "moment")


class BearingLoad(Model):
    """Load of the shaft on a bearing, or on the port: forces in N, moments in N m."""

    #: force along x, N
    x: Newtons = 0.0
    #: force along y, the axis, N
    y: Newtons = 0.0
    #: force along z, N
    z: Newtons = 0.0
    #: moment about x, N m; without one the ring of a bearing is held against tilting
    thx: Torque | None = None
    #: moment about z, N m; without one the ring of a bearing is held against tilting
    thz: Torque | None = None

    def __init__(self, /, **data: Any):
        about = [key for key in data if key.lower() in ABOUT_AXIS]
        if about:
            raise SceneError(
                "bearings carry no moment about the axis: write x, y, z, thx and thz alone; a torque "
                'is a [[load]] with on = "NAME" and torque = "115 N*m", or the operation of a train',
                path=(about[0],),
                value=show(data[about[0]]),
            )
        super().__init__(**data)

    @property
    def six(self) -> list[float]:
        """(6,) load in the order (x, y, z, thx, thy, thz), N and N m."""
        return [self.x, self.y, self.z, self.thx or 0.0, 0.0, self.thz or 0.0]

    @property
    def held_tilts(self) -> tuple[int, ...]:
        """Tilts without a given moment, by their place among the six."""
        return tuple(k for k, moment in ((3, self.thx), (5, self.thz)) if moment is None)
