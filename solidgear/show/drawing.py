"""The drawing process: deformed shapes as PNG files, one or several frames each, and shaded surfaces.

    python -m solidgear.show.drawing FOLDER CALLER

:mod:`solidgear.show.render` starts it, with the number of its process, and reads how it ended; it
imports next to nothing of solidgear, and so starts quickly.
"""

from __future__ import annotations

import json
import os
import sys
import time
from pathlib import Path

import numpy as np

from solidgear.core.machine.processes import Other

SIZE = (1200, 700)
#: height of a title over several frames
HEADING = 44
#: largest drawn displacement, as a share of the length of what is drawn
SWING = 0.08
#: share of a frame, across and up, that a shape may fill
USABLE = (0.90, 0.68)
OUTLINE = "#5c6b7a"
#: file that says that all pictures are asked for, and s between two looks for it and them
LAST, PAUSE = "last", 0.02
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
    import pyvista as pv

    pv.OFF_SCREEN = True
    # Drawing nothing is what fails where there is no OpenGL.
    probe = pv.Plotter(off_screen=True, window_size=[16, 16])
    probe.show(auto_close=False)
    probe.close()
    index = 0
    while True:
        no_more = (room / LAST).exists()
        if (room / f"{index}.json").exists():
            _drawn(pv, room, index)
            index += 1
        elif no_more or not caller.alive:
            break
        else:
            time.sleep(PAUSE)
    return 0


def _drawn(pv, room: Path, index: int) -> None:
    """Draw a picture, or write why it could not be drawn."""
    target, partial = room / f"{index}.png", room / f"{index}.part.png"
    if target.exists():
        return  # by an earlier child
    job = json.loads((room / f"{index}.json").read_text(encoding="utf-8"))
    try:
        with np.load(room / f"{index}.npz") as store:
            arrays = [store[name] for name in ARRAYS]
            if "shades" in store:
                _draw_shaded(pv, job, partial, store["shades"], *arrays)
            else:
                _draw(pv, job, partial, *arrays)
        os.replace(partial, target)
    except Exception as error:  # a bad picture must not cost the others
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        (room / f"{index}.txt").write_text(reason, encoding="utf-8")


def _draw(pv, job, path, points, displacement, faces, triangles, lines):
    from PIL import Image  # pyvista brings it along

    size = np.linalg.norm(displacement, axis=1)
    if not np.isfinite(size).all() or not size.max() > 0:
        raise ValueError("the displacement is zero or not finite")
    length = np.ptp(points[:, 1]) if job["along"] else np.ptp(points, axis=0).max()
    displacement = displacement * (SWING * length / size.max())
    view = _view(displacement) if job["along"] else FROM_ABOVE
    displacement = displacement * _sign(points, displacement, view[0])
    cells = _cells(faces, triangles)
    undeformed = pv.PolyData(points, cells)
    frames = job["frames"]
    extremes = np.vstack([points, *(points + factor * displacement for factor, _ in frames)])
    down, across = _layout(len(frames), extremes, view)
    tile = [SIZE[0] // across, SIZE[1] // down]
    # one title over several frames, which have no room for it
    head = _heading(pv, job["title"]) if len(frames) > 1 else np.empty((0, SIZE[0], 3), np.uint8)
    picture = np.full((SIZE[1], SIZE[0], 3), 255, np.uint8)
    # A window a frame: smoothing of edges leaves all but one part of a divided window black.
    for k, (factor, caption) in enumerate(frames):
        p = pv.Plotter(off_screen=True, window_size=tile, lighting="none")
        p.set_background("white")
        p.enable_anti_aliasing("ssaa")
        deformed = pv.PolyData(points + factor * displacement, cells)
        deformed["size"] = abs(factor) * size / size.max()
        body = _frame(pv, p, undeformed, deformed, lines, length, view, job["along"])
        _words(p, "" if len(head) else job["title"], caption)
        if k == 0:
            _axes(p)
        if k == len(frames) - 1:
            _bar(p, body, len(frames))
        _aim(p, points, extremes, tile[1] / tile[0], *view[1:])
        drawn = p.screenshot(return_img=True)
        p.close()
        top, x = k // across * tile[1], k % across * tile[0]
        picture[top : top + tile[1], x : x + tile[0]] = drawn[..., :3]
    _in_few_colours(Image.fromarray(np.concatenate([head, picture]))).save(path, optimize=True)


def _draw_shaded(pv, job, path, shades, points, _, faces, triangles, lines):
    """Draw a surface at rest, its faces in the colours of shades, seen from the side of the largest."""
    from PIL import Image

    if not np.isfinite(shades).all() or not shades.max() > 0:
        raise ValueError("the shades are zero or not finite")
    surface = pv.PolyData(points, _cells(faces, triangles))
    surface.cell_data["shade"] = np.clip(shades / shades.max(), FAINT, 1.0)
    view = _facing(points, faces if len(faces) else triangles, shades)
    length = np.ptp(points, axis=0).max()
    p = pv.Plotter(off_screen=True, window_size=list(SHADED), lighting="none")
    p.set_background("white")
    p.enable_anti_aliasing("ssaa")
    _lamps(pv, p, length, view)
    body = p.add_mesh(
        surface,
        scalars="shade",
        cmap="YlOrRd",
        log_scale=True,
        clim=(FAINT, 1.0),
        show_scalar_bar=False,
        ambient=0.6,
        diffuse=0.5,
        specular=0.0,
    )
    nearer = 0.004 * length * view[3]
    p.add_mesh(
        _wires(pv, points + nearer, lines),
        color="black",
        line_width=1.0,
        opacity=0.25,
        lighting=False,
    )
    p.add_silhouette(surface, color=OUTLINE, line_width=3.5, feature_angle=None)
    _words(p, job["title"], "")
    _axes(p)
    _bar(p, body, 1, job["shade"], 4, "%.3g")
    _aim(p, points, points, SHADED[1] / SHADED[0], *view[1:])
    drawn = p.screenshot(return_img=True)
    p.close()
    # flat faces have few colours, and dots between them would take twice the bytes
    _in_few_colours(Image.fromarray(drawn[..., :3]), dots=False).save(path, optimize=True)


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


def _cells(faces, triangles) -> np.ndarray:
    """Return faces as VTK lists them."""
    return np.concatenate([np.insert(f, 0, f.shape[1], axis=1).ravel() for f in (faces, triangles)])


def _in_few_colours(picture, dots=True):
    """Return the picture with a palette, dithered with `dots`, in half the bytes."""
    # every fourth pixel of every fourth row has all colours, and takes a tenth of the time
    sample = picture.resize((picture.width // 4, picture.height // 4), resample=0)
    palette = sample.quantize(kmeans=1) if dots else sample.quantize(method=1)
    return picture.quantize(palette=palette, dither=3 if dots else 0)


def _layout(count: int, points, view) -> tuple[int, int]:
    """Return rows and columns in which frames of this shape come out largest."""
    _, right, upward, _ = view
    wide, high = np.ptp(points @ right), np.ptp(points @ upward)

    def scale(across: int) -> float:
        down = -(-count // across)
        return min(USABLE[0] * SIZE[0] / across / wide, USABLE[1] * SIZE[1] / down / high)

    across = max(range(1, count + 1), key=scale)
    return -(-count // across), across


def _frame(pv, p, undeformed, deformed, lines, length, view, along):
    """Draw one deformed shape over the shape at rest; return the actor with the colours."""
    _lamps(pv, p, length, view)
    back = view[3]
    look = {
        "smooth_shading": True,
        "split_sharp_edges": True,
        "feature_angle": 35,
        # from above more of a surface faces the lamps
        "ambient": 0.5 if along else 0.3,
        "diffuse": 0.7,
        "specular": 0.05,
    }
    body = p.add_mesh(
        deformed, scalars="size", cmap=colours(), clim=(0, 1), show_scalar_bar=False, **look
    )
    # Lines on a surface are brought a hair nearer, or they would sink into it here and there.
    nearer = 0.004 * length * back
    p.add_mesh(
        _wires(pv, deformed.points + nearer, lines),
        color="black",
        line_width=2.0,
        opacity=0.2,
        lighting=False,
    )
    edges = {
        "feature_angle": 30,
        "boundary_edges": False,
        "non_manifold_edges": False,
        "manifold_edges": False,
    }
    p.add_mesh(
        deformed.extract_feature_edges(**edges).translate(nearer),
        color="#202020",
        line_width=3.0,
        lighting=False,
    )
    p.add_mesh(
        undeformed.extract_feature_edges(**edges).translate(nearer),
        color=OUTLINE,
        line_width=3.0,
        lighting=False,
    )
    p.add_silhouette(undeformed, color=OUTLINE, line_width=3.5, feature_angle=None)
    return body


def _lamps(pv, p, length, view) -> None:
    """Put a lamp over the left shoulder of the viewer and a weak one on the other side."""
    _, right, upward, back = view
    for offset, strength in (
        (0.7 * upward - 0.5 * right + back, 0.75),
        (-0.5 * upward + 0.6 * right + 0.8 * back, 0.35),
    ):
        p.add_light(
            pv.Light(
                position=10 * length * offset,
                focal_point=(0, 0, 0),
                light_type="scene light",
                intensity=strength,
            )
        )


def _heading(pv, title: str) -> np.ndarray:
    """Return pixels (height, width, 3) of a title over several frames."""
    p = pv.Plotter(off_screen=True, window_size=[SIZE[0], HEADING], lighting="none")
    p.set_background("white")
    _text(p, title, 0.3, 13)
    drawn = p.screenshot(return_img=True)
    p.close()
    return drawn[..., :3]


def _words(p, title: str, caption: str) -> None:
    """Draw title and caption of a frame, the caption smaller where it stands alone."""
    for words, height, font in ((title, 0.92, 15), (caption, 0.86, 11 if title else 9)):
        if words:
            _text(p, words, height, font)


def _text(p, words: str, height: float, font: int) -> None:
    text = p.add_text(
        words, position=(0.5, height), viewport=True, font_size=font, color="black", font="arial"
    )
    text.prop.justification_horizontal = "center"


def _bar(
    p, body, count: int, what: str = "displacement / max", labels: int = 6, form: str = "%.1f"
) -> None:
    """Draw the scale of colours: of a displacement or a shade as a share of the largest."""
    alone = count == 1
    _text(p, what, 0.105 if alone else 0.12, 10 if alone else 8)
    # The bar's own title would sit on its labels.
    bar = {
        "title": "",
        "label_font_size": 20 if alone else 16,
        "color": "black",
        "n_labels": labels if alone else 3,
        "fmt": form,
        "font_family": "arial",
    }
    wide = 0.36 if alone else 0.7
    p.add_scalar_bar(
        mapper=body.mapper,
        width=wide,
        height=0.075,
        position_x=(1 - wide) / 2,
        position_y=0.02,
        **bar,
    )


def _axes(p) -> None:
    p.add_axes(
        xlabel="x",
        ylabel="y",
        zlabel="z",
        color="black",
        line_width=4,
        label_size=(0.25, 0.13),
        viewport=(0.0, 0.0, 0.2, 0.34),
    )


def colours():
    """Return viridis without its darkest part, on which neither shading nor lines can be seen."""
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    return ListedColormap(colormaps["viridis"](np.linspace(0.14, 1.0, 256)))


def _wires(pv, points, lines):
    out = pv.PolyData()
    out.points, out.lines = points, np.insert(lines, 0, 2, axis=1).ravel()
    return out


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


def _aim(p, undeformed, drawn, aspect, right, upward, back):
    """Aim a parallel projection that fills the frame between title and colour bar."""
    a, b = drawn @ right, drawn @ upward
    height = max(np.ptp(b) / USABLE[1], np.ptp(a) / USABLE[0] * aspect)
    middle = (a.max() + a.min()) / 2 * right + ((b.max() + b.min()) / 2 - 0.02 * height) * upward
    p.camera.parallel_projection = True
    p.camera.focal_point = middle
    p.camera.position = middle + 3 * np.ptp(undeformed, axis=0).max() * back
    p.camera.up = upward
    p.camera.parallel_scale = height / 2
    p.renderer.reset_camera_clipping_range()


if __name__ == "__main__":
    sys.exit(_main(Path(sys.argv[1]), Other(int(sys.argv[2]))))
