"""A model one can turn: mode shapes in 3D inside a page, without network and without other files.

The viewer is ours (``viewer.js``, WebGL 2, 27 kB) and not a library: three.js alone is 0.7 MB
and vtk.js over 1 MB in every report, both need a loader for surfaces that move, and neither hatches
a section. What is drawn are the product's own surfaces (:mod:`solidgear.body.surface`).
"""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from solidgear.machine.whole_file import write_page
from solidgear.report import packing
from solidgear.report.drawing import SWING, colours
from solidgear.report.turning import Turned, picks, turned

if TYPE_CHECKING:
    from solidgear.body import Body
    from solidgear.solve.modes import ModeSet

#: most that the surfaces and shapes of one page may take, bytes; the page itself stays below 6 MB
BUDGET = 3_500_000
#: the page of mode shapes that a comparison writes, which its report takes the viewer from
TURNED = "modes.html"
START, END = "<!-- solidgear viewer: start -->", "<!-- solidgear viewer: end -->"
STOPS = 17
SCRIPTS = ("viewer_mesh.js", "viewer.js")


@dataclass(frozen=True, eq=False, repr=False)
class Turning:
    """Models that can be turned: shows itself in a notebook, and writes itself as a page.

    Attributes
    ----------
    models : tuple of Turned
    title : str
        Of the page.
    first : str
        Name of the mode to open with; first bending by default.
    """

    models: tuple[Turned, ...]
    title: str = ""
    first: str = ""

    def write(self, path: str | os.PathLike, *, still: str = "") -> Path:
        """Write one self-contained page.

        Parameters
        ----------
        path : path
            Of the HTML file; there is a whole one or none.
        still : str, optional
            Data URI of a picture for print, and for browsers without WebGL 2.

        Raises
        ------
        SolidgearError
            If the file cannot be written.
        """
        return write_page(path, viewer_page(self.models, self.title, still=still, first=self.first))

    def __repr__(self) -> str:
        told = ", ".join(f"{m.title} ({len(m.shapes)} modes)" for m in self.models)
        return f"Models to turn: {told}; write(path) makes a page"

    def _repr_html_(self) -> str:
        from html import escape

        # A frame of its own: a notebook strips scripts from what is not one.
        page = escape(viewer_page(self.models, self.title, first=self.first), quote=True)
        return f'<iframe srcdoc="{page}" style="width:100%;height:640px;border:0"></iframe>'


def turn(body: Body, modes: ModeSet, *others: tuple[Body, ModeSet]) -> Turning:
    """Mode shapes in 3D that can be turned, animated and cut, of one model or several side by side.

    Parameters
    ----------
    body : Body
    modes : ModeSet
        Its modes. Rigid motions are left out.
    *others : (Body, ModeSet)
        Further models of the same scene.

    Returns
    -------
    Turning
        Shows itself in a notebook; ``write("model.html")`` makes a page that needs no network.

    Raises
    ------
    SolidgearError
        For a body that carries no geometry, modes of another body, or none that is elastic.

    Examples
    --------
    >>> import solidgear as sg
    >>> scene = sg.load("geometry/shaft_stepped.toml")
    >>> beam = sg.build(scene, "timoshenko")
    >>> sg.turn(beam, sg.modes(beam, scene, n=4))
    Models to turn: timoshenko (3 modes); write(path) makes a page
    """
    models: list[Turned] = []
    for one, its in ((body, modes), *others):
        models.append(turned(one, its, like=models))
    return Turning(tuple(models))


def viewer_fragment(models: Sequence[Turned], *, still: str = "", first: str = "") -> str:
    """Markup, style, script and data of a viewer, to be put into a page.

    Parameters
    ----------
    models : sequence of Turned
        The first two are shown side by side; further ones can be chosen. Those that would take the
        data past ``BUDGET`` are left out, but never the first.
    still : str, optional
        Data URI of a picture to show in print and where the viewer cannot run.
    first : str, optional
        Name of the mode to open with; first bending by default.

    Returns
    -------
    str
        HTML between two comments, by which :func:`fragment_of` finds it again.
    """
    from markupsafe import Markup

    told = _told(models, first)
    # "</script" must not end the script that holds the data.
    data = json.dumps(told, allow_nan=False).replace("<", "\\u003c")
    markup = _template("viewer.html").render(
        data=Markup(data),
        script=Markup(_script()),
        still=still,
        shown=told["models"][:2],
        models=told["models"],
        modes=told["modes"],
        ramp=", ".join(told["colours"]),
    )
    return f"{START}\n{markup}\n{END}"


def viewer_page(
    models: Sequence[Turned], title: str = "", *, still: str = "", first: str = ""
) -> str:
    """The viewer alone as a page; parameters as those of :func:`viewer_fragment`."""
    from markupsafe import Markup

    return _template("viewer_page.html").render(
        title=title or "Mode shapes",
        viewer=Markup(viewer_fragment(models, still=still, first=first)),
    )


def fragment_of(page: str | os.PathLike) -> str:
    """The viewer in a page that :func:`viewer_page` wrote; empty if there is none."""
    try:
        text = Path(page).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""
    start, end = text.find(START), text.rfind(END)
    return text[start : end + len(END)] if 0 <= start < end else ""


def _told(models: Sequence[Turned], first: str) -> dict[str, Any]:
    """What the script is handed."""
    kept = list(_within(models))
    models = models[: len(kept)]
    ramp = colours()(np.linspace(0, 1, STOPS))[:, :3]
    return {
        "swing": SWING,
        "first": max(models[0].index(first or "bending 1"), 0),
        "colours": ["#" + "".join(f"{round(255 * v):02x}" for v in rgb) for rgb in ramp],
        "models": kept,
        "modes": picks(models),
    }


def _within(models: Sequence[Turned]) -> Iterator[dict[str, Any]]:
    """Models packed, as far as the budget goes."""
    left = BUDGET
    for k, model in enumerate(models):
        packed = _packed(model)
        left -= len(json.dumps(packed))
        if k and left < 0:
            return
        yield packed


def _packed(model: Turned) -> dict[str, Any]:
    along = [_packed(one) for one in model.along]
    told = _packed_body(model)
    if np.any(model.rotation != np.eye(3)) or np.any(model.origin):
        told |= {"rotation": model.rotation.ravel().tolist(), "origin": model.origin.tolist()}
    return told | ({"along": along} if along else {})


def _packed_body(model: Turned) -> dict[str, Any]:
    mesh = model.mesh
    length = float(np.ptp(mesh.points, axis=0).max())
    place, swing = length / packing.PLACES, 1.0 / packing.SWINGS
    return {
        "title": model.title,
        "points": packing.packed_values(mesh, mesh.points, place),
        "count": len(mesh.points),
        "step": place,
        "triangles": packing.packed_triangles(mesh),
        "shapes": [
            {
                "name": shape.name,
                "hz": shape.frequency_hz,
                "pair": shape.pair,
                "twists": shape.twists,
                "step": swing,
                "moved": packing.packed_values(mesh, shape.displacement, swing),
            }
            for shape in model.shapes
        ],
    }


def _script() -> str:
    here = Path(__file__).parent
    parts = [(here / name).read_text(encoding="utf-8") for name in SCRIPTS]
    return "(() => {\n" + '"use strict";\n' + "".join(parts) + "})();"


@functools.cache
def _template(name: str):
    from solidgear.report.html import template

    return template(name)
