"""Values to be read off a chart: what a figure draws, handed to the page beside its picture.

A chart says with :func:`readable` what its markers and curves stand for. Where the figure becomes the
SVG of a page, :func:`readings` turns that into places in the SVG and words, and ``readout.js`` shows
the nearest one under a mouse, a finger or the arrow keys. The picture itself stays as it is: for
print, and where no script runs, it is all there is.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any, NamedTuple

import numpy as np

#: units of an SVG that matplotlib writes, in an inch
PER_INCH = 72.0
#: steps of a place in the SVG, in its units
STEPS = 10
#: places of a curve that are nearer than this, in units of the SVG, are one to the eye
SEEN = 0.7


class Reading(NamedTuple):
    """What one curve, or one set of markers, says where it is pointed at.

    Attributes
    ----------
    name : str
        Of the model, or of what else is drawn.
    colour : str
        Of the curve.
    x, y : (n,) ndarray
        In the coordinates of its axes.
    told : mapping of str to (str, sequence of str)
        By what it is: its unit, and the value at every place, as text.
    marked : bool
        Whether its places are markers or named: they are taken before curves that pass near them.
    """

    name: str
    colour: str
    x: np.ndarray
    y: np.ndarray
    told: Mapping[str, tuple[str, Sequence[str]]]
    marked: bool


def readable(
    ax: Any,
    x: Sequence[float] | np.ndarray,
    y: Sequence[float] | np.ndarray,
    name: str,
    told: Mapping[str, tuple[str, Sequence[str]]],
    *,
    colour: Any = "#444444",
    marked: bool = True,
) -> None:
    """Say what is drawn at places of a panel; parameters are the fields of :class:`Reading`.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    x, y : (n,) array_like
    name : str
    told : mapping of str to (str, sequence of str)
    colour : matplotlib colour
    marked : bool

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> figure = Figure()
    >>> ax = figure.subplots()
    >>> _ = ax.set(xlim=(0, 5), ylim=(0, 5))
    >>> readable(ax, [1.0, 2.0], [3.0, 4.0], "beam", {"error": ("%", ["3", "4"])})
    >>> [one["name"] for one in readings(figure)]
    ['beam']
    """
    from matplotlib.artist import Artist
    from matplotlib.colors import to_hex

    class Told(Artist):
        """Draws nothing: it lives with its panel, and knows what is to be read there."""

        reading: Reading

    artist = Told()
    places = np.asarray(x, float), np.asarray(y, float)
    artist.reading = Reading(name, to_hex(colour), *places, told, marked)
    artist.set_in_layout(False)
    ax.add_artist(artist)


def readings(figure: Any) -> list[dict[str, Any]]:
    """What ``readout.js`` is handed of a figure that was drawn, a dictionary a curve.

    Places outside of their panel are left out, and so are places of a curve that the eye cannot
    tell from the one before; tops and dips stay.

    Parameters
    ----------
    figure : matplotlib.figure.Figure

    Returns
    -------
    list of dict
        ``name``, ``colour``, ``marked``, ``at`` (x, y, x, ... in tenths of a unit of the SVG, y
        downwards), ``told`` (what, unit, values).
    """
    out = []
    for artist in (one for ax in figure.axes for one in ax.artists if hasattr(one, "reading")):
        reading: Reading = artist.reading
        at = artist.axes.transData.transform(np.column_stack([reading.x, reading.y]))
        at *= PER_INCH / figure.dpi
        low, high = artist.axes.get_window_extent().get_points() * PER_INCH / figure.dpi
        inside = np.all((at >= low - 1) & (at <= high + 1), axis=1)  # neither do NaN pass
        kept = np.flatnonzero(inside)
        if not reading.marked:
            kept = kept[apart(at[kept])]
        if not len(kept):
            continue
        at[:, 1] = PER_INCH * figure.get_figheight() - at[:, 1]
        out.append(
            {
                "name": reading.name,
                "colour": reading.colour,
                "marked": reading.marked,
                "at": np.rint(STEPS * at[kept]).astype(int).ravel().tolist(),
                "told": [
                    [what, unit, [texts[k] for k in kept.tolist()]]
                    for what, (unit, texts) in reading.told.items()
                ],
            }
        )
    return out


def apart(at: np.ndarray) -> np.ndarray:
    """Numbers of the places of a curve that are to be kept: both ends, tops and dips, and of the
    rest those that are ``SEEN`` from the one kept before.

    Parameters
    ----------
    at : (n, 2) ndarray

    Examples
    --------
    >>> apart(np.array([[0.0, 0], [0.1, 0], [0.2, 0.3], [0.3, 0], [0.4, 0], [5, 0]])).tolist()
    [0, 2, 5]
    """
    y = at[:, 1]
    turns = np.ones(len(at), bool)
    up = np.diff(y)
    turns[1:-1] = up[:-1] * up[1:] < 0
    kept, last = [], np.array([-np.inf, -np.inf])
    for k, place in enumerate(at):
        if turns[k] or np.abs(place - last).max() >= SEEN:
            kept.append(k)
            last = place
    return np.array(kept, int)


def with_readings(svg: str, figure: Any) -> str:
    """An SVG that carries what is to be read off it; as it is where there is nothing."""
    found = readings(figure)
    if not found:
        return svg
    text = escape(json.dumps(found, allow_nan=False, separators=(",", ":")), quote=False)
    end = svg.rindex("</svg>")
    return f'{svg[:end]}<metadata class="readings">{text}</metadata>{svg[end:]}'
