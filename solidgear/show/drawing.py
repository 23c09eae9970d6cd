"""The drawing process: deformed shapes as PNG files, one or several frames each, and shaded surfaces.

    python -m solidgear.show.drawing FOLDER

:mod:`solidgear.show.render` starts it and reads how it ended; it imports nothing else of
solidgear, and so starts quickly.
"""

from __future__ import annotations

import json
import os
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

import numpy as np

from solidgear.show.raster import FINE, Aim, Canvas, facets, rgb
from solidgear.show.scales import HEAT, VIRIDIS

SIZE = (1200, 700)
#: height of a title over several frames
HEADING = 44
#: largest drawn displacement, as a share of the length of what is drawn
SWING = 0.08
#: share of a frame, across and up, that a shape may fill
USABLE = (0.90, 0.68)
OUTLINE = "#5c6b7a"
ARRAYS = ("points", "displacement", "faces", "triangles", "lines")
#: rad; by which a viewer stands from the middle of a shaft towards its start
TURN = np.deg2rad(22)
#: size of a shaded surface
SHADED = (840, 490)
#: shades of faces are logarithmic, and those below this share of the largest of one colour
FAINT = 1e-3


def _main(room: Path) -> int:
    if os.environ.get("SOLIDGEAR_RENDERER") == "none":
        print("SOLIDGEAR_RENDERER=none", file=sys.stderr)
        return 3
    jobs = json.loads((room / "jobs.json").read_text(encoding="utf-8"))
    with np.load(room / "surfaces.npz") as store:
        for i, job in enumerate(jobs):
            target, partial = room / f"{i}.png", room / f"{i}.part.png"
            try:
                arrays = [store[f"{i}.{name}"] for name in ARRAYS]
                if f"{i}.shades" in store:
                    _draw_shaded(job, partial, store[f"{i}.shades"], *arrays)
                else:
                    _draw(job, partial, *arrays)
                os.replace(partial, target)
            except Exception as error:  # a bad picture must not cost the others
                (room / f"{i}.txt").write_text(
                    " ".join(f"{type(error).__name__}: {error}".split()), encoding="utf-8"
                )
    return 0


def _draw(job, path, points, displacement, faces, triangles, lines):
    size = np.linalg.norm(displacement, axis=1)
    if not np.isfinite(size).all() or not size.max() > 0:
        raise ValueError("the displacement is zero or not finite")
    length = np.ptp(points[:, 1]) if job["along"] else np.ptp(points, axis=0).max()
    displacement = displacement * (SWING * length / size.max())
    view = _view(displacement) if job["along"] else FROM_ABOVE
    displacement = displacement * _sign(points, displacement, view[0])
    frames = job["frames"]
    extremes = np.vstack([points, *(points + factor * displacement for factor, _ in frames)])
    down, across = _layout(len(frames), extremes, view)
    tile = SIZE[0] // across, SIZE[1] // down
    # one title over several frames, which have no room for it
    several = len(frames) > 1
    head = HEADING if several else 0
    picture = np.full((head + SIZE[1], SIZE[0], 3), 255, np.uint8)
    still = facets(points, faces, triangles)
    for k, (factor, _) in enumerate(frames):
        canvas = Canvas(*tile, _aim(extremes, tile, *view[1:]))
        shape = Shape(points, points + factor * displacement, abs(factor) * size / size.max())
        _draw_frame(
            canvas, shape, still, facets(shape.moved, faces, triangles), lines, length, view
        )
        if k == 0:
            _draw_axes(canvas, view)
        top, left = head + k // across * tile[1], k % across * tile[0]
        picture[top : top + tile[1], left : left + tile[0]] = canvas.pixels()
    page = Page(picture)
    if several:
        page.words(job["title"], SIZE[0] / 2, 0.5 * HEADING, 26)
    for k, (_, caption) in enumerate(frames):
        left, top = k % across * tile[0], head + k // across * tile[1]
        middle = left + tile[0] / 2
        if not several:
            page.words(job["title"], middle, top + 0.055 * tile[1], 30)
        if caption:
            page.words(caption, middle, top + 0.115 * tile[1], 20)
        if k == 0:
            page.name_axes(left, top, tile, view)
        if k == len(frames) - 1:
            page.scale((left, top, *tile), "displacement / max", viridis(), several)
    page.save(path)


class Shape(NamedTuple):
    """Points at rest and as moved, and how much of the largest displacement each has."""

    points: np.ndarray
    moved: np.ndarray
    size: np.ndarray


def _draw_frame(canvas, shape, still, moved, lines, length, view) -> None:
    """Draw one deformed shape over the shape at rest."""
    back, colours = view[3], viridis()
    normals = moved.smooth(35)
    # both sides of a surface are lit
    facing = np.where(moved.normal[moved.owner] @ back < 0, -1.0, 1.0)[:, None, None]
    light = 0.7 * _light(facing * normals, view) + (0.5 if view is not FROM_ABOVE else 0.3)
    values = np.stack([shape.size[moved.triangles], light], axis=2)

    def shade(value):
        index = (value[:, 0] * (len(colours) - 1)).clip(0, len(colours) - 1).astype(int)
        return colours[index] * value[:, 1:]

    canvas.fill(shape.moved, moved.triangles, values, shade)
    # lines on a surface are brought a hair nearer, or they would sink into it here and there
    nearer = 0.004 * length
    canvas.lines(shape.moved, lines, "#000000", 0.6, 0.25, nearer)
    canvas.lines(shape.moved, moved.creases(30), "#202020", 1.2, nearer=nearer)
    canvas.lines(shape.points, still.creases(30), OUTLINE, 1.2, nearer=nearer)
    canvas.lines(shape.points, still.horizon(back), OUTLINE, 1.3)


def _draw_shaded(job, path, shades, points, _, faces, triangles, lines):
    """Draw a surface at rest, its faces in the colours of shades, seen from the side of the largest."""
    if not np.isfinite(shades).all() or not shades.max() > 0:
        raise ValueError("the shades are zero or not finite")
    view = _facing(points, faces if len(faces) else triangles, shades)
    length = np.ptp(points, axis=0).max()
    surface = facets(points, faces, triangles)
    canvas = Canvas(*SHADED, _aim(points, SHADED, *view[1:]))
    facing = np.where(surface.normal @ view[3] < 0, -1.0, 1.0)[:, None]
    light = 0.5 * _light(facing * surface.normal, view) + 0.6
    share = np.log(np.clip(shades / shades.max(), FAINT, 1.0) / FAINT) / np.log(1 / FAINT)
    colours = _between(HEAT)
    colour = colours[(share * (len(colours) - 1)).astype(int)] * light[:, None]
    values = np.repeat(colour[surface.owner, None], 3, axis=1)
    canvas.fill(points, surface.triangles, values, lambda value: value)
    canvas.lines(points, lines, "#000000", 0.6, 0.25, 0.004 * length)
    canvas.lines(points, surface.horizon(view[3]), OUTLINE, 1.3)
    _draw_axes(canvas, view)
    page = Page(canvas.pixels())
    page.words(job["title"], SHADED[0] / 2, 0.05 * SHADED[1], 26)
    page.name_axes(0, 0, SHADED, view)
    page.scale((0, 0, *SHADED), job["shade"], colours, False, ("0.001", "0.01", "0.1", "1"))
    # flat faces have few colours, and dots between them would take twice the bytes
    page.save(path, dots=False)


def _facing(points, faces, shades):
    """Return the view from the side of the largest shade and, of both ends of the shaft, from the
    one that more of what is shaded faces.
    """
    corners = points[faces]
    x, _, z = corners[np.argmax(shades)].mean(axis=0)
    away = np.hypot(x, z)
    side = np.array([x, 0.0, z]) / away if away else np.array([1.0, 0.0, 0.0])
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0])
    views = [_seen_from(side, turn) for turn in (-TURN, TURN)]
    return max(views, key=lambda view: shades @ np.maximum(areas @ view[3], 0.0))


def _light(normals, view) -> np.ndarray:
    """Return how bright normals (..., 3) are: by a lamp over the left shoulder of the viewer and a
    weak one on the other side.
    """
    _, right, upward, back = view
    lamps = (
        (0.7 * upward - 0.5 * right + back, 0.75),
        (-0.5 * upward + 0.6 * right + 0.8 * back, 0.35),
    )
    parts = (share * (normals @ (way / np.linalg.norm(way))).clip(0) for way, share in lamps)
    return sum(parts)


def _layout(count: int, points, view) -> tuple[int, int]:
    """Return rows and columns in which frames of this shape come out largest."""
    _, right, upward, _ = view
    wide, high = np.ptp(points @ right), np.ptp(points @ upward)

    def scale(across: int) -> float:
        down = -(-count // across)
        return min(USABLE[0] * SIZE[0] / across / wide, USABLE[1] * SIZE[1] / down / high)

    across = max(range(1, count + 1), key=scale)
    return -(-count // across), across


#: axes, with the colours of their arrows
AXES = {"x": "#ff7f50", "y": "#3cb371", "z": "#0000ff"}


def _arrows(size, view) -> tuple[tuple[float, float], dict[str, np.ndarray]]:
    """Return where the arrows of the axes begin in a frame, and the ways (2,) they go, px."""
    _, right, upward, _ = view
    long = min(0.09 * size[1], 0.12 * size[0])
    ways = {name: long * np.array([right[k], -upward[k]]) for k, name in enumerate(AXES)}
    return (max(0.1 * size[0], long + 24), 0.83 * size[1]), ways


def _draw_axes(canvas, view) -> None:
    start, ways = _arrows((canvas.width // FINE, canvas.height // FINE), view)
    for name, way in ways.items():
        canvas.arrow(start, way, AXES[name], 3.0)


class Page:
    """A picture (height, width, 3) and the words on it."""

    def __init__(self, pixels: np.ndarray):
        from PIL import Image, ImageDraw

        self.image = Image.fromarray(pixels)
        self.draw = ImageDraw.Draw(self.image)

    def words(self, text: str, x: float, y: float, size: float, anchor: str = "mm") -> None:
        """Write words at a place, px, in letters of a size."""
        self.draw.text((x, y), text, fill="#000000", font=_font(round(size)), anchor=anchor)

    def name_axes(self, left: float, top: float, size, view) -> None:
        """Write the names of the axes beyond their arrows."""
        start, ways = _arrows(size, view)
        for name, way in ways.items():
            x, y = start + way * (1 + 13 / max(np.hypot(*way), 13.0))
            self.words(name, left + x, top + y, 21)

    def scale(self, frame, what: str, colours, several: bool, ticks=()) -> None:
        """Draw the scale of colours at the foot of a frame (left, top, width, height)."""
        from PIL import Image

        left, top, width, height = frame
        share = 0.7 if several else 0.36
        ticks = ticks or (
            ("0.0", "0.5", "1.0") if several else ("0.0", "0.2", "0.4", "0.6", "0.8", "1.0")
        )
        wide, high = round(share * width), max(round(0.026 * height), 8)
        x, y = round(left + (width - share * width) / 2), round(top + 0.98 * height) - high
        places = np.linspace(0, len(colours) - 1, wide).astype(int)
        bar = np.rint(255 * colours[places]).astype(np.uint8)
        self.image.paste(Image.fromarray(np.repeat(bar[None], high, axis=0)), (x, y))
        letter = 18 if several else 21
        for k, tick in enumerate(ticks):
            self.words(tick, x + wide * k / (len(ticks) - 1), y - 0.65 * letter, letter)
        self.words(what, left + width / 2, y - 1.85 * letter, letter)

    def save(self, path, dots: bool = True) -> None:
        """Write the picture with a palette, dithered with `dots`, in half the bytes."""
        from PIL import Image

        picture = self.image
        # every fourth pixel of every fourth row has all colours, and takes a tenth of the time
        sample = picture.resize((picture.width // 4, picture.height // 4), resample=0)
        palette = sample.quantize(kmeans=1) if dots else sample.quantize(method=1)
        dither = Image.Dither.FLOYDSTEINBERG if dots else Image.Dither.NONE
        picture.quantize(palette=palette, dither=dither).save(path, optimize=True)


@cache
def _font(size: int):
    """Return letters that matplotlib brings, the same on every machine; else those of Pillow."""
    from PIL import ImageFont

    spec = find_spec("matplotlib")
    for folder in (spec and spec.submodule_search_locations) or ():
        return ImageFont.truetype(f"{folder}/mpl-data/fonts/ttf/DejaVuSans.ttf", size)
    return ImageFont.load_default(size)


def _between(colours, count: int = 256, first: float = 0.0) -> np.ndarray:
    """Return colours (count, 3) between given ones, 0 to 1, from a share of the way on."""
    ends = np.array([rgb(colour) for colour in colours])
    places = np.linspace(first, 1.0, count) * (len(ends) - 1)
    return np.column_stack([np.interp(places, np.arange(len(ends)), part) for part in ends.T])


def viridis(count: int = 256) -> np.ndarray:
    """Return colours (count, 3) of viridis without its darkest part, on which neither shading nor
    lines can be seen.
    """
    return _between(VIRIDIS, count, first=0.14)


def _view(displacement):
    """Return the directions of motion, right, up and towards the viewer for a shaft along y."""
    across = displacement[:, [0, 2]]
    w, v = np.linalg.eigh(across.T @ across)
    # Motion without a plane of its own (torsion, axial, a ring breathing) is seen from +x.
    d = v[:, 1] if w[1] > 2 * w[0] else np.array([0.0, 1.0])
    d = d if d[np.argmax(np.abs(d))] > 0 else -d
    return _seen_from(np.cross([0.0, 1.0, 0.0], [d[0], 0.0, d[1]]))


def _seen_from(side, turn=-TURN):
    """Return the directions of :func:`_view` for a viewer on a side of the shaft, turned from there
    towards its end.
    """
    y = np.array([0.0, 1.0, 0.0])
    plane = np.cross(side, y)
    # Seen a little from above and from the end, so that a round thing looks round.
    height = np.deg2rad(18)
    back = np.cos(height) * (np.cos(turn) * side + np.sin(turn) * y) + np.sin(height) * plane
    right = y - (y @ back) * back
    right /= np.linalg.norm(right)
    return plane, right, np.cross(back, right), back


def _from_above():
    """Return the view on two shafts in the plane of x and y from above, z up."""
    height, turn = np.deg2rad(38), np.deg2rad(35)
    back = np.array([np.cos(height) * np.sin(turn), np.cos(height) * np.cos(turn), np.sin(height)])
    plane = np.array([0.0, 0.0, 1.0])
    right = np.cross(plane, back)
    right /= np.linalg.norm(right)
    return plane, right, np.cross(back, right), back


FROM_ABOVE = _from_above()


def _sign(points, displacement, plane) -> float:
    """Return the sign that lets a shape move up, along +y or about +y where it moves most."""
    i = np.argmax((displacement**2).sum(axis=1))
    d, r = displacement[i], points[i] * [1.0, 0.0, 1.0]
    about = np.cross(r, d)[1] / max(np.linalg.norm(r), 1e-300)
    choice = max((d @ plane, d[1], about), key=abs)
    return -1.0 if choice < 0 else 1.0


def _aim(drawn, size, right, upward, back) -> Aim:
    """Return the view in which what is drawn fills a frame between title and scale of colours."""
    a, b = drawn @ right, drawn @ upward
    scale = min(USABLE[1] * size[1] / np.ptp(b), USABLE[0] * size[0] / np.ptp(a))
    height = size[1] / scale
    middle = (a.max() + a.min()) / 2 * right + ((b.max() + b.min()) / 2 - 0.02 * height) * upward
    return Aim(right, upward, back, middle, scale)


if __name__ == "__main__":
    sys.exit(_main(Path(sys.argv[1])))
