"""Case of the loads of a shaft: which act, how much, at which speed, and for how long."""

from __future__ import annotations

from pydantic import model_validator

from solidgear.core.errors import SceneError
from solidgear.core.scene.places import Name
from solidgear.core.scene.typed import Model
from solidgear.core.scene.units import Hours, Ratio, Speed, TimeShare


class LoadCase(Model):
    """Loads of a shaft that act together.

    Attributes
    ----------
    name : str
        Name in results, and of ``--case``.
    loads : tuple of str or None
        Names of the loads that act; all by default.
    factors : dict of str to float
        Factors on loads by their names; one by default. A factor below zero turns a torque round:
        teeth press with their other flanks.
    speed : float or None
        Speed of the shaft, rad/s.
    share, hours : float or None
        Share of the time, or hours, in a duty table; of every case or of none.

    Raises
    ------
    SceneError
        Both a share and hours, and a share beyond 0 to 1.

    Examples
    --------
    >>> from solidgear import LoadCase
    >>> case = LoadCase(name="reverse", factors={"gear": -0.4}, speed="1500 rpm", share=0.2)
    >>> case.factor("gear"), case.factor("belt")
    (-0.4, 1.0)
    """

    #: name in results, and of --case
    name: Name
    #: names of the loads that act; by default all
    loads: tuple[str, ...] | None = None
    #: factors on loads, by their names; below zero a torque is turned round
    factors: dict[str, Ratio] = {}
    #: speed of the shaft, rad/s
    speed: Speed | None = None
    #: share of the time of a duty table; of every case or of none
    share: TimeShare | None = None
    #: hours of a duty table; of every case or of none
    hours: Hours | None = None

    @model_validator(mode="after")
    def _one_measure(self) -> LoadCase:
        if self.share is not None and self.hours is not None:
            raise SceneError("give either share or hours, not both", path=("share",))
        return self

    def factor(self, load: str) -> float:
        """Return the factor on a load by its name; zero of one that does not act.

        Parameters
        ----------
        load : str

        Returns
        -------
        float
        """
        if self.loads is not None and load not in self.loads:
            return 0.0
        return self.factors.get(load, 1.0)
