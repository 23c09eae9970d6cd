"""Pictures of mode shapes, drawn in a child process.

Without the system's OpenGL libraries VTK does not raise, it takes the process down with a
segmentation fault. So a child draws, the caller reads how it ended, and a failed picture never costs
a number.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:  # the child starts quickly because it imports nothing else of solidgear
    from solidgear.body.surface import Surface

SIZE = (1200, 700)
#: largest drawn displacement, as a share of the length of the shaft
SWING = 0.08
PACKAGES = (
    "apt-get install libgl1 libegl1 libegl-mesa0 libglu1-mesa "
    "libxft2 libxinerama1 libxcursor1 libgomp1"
)
WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
OUTLINE = "#5c6b7a"
ARRAYS = ("points", "displacement", "faces", "triangles", "lines")


@dataclass(frozen=True, eq=False)
class RenderJob:
    """One picture to draw.

    Attributes
    ----------
    surface : Surface
    title : str
        Such as ``harmonic - bending 1 - 2758.0 Hz``.
    path : str or Path
        Of the png.
    """

    surface: Surface
    title: str
    path: str | Path


@dataclass(frozen=True)
class RenderResult:
    """How a :class:`RenderJob` ended.

    Attributes
    ----------
    ok : bool
    path : Path
        Holds the new picture if ``ok``; otherwise whatever was there before is untouched.
    reason : str
        One sentence on what went wrong, and what mends it; empty if ``ok``.
    no_renderer : bool
        Whether the reason is that this machine cannot draw at all.
    """

    ok: bool
    path: Path
    reason: str = ""
    no_renderer: bool = False


def render_modes(jobs: Iterable[RenderJob], *, timeout: float = 120) -> list[RenderResult]:
    """Draw deformed shafts, coloured by displacement, over their shape at rest.

    Parameters
    ----------
    jobs : iterable of RenderJob
    timeout : float
        For all of them together, s.

    Returns
    -------
    list of RenderResult
        One per job, in order. Nothing is raised for a picture that could not be drawn or written.
    """
    jobs = list(jobs)
    if not jobs:
        return []
    deadline = time.monotonic() + timeout
    with tempfile.TemporaryDirectory(prefix="solidgear-render-") as folder:
        room = Path(folder)
        arrays = {
            f"{i}.{name}": getattr(job.surface, name)
            for i, job in enumerate(jobs)
            for name in ARRAYS
        }
        np.savez(room / "surfaces.npz", **arrays)
        (room / "titles.json").write_text(json.dumps([job.title for job in jobs]), encoding="utf-8")
        end = ""
        for window in _windows():
            end = _child(room, window, deadline - time.monotonic())
            # A child that reached the end of its list has said all there is to say.
            if not end or deadline - time.monotonic() <= 0:
                break
        works = (room / "window").exists()
        return [
            _collect(room, i, Path(job.path), end, works, timeout) for i, job in enumerate(jobs)
        ]


def _windows() -> list[str | None]:
    """VTK windows to try in turn; None leaves the choice to VTK."""
    if not sys.platform.startswith("linux") or WINDOW in os.environ:
        return [None]
    # A display that is set may still be dead, as over a lost ssh connection.
    return ([None] if os.environ.get("DISPLAY") else []) + [
        "vtkEGLRenderWindow",
        "vtkOSOpenGLRenderWindow",
    ]


def _child(room: Path, window: str | None, seconds: float) -> str:
    """Run one child on what is still to be drawn; returns how it died, or nothing."""
    env = dict(os.environ)
    if window:
        env[WINDOW] = window
    # The child must find the same solidgear, wherever the caller runs.
    here = str(Path(__file__).resolve().parents[2])
    env["PYTHONPATH"] = os.pathsep.join(filter(None, [here, env.get("PYTHONPATH")]))
    command = [sys.executable, "-m", "solidgear.report.render", str(room)]
    try:
        done = subprocess.run(
            command,
            env=env,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=max(seconds, 0.1),
            errors="replace",
        )
    except subprocess.TimeoutExpired:
        return "timeout"
    except OSError as error:
        return f"could not be started ({error})"
    if done.returncode == 0:
        return ""
    if done.returncode < 0:
        return f"was ended by signal {-done.returncode}"
    last = next((line.strip() for line in reversed(done.stderr.splitlines()) if line.strip()), "")
    return f"ended with status {done.returncode}" + (f" ({last[:200]})" if last else "")


def _collect(
    room: Path, index: int, path: Path, end: str, works: bool, timeout: float
) -> RenderResult:
    """Move a finished picture to its place, or say why there is none."""
    from solidgear.machine.whole_file import whole

    drawn, said = room / f"{index}.png", room / f"{index}.txt"
    if said.exists():
        return RenderResult(
            False,
            path,
            f"the picture {path.name} could not be drawn: {said.read_text(encoding='utf-8')}",
        )
    if drawn.exists():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with whole(path) as partial:
                shutil.copyfile(drawn, partial)
        except OSError as error:
            return RenderResult(
                False, path, f"the picture {path} could not be written: {error.strerror or error}"
            )
        return RenderResult(True, path)
    if end == "timeout":
        return RenderResult(
            False,
            path,
            f"the picture {path.name} was not drawn within {timeout:g} s; allow more time, "
            f"or on Debian and Ubuntu mend OpenGL by `{PACKAGES}`",
        )
    what = end or "left no picture"
    return RenderResult(
        False,
        path,
        f"the drawing process {what}; on Debian and Ubuntu OpenGL is mended by `{PACKAGES}`",
        not works,
    )


# --------------------------------------------------------------------------- in the child
def _main(room: Path) -> int:
    if os.environ.get("SOLIDGEAR_RENDERER") == "none":
        print("SOLIDGEAR_RENDERER=none", file=sys.stderr)
        return 3
    import pyvista as pv

    pv.OFF_SCREEN = True
    # Drawing nothing is what fails where there is no OpenGL; past this mark the renderer is not to
    # blame.
    probe = pv.Plotter(off_screen=True, window_size=[16, 16])
    probe.show(auto_close=False)
    probe.close()
    (room / "window").touch()
    titles = json.loads((room / "titles.json").read_text(encoding="utf-8"))
    with np.load(room / "surfaces.npz") as store:
        for i, title in enumerate(titles):
            target, partial = room / f"{i}.png", room / f"{i}.part.png"
            if target.exists():
                continue  # by an earlier child
            try:
                _draw(pv, title, partial, *(store[f"{i}.{name}"] for name in ARRAYS))
                os.replace(partial, target)
            except Exception as error:  # a bad picture must not cost the others
                (room / f"{i}.txt").write_text(
                    " ".join(f"{type(error).__name__}: {error}".split()), encoding="utf-8"
                )
    return 0


def _draw(pv, title, path, points, displacement, faces, triangles, lines):
    size = np.linalg.norm(displacement, axis=1)
    if not np.isfinite(size).all() or not size.max() > 0:
        raise ValueError("the displacement is zero or not finite")
    length = np.ptp(points[:, 1])
    displacement = displacement * (SWING * length / size.max())
    plane, right, up, back = _view(points, displacement)
    displacement = displacement * _sign(points, displacement, plane)
    cells = np.concatenate(
        [np.insert(f, 0, f.shape[1], axis=1).ravel() for f in (faces, triangles)]
    )
    rest, deformed = pv.PolyData(points, cells), pv.PolyData(points + displacement, cells)
    deformed["size"] = size / size.max()
    p = pv.Plotter(off_screen=True, window_size=SIZE, lighting="none")
    p.set_background("white")
    p.enable_anti_aliasing("ssaa")
    # A lamp over the left shoulder of the viewer and a weak one from the other side.
    for offset, strength in (
        (0.7 * up - 0.5 * right + back, 0.75),
        (-0.5 * up + 0.6 * right + 0.8 * back, 0.35),
    ):
        p.add_light(
            pv.Light(
                position=10 * length * offset,
                focal_point=(0, 0, 0),
                light_type="scene light",
                intensity=strength,
            )
        )
    look = {
        "smooth_shading": True,
        "split_sharp_edges": True,
        "feature_angle": 35,
        "ambient": 0.5,
        "diffuse": 0.7,
        "specular": 0.05,
    }
    body = p.add_mesh(
        deformed, scalars="size", cmap=_colours(), clim=(0, 1), show_scalar_bar=False, **look
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
        rest.extract_feature_edges(**edges).translate(nearer),
        color=OUTLINE,
        line_width=3.0,
        lighting=False,
    )
    p.add_silhouette(rest, color=OUTLINE, line_width=3.5, feature_angle=None)
    for words, height, font in ((title, 0.92, 15), ("displacement / max", 0.105, 10)):
        text = p.add_text(
            words,
            position=(0.5, height),
            viewport=True,
            font_size=font,
            color="black",
            font="arial",
        )
        text.prop.justification_horizontal = "center"
    # The bar's own title would sit on its labels.
    bar = {
        "title": "",
        "label_font_size": 20,
        "color": "black",
        "n_labels": 6,
        "fmt": "%.1f",
        "font_family": "arial",
    }
    p.add_scalar_bar(
        mapper=body.mapper, width=0.36, height=0.075, position_x=0.32, position_y=0.02, **bar
    )
    p.add_axes(
        xlabel="x",
        ylabel="y",
        zlabel="z",
        color="black",
        line_width=4,
        label_size=(0.25, 0.13),
        viewport=(0.0, 0.0, 0.2, 0.34),
    )
    _aim(p, points, points + displacement, right, up, back)
    p.screenshot(str(path))
    p.close()


def _colours():
    """viridis without its darkest part, on which neither shading nor lines can be seen."""
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    return ListedColormap(colormaps["viridis"](np.linspace(0.14, 1.0, 256)))


def _wires(pv, points, lines):
    out = pv.PolyData()
    out.points, out.lines = points, np.insert(lines, 0, 2, axis=1).ravel()
    return out


def _view(points, displacement):
    """Direction of the motion across the axis; and right, up and towards the viewer, with y to the
    right and that motion up.
    """
    across = displacement[:, [0, 2]]
    w, v = np.linalg.eigh(across.T @ across)
    # Motion without a plane of its own (torsion, axial, a ring breathing) is seen from +x.
    d = v[:, 1] if w[1] > 2 * w[0] else np.array([0.0, 1.0])
    d = d if d[np.argmax(np.abs(d))] > 0 else -d
    y, plane = np.array([0.0, 1.0, 0.0]), np.array([d[0], 0.0, d[1]])
    side = np.cross(y, plane)
    # Seen a little from above and from the end, so that a round thing looks round.
    height, turn = np.deg2rad(18), np.deg2rad(-22)
    back = np.cos(height) * (np.cos(turn) * side + np.sin(turn) * y) + np.sin(height) * plane
    right = y - (y @ back) * back
    right /= np.linalg.norm(right)
    return plane, right, np.cross(back, right), back


def _sign(points, displacement, plane) -> float:
    """The sign of a shape is free: where it moves most, let it move up, along +y, or about +y."""
    i = np.argmax((displacement**2).sum(axis=1))
    d, r = displacement[i], points[i] * [1.0, 0.0, 1.0]
    about = np.cross(r, d)[1] / max(np.linalg.norm(r), 1e-300)
    choice = max((d @ plane, d[1], about), key=abs)
    return -1.0 if choice < 0 else 1.0


def _aim(p, rest, moved, right, up, back):
    """Parallel projection that fills the frame between the title and the colour bar."""
    both = np.vstack([rest, moved])
    a, b = both @ right, both @ up
    usable = np.array([0.90, 0.68])
    height = max(np.ptp(b) / usable[1], np.ptp(a) / usable[0] * SIZE[1] / SIZE[0])
    middle = (a.max() + a.min()) / 2 * right + ((b.max() + b.min()) / 2 - 0.02 * height) * up
    p.camera.parallel_projection = True
    p.camera.focal_point = middle
    p.camera.position = middle + 3 * np.ptp(rest[:, 1]) * back
    p.camera.up = up
    p.camera.parallel_scale = height / 2
    p.renderer.reset_camera_clipping_range()


if __name__ == "__main__":
    sys.exit(_main(Path(sys.argv[1])))
