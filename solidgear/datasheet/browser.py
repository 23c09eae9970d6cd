"""Pages as PDF by a browser without a window: Chromium, Chrome or Edge, without network."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from solidgear.core import SolidgearError

#: variable that names another browser
VARIABLE = "BROWSER"
#: programs that print by the same options, as the path of commands has them
PROGRAMS = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "microsoft-edge",
    "microsoft-edge-stable",
    "msedge",
)
#: where the makers' installers put them
INSTALLED = {
    "darwin": (
        "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
        "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
        "/Applications/Chromium.app/Contents/MacOS/Chromium",
    ),
    "win32": (
        r"C:\Program Files\Google\Chrome\Application\chrome.exe",
        r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe",
        r"C:\Program Files\Microsoft\Edge\Application\msedge.exe",
    ),
}
OPTIONS = (
    "--headless",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--no-pdf-header-footer",
    "--print-to-pdf-no-header",
)
#: s; a page takes one or two
PATIENCE = 120


def browser() -> str | None:
    """Return the program that prints pages; None where there is none."""
    variable = os.environ.get(VARIABLE, "")
    program = shutil.which(variable) if variable else None
    if program is not None and Path(program).stem.lower() in PROGRAMS:
        return program
    candidates = (*PROGRAMS, *INSTALLED.get(sys.platform, ()))
    return next(filter(None, map(shutil.which, candidates)), None)


def print_pdf(program: str, page: str, name: str) -> bytes:
    """Return a page of HTML as PDF; refused with the name of the file where the browser fails."""
    with tempfile.TemporaryDirectory(prefix="solidgear-sheet-") as folder:
        source, printed = Path(folder) / "sheet.html", Path(folder) / "sheet.pdf"
        source.write_text(page, encoding="utf-8")
        # a sandbox needs rights that root in a container does not have; the page is our own
        sandbox = ["--no-sandbox"] if _is_root() else []
        command = [program, *OPTIONS, *sandbox, f"--user-data-dir={folder}/profile"]
        command += [f"--print-to-pdf={printed}", source.as_uri()]
        try:
            subprocess.run(command, capture_output=True, timeout=PATIENCE, cwd=folder, check=False)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise SolidgearError(f"{name}: {_failed(program)} ({error})") from None
        if not printed.exists():
            raise SolidgearError(f"{name}: {_failed(program)}")
        return printed.read_bytes()


def pages_of(pdf: bytes) -> int:
    """Return the number of pages of a PDF as browsers write it."""
    return len(re.findall(rb"/Type\s*/Page\b", pdf))


def _failed(program: str) -> str:
    return f"{program} did not print the page; write .html and print it from a browser"


def _is_root() -> bool:
    return hasattr(os, "geteuid") and os.geteuid() == 0
