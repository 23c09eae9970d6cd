"""Rules that catalogue data of a bearing have to keep: what belongs together, and what fits."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from solidgear.errors import SceneError

if TYPE_CHECKING:
    from solidgear.scene.catalogue import Catalogue


def problems(data: Catalogue) -> Iterator[SceneError]:
    """Everything that is wrong with them, a sentence each."""
    if data.outer_diameter <= data.bore:
        yield SceneError(
            f"must be larger than the bore ({data.bore:.6g} m)", path=("outer_diameter",)
        )
        return
    yield from _belongs(data)
    yield from _fits(data)
    if data.load is not None and data.displacement is not None:
        yield SceneError("give either load or displacement, not both", path=("displacement",))


def _belongs(data: Catalogue) -> Iterator[SceneError]:
    """Keys that the kind or the arrangement has no use for."""
    kind = data.kind.replace("_", " ")
    if data.kind in ("spherical", "thrust_ball"):
        yield from _by_nature(data, kind)
    elif not data.angled:
        if data.contact_angle is not None:
            yield SceneError(
                f"a {kind} bearing has no contact angle of its own: leave it out, or write "
                f'kind = "{"angular_contact" if data.balls else "tapered"}"',
                path=("contact_angle",),
            )
        if data.arrangement not in ("single", "double_row"):
            yield SceneError(
                f"{kind} bearings have no contact angle to pair: write single or double_row",
                path=("arrangement",),
            )
        if data.preload is not None:
            yield SceneError(
                f"a {kind} bearing is not preloaded along y: write a negative clearance",
                path=("preload",),
            )
    elif data.arrangement == "double_row":
        yield SceneError(
            f"two rows of {kind} bearings are back_to_back, face_to_face or tandem",
            path=("arrangement",),
        )
    if data.one_sided and data.holds is None:
        yield SceneError(
            f"{data.arrangement} {kind} bearings hold the shaft in one direction only: "
            'write holds = "+y" if this one keeps the shaft from moving towards +y, else "-y", or '
            'for a pair arrangement = "O" or "X" above all tables',
            path=("holds",),
        )
    for key, allowed, owner in (
        ("conformity", data.grooved, "balls and spherical rollers"),
        ("element_length", not data.balls, "rollers"),
        ("speed", data.balls, "balls"),
    ):
        if getattr(data, key) and not allowed:
            yield SceneError(
                f"belongs to {owner}; a {kind} bearing has none: leave it out", path=(key,)
            )
    if data.preload_spring is not None and data.speed:
        yield SceneError(
            "a pair on a preload spring is solved at rest only: leave out speed, or the spring",
            path=("speed",),
        )
    if data.preload_spring is not None and (
        data.arrangement not in ("back_to_back", "face_to_face")
        or data.preload is None
        or data.preload.force is None
    ):
        yield SceneError(
            'presses one row of a pair with a force: it needs arrangement = "back_to_back" or '
            '"face_to_face" and a preload such as "500 N"',
            path=("preload_spring",),
        )


def _by_nature(data: Catalogue, kind: str) -> Iterator[SceneError]:
    """Keys that bearings of two rows of their own, and those for thrust alone, have no use for."""
    if data.kind == "spherical":
        kind = "spherical roller"
        refused = {
            "arrangement": "has two rows of its own",
            "preload": "is preloaded by a negative clearance and not along y",
            "profile": "has barrels, whose profile is their conformity",
        }
    else:
        refused = {
            "arrangement": "has one row and holds one way (of two, write holds at each)",
            "contact_angle": "stands at 90 degrees",
            "clearance": "has no clearance across the shaft",
            "shaft_interference": "is not made tighter by its fit",
            "housing_interference": "is not made tighter by its fit",
            "inner_ring_warmer": "is not made tighter by a warm shaft",
            "speed": "is computed at rest only, without what speed does to its balls",
        }
    for key, reason in refused.items():
        if getattr(data, key) != type(data).model_fields[key].get_default():
            yield SceneError(f"a {kind} bearing {reason}: leave it out", path=(key,))


def _fits(data: Catalogue) -> Iterator[SceneError]:
    """Sizes that leave no room for each other."""
    room = (data.outer_diameter - data.bore) / 2
    if data.element_diameter is not None and data.element_diameter >= room:
        yield SceneError(
            f"does not fit between bore and outer_diameter, {room:.6g} m apart",
            path=("element_diameter",),
        )
        return
    if data.element_length is not None and data.element_length > data.width:
        yield SceneError(
            f"must not be longer than the width ({data.width:.6g} m)", path=("element_length",)
        )
    pitch = data.pitch_diameter or (data.bore + data.outer_diameter) / 2
    if not data.bore < pitch < data.outer_diameter:
        yield SceneError(
            f"must lie between bore and outer_diameter ({data.bore:.6g} and "
            f"{data.outer_diameter:.6g} m)",
            path=("pitch_diameter",),
        )
    elif data.elements is not None and data.element_diameter is not None:
        most = int(math.pi / math.asin(min(data.element_diameter / pitch, 1.0)) + 1e-9)
        if data.elements > most:
            yield SceneError(
                f"more than fit on the pitch circle of {pitch:.6g} m: at most {most} elements of "
                f"{data.element_diameter:.6g} m",
                path=("elements",),
            )
