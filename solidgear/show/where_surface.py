"""Picture of the surface of a 3D solid, every cell in the colour of its share of an error bar."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from solidgear.core import Body
from solidgear.show.plot import check_ending
from solidgear.show.render import RenderJob, render_modes


def where_surface(body: Body, by_cells: np.ndarray, title: str, path: Path) -> RenderJob:
    """Return the picture of shares (ne,) of the cells of a 3D solid, to be drawn.

    Copies of a sector or a half are all in the colours of the one that was solved; a corrected solid
    is drawn as its plain part, of whose cells the shares are.
    """
    drawing: Any = body.geometry
    drawing = getattr(drawing, "uncut", drawing)
    surface = drawing.surface({})
    owners = drawing.solved.outline.owners
    count = len(surface.faces) + len(surface.triangles)
    shades = by_cells[np.tile(owners, count // len(owners))]
    return RenderJob(surface, title, path, shades=shades, shade="share of the cell / largest")


def draw_surface(body: Body, by_cells: np.ndarray, title: str, path: Path) -> str:
    """Draw the picture of shares (ne,) of the cells of a 3D solid as ``.png``; return why it could not
    be drawn, or an empty text.
    """
    if check_ending(path) != ".png":
        return f"the surface of a 3D solid is drawn as .png, not as {path.suffix}"
    (result,) = render_modes([where_surface(body, by_cells, title, path)])
    return result.reason
