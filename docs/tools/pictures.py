"""Pictures of the pages, drawn by the program from the scene of the tutorial, a shipped one and a train.

python docs/tools/pictures.py
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from console import ROOT, blocks, run
from PIL import Image

import solidgear as sg

DOCS = Path(__file__).parent.parent
PICTURES = DOCS / "pictures"
#: name of the picture: its widest side, pixels
WIDTHS = {"section": 900, "mode": 800, "response": 900, "turning": 1000, "contact": 900}
#: the state in which the page of mode shapes is taken
POSE = """<script>addEventListener("load", () => {
const viewer = document.querySelector(".sg-turn").viewer;
viewer.ready.then(() => { viewer.play(false); viewer.rotate(17, 7); }); })</script>"""


def tutorial_scene() -> str:
    """The scene that the tutorial writes."""
    return next(
        "\n".join(b.lines) for b in blocks((DOCS / "tutorial.md").read_text()) if b.kind == "toml"
    )


def small(source: Path, name: str) -> None:
    """A picture at the size of the page; a mode in all its colours, for steps look like facets."""
    with Image.open(source) as picture:
        width = WIDTHS[name]
        height = round(picture.height * width / picture.width)
        scaled = picture.convert("RGB").resize((width, height), Image.Resampling.LANCZOS)
        if name != "mode":
            scaled = scaled.quantize(256 if name in ("turning", "contact") else 64)
        scaled.save(PICTURES / f"{name}.png", optimize=True)


def screenshot(
    page: Path, target: Path, size: tuple[int, int], milliseconds: int, *flags: str
) -> None:
    """A page as a browser without a screen shows it after some time."""
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        raise SystemExit("pictures of pages need Chromium")
    command = [browser, "--headless", "--no-sandbox", "--hide-scrollbars", *flags]
    command += ["--window-size={},{}".format(*size), f"--virtual-time-budget={milliseconds}"]
    subprocess.run([*command, f"--screenshot={target}", page.as_uri()], check=True)


def turning(page: Path, target: Path) -> None:
    """What a browser without a screen shows of a page of mode shapes."""
    page.write_text(page.read_text() + POSE)
    screenshot(page, target, (1200, 640), 8000, "--enable-unsafe-swiftshader")


def report(page: Path) -> None:
    """Page one of a report on a desk, in the dark and on a phone, as a browser shows it."""
    dark = "--blink-settings=preferredColorScheme=0"
    for name, (width, height), flags in (
        ("report_page_one", (1280, 1120), []),
        ("report_dark", (1280, 1120), [dark]),
        ("report_phone", (390, 1360), []),
    ):
        # a window has a least width; a frame has not
        frame = (
            f'<iframe style="border: 0" width="{width}" height="{height}" src="{page.as_uri()}">'
        )
        shell = page.with_name(f"{name}.html")
        shell.write_text(f'<!DOCTYPE html><body style="margin: 0">{frame}</iframe>')
        target = page.with_name(f"{name}.png")
        screenshot(shell, target, (max(width, 600), height), 4000, *flags)
        with Image.open(target) as picture:
            cut = picture.convert("RGB").crop((0, 0, width, height))
            cut.quantize(64).save(PICTURES / f"{name}.png", optimize=True)


def main() -> int:
    """Draw them all."""
    PICTURES.mkdir(exist_ok=True)
    folder = Path(tempfile.mkdtemp())
    scene = folder / "my_shaft.toml"
    scene.write_text(tutorial_scene())
    sg.load(scene).plot().write(folder / "section.png")
    small(folder / "section.png", "section")
    said = run("solidgear render my_shaft.toml --out mode.png", folder)
    said += run("solidgear render my_shaft.toml -f solid --beside timoshenko --turn m.html", folder)
    turning(folder / "m.html", folder / "turning.png")
    small(folder / "turning.png", "turning")
    train = ROOT / "geometry" / "axle_overhung.toml"
    said += run(
        f"solidgear response {train} --gear harmonic --against euler+euler --out out", folder
    )
    train = ROOT / "geometry" / "gearbox_two_stage.toml"
    said += run(f"solidgear contact {train} --no-curve --out contact", folder)
    small(folder / "contact" / "pattern_2.png", "contact")
    pinion = ROOT / "geometry" / "pinion_overhung.toml"
    said += run(f"solidgear compare {pinion} --out report", folder)
    report(folder / "report" / "report.html")
    small(folder / "mode.png", "mode")
    small(folder / "out" / "response.png", "response")
    print(said)
    return 0


if __name__ == "__main__":
    sys.exit(main())
