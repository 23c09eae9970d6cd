"""A model one can turn: mode shapes in 3D inside a page, without network and without other files.

The viewer is ours (``viewer.js``, WebGL 2) and not a library: a page with ten modes of 40,000
triangles has 0.16 MB. The part of three.js that it would need adds 0.19 MB to that; by vtk.js the
page has 4 MB and does not move, by k3d 10 MB.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from solidgear.core import Body, ModeSet
from solidgear.core.machine.whole_file import write_page
from solidgear.show.drawing import SWING
from solidgear.show.packing import packed
from solidgear.show.page_parts import template
from solidgear.show.scales import MOTION, rgb
from solidgear.show.turning import Turned, picks, turned

#: most that the surfaces and shapes of one page may take, bytes; the page itself stays below 6 MB
BUDGET = 3_500_000
#: steps of the longest side of a surface: triangles of fine edge layers keep their direction
PLACES = 2**20
#: steps of the largest displacement of a shape; half a step in three directions is 9e-4 of it
SWINGS = 1000
#: the page of mode shapes that a comparison writes, which its report takes the viewer from
TURNED = "modes.html"
START, END = "<!-- solidgear viewer: start -->", "<!-- solidgear viewer: end -->"
#: the still picture of a viewer in its page
STILL = re.compile(r' has-still(?=")|<img src="data:[^"]*" alt="Mode shape, deformation enlarged">')


@dataclass(frozen=True, eq=False, repr=False)
class Turning:
    """Models that can be turned: shows itself in a notebook, and writes itself as a page."""

    models: tuple[Turned, ...]
    title: str = ""  #: of the page
    first: str = ""  #: name of the mode to open with; first bending by default
    cautions: Sequence[str] = ()  #: sentences on what its frequencies leave out

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
        return write_page(path, self.page(still))

    def page(self, still: str = "") -> str:
        """Return the page as text; `still` as in :meth:`write`."""
        from markupsafe import Markup

        return template("viewer_page.html").render(
            title=self.title or "Mode shapes",
            viewer=Markup(_filled(self.packed, still)),
            cautions=self.cautions,
        )

    @cached_property
    def packed(self) -> Packed:
        """The models as the script takes them: nearly all the work of a page, to be done while its
        picture is drawn.
        """
        return _packed(self.models, self.first)

    def __repr__(self) -> str:
        titles = ", ".join(f"{m.title} ({len(m.shapes)} modes)" for m in self.models)
        return f"Models to turn: {titles}; write(path) makes a page"

    def _repr_html_(self) -> str:
        from html import escape

        # A frame of its own: a notebook strips scripts from what is not one.
        page = escape(self.page(), quote=True)
        return f'<iframe srcdoc="{page}" style="width:100%;height:640px;border:0"></iframe>'


def turn(body: Body, modes: ModeSet, *others: tuple[Body, ModeSet]) -> Turning:
    """Mode shapes in 3D that can be turned, animated and cut, of one model or several side by
    side.

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
    for model_body, mode_set in ((body, modes), *others):
        models.append(turned(model_body, mode_set, like=models))
    return Turning(tuple(models), cautions=modes.cautions)


class Packed(NamedTuple):
    """Models as the script of a viewer takes them, and what stands around it."""

    data: str  #: JSON
    titles: list[str]  #: of models
    modes: list[str]


def viewer_fragment(models: Sequence[Turned], *, still: str = "", first: str = "") -> str:
    """Return markup, style, script and data of a viewer, without models past ``BUDGET`` but the
    first.
    """
    return _filled(_packed(models, first), still)


def _packed(models: Sequence[Turned], first: str) -> Packed:
    drawn = list(_within_budget(models))
    models = models[: len(drawn)]
    modes = picks(models)
    payload = {
        "first": max(models[0].index(first or "bending 1"), 0),
        "ramp": [round(part / 255, 4) for colour in MOTION for part in rgb(colour).tolist()],
        "models": drawn,
        "modes": modes,
    }
    # "</script" must not end the script that holds the data.
    data = json.dumps(payload, allow_nan=False).replace("<", "\\u003c")
    return Packed(data, [model.title for model in models], [mode["name"] for mode in modes])


def _filled(packed: Packed, still: str) -> str:
    from markupsafe import Markup

    markup = template("viewer.html").render(
        data=Markup(packed.data),
        script=Markup((Path(__file__).parent / "viewer.js").read_text(encoding="utf-8")),
        still=still,
        titles=packed.titles,
        modes=packed.modes,
        ramp=", ".join(MOTION),
    )
    return f"{START}\n{markup}\n{END}"


def fragment_of(page: str | os.PathLike, *, still: bool = True) -> str:
    """Return the viewer in a page of :class:`Turning`, without its still picture; empty if
    there is none.
    """
    try:
        text = Path(page).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return ""
    start, end = text.find(START), text.rfind(END)
    fragment = text[start : end + len(END)] if 0 <= start < end else ""
    return fragment if still else STILL.sub("", fragment)


def _within_budget(models: Sequence[Turned]) -> Iterator[dict[str, Any]]:
    """Yield models for the script, as far as the budget goes."""
    budget = BUDGET
    for k, model in enumerate(models):
        model_data = _model(model)
        budget -= len(json.dumps(model_data))
        if k and budget < 0:
            return
        yield model_data


def _model(model: Turned) -> dict[str, Any]:
    """Return one model for the script; arrays go column by column."""
    placed = np.vstack([b.mesh.points @ b.rotation.T + b.origin for b in model.bodies])
    low, high = placed.min(axis=0), placed.max(axis=0)
    length = float((high - low).max())
    return {
        "title": model.title,
        "middle": ((low + high) / 2).tolist(),
        "half": ((high - low) / 2).tolist(),
        "length": length,
        "swing": SWING * length,
        "bodies": [_body(body) for body in model.bodies],
        "shapes": [_shape(model, k) for k in range(len(model.shapes))],
    }


def _body(body: Turned) -> dict[str, Any]:
    """Return the surface of one body for the script, and the matrix that puts it in its place."""
    place = np.eye(4)
    place[:3, :3], place[:3, 3] = body.rotation, body.origin
    mesh = body.mesh
    step = float(np.ptp(mesh.points, axis=0).max()) / PLACES
    return {
        "place": place.T.ravel().tolist(),
        "start": float(mesh.points[:, 1].min()),
        "step": step,
        "points": packed(mesh.points.T.ravel(), step),
        "triangles": packed(mesh.triangles.ravel()),
        "edges": packed(mesh.edges.ravel()),
    }


def _shape(model: Turned, k: int) -> dict[str, Any]:
    """Return one mode for the script: the motion of every body, and the reach of all along the
    axes.
    """
    shape = model.shapes[k]
    shapes = [body.shapes[k] for body in model.bodies]
    moved = [s.displacement @ b.rotation.T for s, b in zip(shapes, model.bodies)]
    return {
        "name": shape.name,
        "hz": shape.frequency_hz,
        "pair": shape.pair,
        "most": np.abs(np.vstack(moved)).max(axis=0).tolist(),
        "step": 1 / SWINGS,
        "moved": [packed(s.displacement.T.ravel(), 1 / SWINGS) for s in shapes],
        "twists": [s.twists for s in shapes],
    }
