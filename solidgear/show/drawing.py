"""The drawing process: deformed shapes as PNG files, one or several frames each, and shaded surfaces.

    python -m solidgear.show.drawing FOLDER CALLER

:mod:`solidgear.show.render` starts it, with the number of its process, and reads how it ended; it
imports next to nothing of solidgear, and so starts quickly. It ends when nothing has been left to
draw for a moment, so that its memory is free while the next model is solved.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from solidgear.core.machine.processes import Other
from solidgear.show.canvas import BLACK, Canvas, Shading, edges_of, scale_of, surface_of, wires_of
from solidgear.show.scales import MOTION, YLORRD

SIZE = (1200, 700)
#: height of a title over several frames
HEADING = 44
#: largest drawn displacement, as a share of the length of what is drawn
SWING = 0.08
#: share of a frame, across and up, that a shape may fill
USABLE = (0.90, 0.68)
#: colours of sharp edges as moved, and of the shape at rest
EDGE, OUTLINE = "#202020", "#5c6b7a"
#: file that says that all pictures are asked for, and s between two looks for it and them
LAST, PAUSE = "last", 0.02
#: s without a picture to draw after which the process ends
IDLE = 0.4
ARRAYS = ("points", "displacement", "faces", "triangles", "lines")
#: rad; by which a viewer stands from the middle of a shaft towards its start
TURN = np.deg2rad(22)
#: size of a shaded surface
SHADED = (840, 490)
#: shades of faces are logarithmic, and those below this share of the largest of one colour
FAINT = 1e-3


def _main(room: Path, caller: Other) -> int:
    if os.environ.get("SOLIDGEAR_RENDERER") == "none":
        print("SOLIDGEAR_RENDERER=none", file=sys.stderr)
        return 3
    # Drawing nothing is what fails where there is no OpenGL.
    Canvas(16, 16).pixels()
    work(room, caller, _draw)
    return 0


def work(room: Path, caller: Other, draw: Callable[..., None]) -> None:
    """Draw the pictures that are asked for in a folder until there are no more, or none for a while."""
    index, idle = 0, 0.0
    while True:
        no_more = (room / LAST).exists()
        if (room / f"{index}.json").exists():
            _drawn(room, index, draw)
            index, idle = index + 1, 0.0
        elif no_more or idle > IDLE or not caller.alive:
            break
        else:
            time.sleep(PAUSE)
            idle += PAUSE


def _drawn(room: Path, index: int, draw: Callable[..., None]) -> None:
    """Draw a picture, or write why it could not be drawn."""
    target, partial = room / f"{index}.png", room / f"{index}.part.png"
    reason = room / f"{index}.txt"
    if target.exists() or reason.exists():
        return  # by an earlier child
    job = json.loads((room / f"{index}.json").read_text(encoding="utf-8"))
    try:
        with np.load(room / f"{index}.npz") as arrays:
            draw(job, partial, **arrays)
        os.replace(partial, target)
    except Exception as error:  # a bad picture must not cost the others
        words = " ".join(f"{type(error).__name__}: {error}".split())
        reason.write_text(words, encoding="utf-8")


def _draw(job, path, shades=None, **surface):
    """Write the picture of a job."""
    if shades is None:
        _draw_moved(job, path, **surface)
    else:
        _draw_shaded(job, path, shades, **surface)


def _draw_moved(job, path, points, displacement, faces, triangles, lines):
    """Draw a deformed shape over the shape at rest, in every frame of a job."""
    size = np.linalg.norm(displacement, axis=1)
    if not np.isfinite(size).all() or not size.max() > 0:
        raise ValueError("the displacement is zero or not finite")
    length = np.ptp(points[:, 1]) if job["along"] else np.ptp(points, axis=0).max()
    displacement = displacement * (SWING * length / size.max())
    view = _view(displacement) if job["along"] else FROM_ABOVE
    displacement = displacement * _sign(points, displacement, view[0])
    # from above more of a surface faces the lamps
    look = Shading(ambient=0.5 if job["along"] else 0.3, diffuse=0.7, specular=0.05)
    scale = scale_of(MOTION, (0.0, 1.0))
    # Lines on a surface are brought a hair nearer, or they would sink into it here and there.
    nearer = 0.004 * length * view[3]
    rest = surface_of(points, faces, triangles)
    frames = job["frames"]
    extremes = np.vstack([points, *(points + factor * displacement for factor, _ in frames)])
    down, across = _layout(len(frames), extremes, view)
    tile = SIZE[0] // across, SIZE[1] // down
    # one title over several frames, which have no room for it
    head = _heading(job["title"]) if len(frames) > 1 else np.empty((0, SIZE[0], 3), np.uint8)
    picture = np.full((SIZE[1], SIZE[0], 3), 255, np.uint8)
    # A window a frame: smoothing of edges leaves all but one part of a divided window black.
    for k, (factor, caption) in enumerate(frames):
        canvas = Canvas(*tile)
        _lamps(canvas, length, view)
        moved = surface_of(points + factor * displacement, faces, triangles)
        canvas.smooth(moved, abs(factor) * size / size.max(), scale, look)
        canvas.lines(wires_of(moved.points, lines), BLACK, 1.0, nearer=nearer, opacity=0.2)
        canvas.lines(edges_of(moved), EDGE, 1.5, nearer=nearer)
        canvas.lines(edges_of(rest), OUTLINE, 1.5, nearer=nearer)
        canvas.silhouette(rest, OUTLINE, 1.75)
        _words(canvas, "" if len(head) else job["title"], caption)
        if k == len(frames) - 1:
            _bar(canvas, scale, len(frames))
        _aim(canvas, points, extremes, tile[1] / tile[0], *view[1:])
        if k == 0:
            canvas.axes()
        top, x = k // across * tile[1], k % across * tile[0]
        picture[top : top + tile[1], x : x + tile[0]] = canvas.pixels()
    _write(np.concatenate([head, picture]), path)


def _draw_shaded(job, path, shades, points, displacement, faces, triangles, lines):
    """Draw a surface at rest, its faces in the colours of shades, seen from the side of the largest."""
    if not np.isfinite(shades).all() or not shades.max() > 0:
        raise ValueError("the shades are zero or not finite")
    view = _facing(points, faces if len(faces) else triangles, shades)
    length = np.ptp(points, axis=0).max()
    nearer = 0.004 * length * view[3]
    surface, scale = surface_of(points, faces, triangles), scale_of(YLORRD, (FAINT, 1.0), log=True)
    canvas = Canvas(*SHADED)
    _lamps(canvas, length, view)
    canvas.flat(surface, np.clip(shades / shades.max(), FAINT, 1.0), scale, Shading(0.6, 0.5))
    canvas.lines(wires_of(points, lines), BLACK, 1.0, nearer=nearer, opacity=0.15)
    canvas.silhouette(surface, OUTLINE, 1.75)
    _words(canvas, job["title"], "")
    _bar(canvas, scale, 1, job["shade"], 4, "%.3g")
    _aim(canvas, points, points, SHADED[1] / SHADED[0], *view[1:])
    canvas.axes()
    # flat faces have few colours, and dots between them would take twice the bytes
    _write(canvas.pixels(), path, dots=False)


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


def _write(pixels, path, dots=True):
    """Write a picture with a palette, dithered with `dots`, in half the bytes."""
    from PIL import Image  # pyvista brings it along

    picture = Image.fromarray(pixels)
    # every fourth pixel of every fourth row has all colours, and takes a tenth of the time
    sample = picture.resize((picture.width // 4, picture.height // 4), resample=0)
    palette = sample.quantize(kmeans=1) if dots else sample.quantize(method=1)
    dither = Image.Dither.FLOYDSTEINBERG if dots else Image.Dither.NONE
    picture.quantize(palette=palette, dither=dither).save(path, optimize=True)


def _layout(count: int, points, view) -> tuple[int, int]:
    """Return rows and columns in which frames of this shape come out largest."""
    _, right, upward, _ = view
    wide, high = np.ptp(points @ right), np.ptp(points @ upward)

    def scale(across: int) -> float:
        down = -(-count // across)
        return min(USABLE[0] * SIZE[0] / across / wide, USABLE[1] * SIZE[1] / down / high)

    across = max(range(1, count + 1), key=scale)
    return -(-count // across), across


def _lamps(canvas: Canvas, length, view) -> None:
    """Put a lamp over the left shoulder of the viewer and a weak one on the other side."""
    _, right, upward, back = view
    canvas.lamp(10 * length * (0.7 * upward - 0.5 * right + back), 0.75)
    canvas.lamp(10 * length * (-0.5 * upward + 0.6 * right + 0.8 * back), 0.35)


def _heading(title: str) -> np.ndarray:
    """Return pixels (height, width, 3) of a title over several frames."""
    canvas = Canvas(SIZE[0], HEADING)
    canvas.words(title, 0.3, 26)
    return canvas.pixels()


def _words(canvas: Canvas, title: str, caption: str) -> None:
    """Write title and caption of a frame, the caption smaller where it stands alone."""
    for words, height, size in ((title, 0.92, 30), (caption, 0.86, 22 if title else 18)):
        if words:
            canvas.words(words, height, size)


def _bar(
    canvas: Canvas,
    scale,
    count: int,
    what: str = "displacement / max",
    labels: int = 6,
    form: str = "%.1f",
) -> None:
    """Draw the scale of colours: of a displacement or a shade as a share of the largest."""
    alone = count == 1
    # The bar's own title would sit on its labels.
    canvas.words(what, 0.105 if alone else 0.12, 20 if alone else 16)
    canvas.bar(scale, 0.36 if alone else 0.7, 20 if alone else 16, labels if alone else 3, form)


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


def _aim(canvas: Canvas, undeformed, drawn, aspect, right, upward, back):
    """Aim a parallel projection that fills the frame between title and colour bar."""
    a, b = drawn @ right, drawn @ upward
    height = max(np.ptp(b) / USABLE[1], np.ptp(a) / USABLE[0] * aspect)
    middle = (a.max() + a.min()) / 2 * right + ((b.max() + b.min()) / 2 - 0.02 * height) * upward
    canvas.aim(middle, 3 * np.ptp(undeformed, axis=0).max() * back, upward, height)


if __name__ == "__main__":
    sys.exit(_main(Path(sys.argv[1]), Other(int(sys.argv[2]))))
