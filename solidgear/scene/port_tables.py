"""The tables of a scene file that say where it is looked at, and what its bearings stand in."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, Field, model_validator

from solidgear.errors import SceneError
from solidgear.scene.ask import Ask
from solidgear.scene.body_file import SeatTable
from solidgear.scene.housing import Elastic
from solidgear.scene.rules import ONE_HOUSING
from solidgear.scene.segment_tables import Name, Table
from solidgear.scene.stations import Attachment
from solidgear.scene.units import AxialSpring, Length


def _stands_in(given: dict[str, Any]) -> dict[str, Any]:
    elastic(given)
    return given


def elastic(given: Mapping[str, Any], kind: type[Elastic] = Elastic, **rest: Any) -> Any:
    """A housing from the entries of its table.

    Parameters
    ----------
    given : mapping
        Named entries of a 6x6, or ``matrix`` alone.
    kind : type of Elastic
    **rest
        Further fields of it.

    Returns
    -------
    Elastic

    Raises
    ------
    SceneError
        Under the keys of the table.
    """
    if not given:
        raise SceneError("is empty; write entries of its stiffness such as kxx, or matrix = rows")
    named = "matrix" not in given
    if not named and len(given) > 1:
        raise SceneError("give either matrix, or named entries, not both", path=("matrix",))
    try:
        return kind(stiffness=given if named else given["matrix"], **rest)
    except SceneError as error:
        raise SceneError.of(
            SceneError(one.reason, path=one.path[1:] if named else one.path, value=one.value)
            for one in error.problems
        ) from None


SeatHousing = Annotated[dict[str, Any], AfterValidator(_stands_in)]


class HousingTable(Table):
    """The [housing], its datum not yet resolved."""

    axial: AxialSpring | None = None
    stiffness: SeatHousing | None = None
    matrix: list[Any] | None = None
    position: Length | None = None
    from_: str | None = Field(None, alias="from")

    @model_validator(mode="after")
    def _one_stiffness_at_a_point(self):
        given = [k for k in ("axial", "stiffness", "matrix") if getattr(self, k) is not None]
        if not given:
            raise SceneError(
                "this key is missing; write stiffness = {kxx = ...} with position, or axial",
                path=("stiffness",),
            )
        if len(given) > 1:
            both = ONE_HOUSING if given[0] == "axial" else "give either stiffness or matrix"
            raise SceneError(both, path=(given[0],))
        if given == ["axial"]:
            for key in ("position", "from_"):
                if getattr(self, key) is not None:
                    raise SceneError(
                        "belongs to a stiffness; along the axis a spring has no place",
                        path=(key.rstrip("_"),),
                    )
        elif self.position is None:
            raise SceneError(
                'this key is missing; write position = "120 mm", the place on the axis that the '
                "stiffness is about, with from",
                path=("position",),
            )
        return self


class AskTable(Ask):
    """The [ask], with the lumped point that is the main one."""

    port: str | None = None


class PortTable(Table):
    """The [port], its datum and surface not yet resolved."""

    name: Name = "port"
    at: str | None = None
    position: Length | None = None
    from_: str | None = Field(None, alias="from")
    attach_to: str | None = None
    span: Annotated[list[Length], Field(min_length=2, max_length=2)] | None = None
    seat: SeatTable | None = None
    attachment: Attachment | None = None

    @model_validator(mode="after")
    def _one_place_one_surface(self):
        if self.seat is not None:
            for key in ("attach_to", "span"):
                if getattr(self, key) is not None:
                    raise SceneError(f"give either seat or {key}, not both", path=(key,))
        elif self.at is None and self.position is None:
            raise SceneError(
                'this key is missing; write at = "<segment>.middle", or position with from',
                path=("at",),
            )
        if self.at is not None and (self.position is not None or self.from_ is not None):
            raise SceneError("give either at, or position with from, not both", path=("at",))
        how = 'name the segment whose surface carries the port, or write span = ["0 mm", "58 mm"]'
        if self.seat is None:
            self._one_of("attach_to", "span", how)
        return self
