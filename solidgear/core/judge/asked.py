"""Numbers of a scene in one call, on the cheapest mesh whose error bars are within its tolerance: as
the commands of the same names have them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypedDict, Unpack

from solidgear.core.body import Body, as_supports
from solidgear.core.body.supports import Holding
from solidgear.core.errors import SolidgearError, show
from solidgear.core.judge.hidden import complete_list
from solidgear.core.judge.settle import Settled, settle
from solidgear.core.ladder.registry import LADDER
from solidgear.core.loading import load
from solidgear.core.safety import ROOM
from solidgear.core.scene import Scene
from solidgear.core.scene.document import Source
from solidgear.core.scene.limits import MOST_MODES
from solidgear.core.solve import modes as solving
from solidgear.core.solve.condensed import Condensed, Coupled
from solidgear.core.solve.modes import ModeSet
from solidgear.core.solve.statics import condense


class Solving(TypedDict, total=False):
    """How modes of a body are solved, as of :func:`solidgear.core.solve.modes.modes`."""

    coupling_tolerance: float
    method: str | None
    count: bool
    ovalising: bool
    room: float
    stations: int


def modes(
    body: Body | Source,
    supports: Holding = (),
    n: int | None = None,
    *,
    max_frequency: float | None = None,
    tol: float | str | None = None,
    **how: Unpack[Solving],
) -> ModeSet:
    """Lowest modes of a shaft on its bearings, or of a body on any supports.

    Parameters
    ----------
    body : Body, or path, dict or Scene
        What `solidgear.build` makes; or a scene, whose modes are those of the command ``modes``: on
        the cheapest mesh within the tolerance.
    supports : Scene, Supports or iterable of bearings
        Of a body; by default it is free. A scene has its own.
    n : int, optional
        Number of elastic shapes wanted; twins count twice and are never torn apart.
        Rigid motions come on top, at 0 Hz. By default those that the scene asks for; 10 of a body.
    max_frequency : float, optional
        Leave out modes above this frequency, Hz.
    tol : float or str, optional
        Relative error that frequencies of a scene may have; by default its tolerance.
    **how
        Of a body: `coupling_tolerance`, up to which bearing terms that couple bending planes, axial
        motion and torsion are left out where they provably change no eigenvalue by more, relative;
        `method`, ``"lanczos"``, ``"arpack"`` or ``"dense"``; `count`, to check by a second
        factorisation that no mode was missed (Sylvester's law of inertia); `ovalising`, false to
        leave out the families of two waves around and more of a harmonic solid; `room`, which every
        family leaves above the list, relative; `stations`, sections along the shaft whose motions
        are given for every mode.

    Returns
    -------
    ModeSet
        A list of modes, each also by its name: ``modes[0]``, ``modes["bending 1"]``.

    Raises
    ------
    SolidgearError
        If `n` is not positive, the method unknown, a mode was missed and could not be found, or
        rounding leaves a frequency too few digits.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.modes("geometry/shaft_stepped.toml", n=4)
    >>> round(found["bending 1"].frequency_hz)
    783
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> beam = sg.modes(sg.build(scene, "timoshenko"), scene, n=4)
    >>> bool(abs(beam["bending 1"].frequency_hz / found["bending 1"].frequency_hz - 1) < 0.1)
    True
    """
    if isinstance(body, Body):
        if tol is not None:
            raise SolidgearError(
                "modes: `tol` chooses the mesh of a scene, and a body has its mesh; leave it out"
            )
        count = 10 if n is None else n
        return solving.modes(body, supports, count, max_frequency=max_frequency, **how)
    if supports != ():
        raise SolidgearError("modes: `supports` are those of the scene; leave them out")
    scene = load(body)
    count = checked_number(scene.ask.modes if n is None else n)
    settled = settle(scene, tol, "modes")
    highest = max_frequency or scene.ask.max_frequency
    return modes_of_scene(scene, settled.body, settled, count, max_frequency=highest, **how)


def checked_number(n: int) -> int:
    """Return the number of modes that a scene is asked for; refuse one that no list has."""
    if not 1 <= n <= MOST_MODES:
        raise SolidgearError(f"n = {show(n)}: give 1 to {MOST_MODES} modes")
    return n


def modes_of_scene(
    scene: Scene, body: Body, settled: Settled | None, n: int, **how: Any
) -> ModeSet:
    """Return the modes of a scene on a body: on one that was settled with all that its error bars
    rest on.
    """
    barred = settled is not None and bool(LADDER[body.fidelity].bars_by)
    found = solving.modes(body, scene, n, **{"room": ROOM if barred else 0.0, **how})
    return complete_list(scene, body, as_supports(scene), found) if barred else found


def stiffness(
    scene: Source,
    port: str | Sequence[str] | None = None,
    *,
    tol: float | str | None = None,
) -> Condensed | Coupled:
    """Stiffness and compliance of a shaft on its bearings at a lumped point, or between several.

    Parameters
    ----------
    scene : path, dict or Scene
        A scene: its file (TOML), the tables of one, or an object.
    port : str or sequence of str, optional
        Lumped point, by name, or several; by default the main one.
    tol : float or str, optional
        Relative error that compliances and stiffnesses may have; by default that of the scene.

    Returns
    -------
    Condensed or Coupled
        Of one point, or of several: ``stiffness`` and ``compliance``, 6x6 for each pair of points,
        order x y z thx thy thz, SI.

    Raises
    ------
    SolidgearError
        If the scene has no such point, or no model can answer.

    Examples
    --------
    >>> import solidgear as sg
    >>> found = sg.stiffness("geometry/shaft_stepped.toml")
    >>> found.stiffness.shape, round(float(found.stiffness[2, 2]) / 1e6)
    ((6, 6), 195)
    """
    loaded = load(scene)
    points = [loaded.port.name] if port is None else [port] if isinstance(port, str) else [*port]
    loaded = loaded.with_main_port(points[0])
    settled = settle(loaded, tol, "stiffness", points=points[1:])
    return condense(settled.body, loaded, points[0] if len(points) == 1 else points)
