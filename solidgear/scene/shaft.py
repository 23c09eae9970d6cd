"""What builders and meshes see of a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from solidgear.scene import Bearing, PointMass, Port, Segment

#: what a scene is beyond its segments: nothing, features cut out of them, or a part from a file of
#: which they are the round part
ROUND, CUT, PART = "round", "cut", "part"


class Shaft(Protocol):
    """Segments end to end, and what is attached to them: a `Scene`, or something like it.

    Builders and meshers ask for no more than this.
    """

    @property
    def segments(self) -> tuple[Segment, ...]:
        """Segments from y = 0 on."""

    @property
    def stations(self) -> tuple[Port | Bearing | PointMass, ...]:
        """What is attached, the port first; each has name, y, lo, hi (m) and attachment."""

    @property
    def length(self) -> float:
        """Overall length, m."""


def shapes(scene: Shaft) -> tuple[str, ...]:
    """Shapes that a model may hold to stand for a scene.

    Parameters
    ----------
    scene : Shaft

    Returns
    -------
    tuple of {'round', 'cut', 'part'}
        What the scene is first.

    Examples
    --------
    >>> from solidgear import Scene, Segment
    >>> shapes(Scene.from_parts([Segment.cylinder("rod", length=0.3, diameter=0.06)]))
    ('round',)
    """
    body = getattr(scene, "body", None)
    if body is not None:
        return (PART, ROUND) if body.round else (PART,)
    return (CUT,) if getattr(scene, "features", ()) else (ROUND,)


def extras(scene: Shaft) -> str:
    """What a scene has that its segments do not show, in words; empty for a body of revolution.

    Parameters
    ----------
    scene : Shaft
    """
    body = getattr(scene, "body", None)
    more = (*getattr(scene, "features", ()), *([body] if body is not None else []))
    return ", ".join(f'{one.what} "{one.name}"' for one in more)
