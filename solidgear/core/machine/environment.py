"""Environment that a result was made with."""

from __future__ import annotations

import platform
import subprocess
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from solidgear.core.machine.control_groups import text_of
from solidgear.core.machine.threads import usable_cores
from solidgear.core.machine.version import VERSION


def environment() -> dict:
    """Return versions (None of packages that are not there), processor, ``cores`` that this process
    may use, and date, for results.json.
    """
    out: dict = {"python": platform.python_version()}
    for name in ("solidgear", "numpy", "scipy", "scikit-fem", "gmsh", "pyvista", "pypardiso"):
        try:
            out[name] = version(name)
        except PackageNotFoundError:
            out[name] = None
    if out["solidgear"] is None:  # run from a source tree
        out["solidgear"] = VERSION
    out["platform"] = f"{platform.system()} {platform.machine()}"
    out["cpu"] = _cpu()
    out["cores"] = usable_cores()
    out["date"] = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    return out


def _cpu() -> str:
    """Return the name of the processor, as its maker calls it where the system says so."""
    for line in text_of(Path("/proc/cpuinfo")).splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return _cpu_of_mac() or _cpu_of_windows() or platform.processor() or "unknown"


def _cpu_of_mac() -> str:
    if platform.system() != "Darwin":
        return ""
    asked = ["/usr/sbin/sysctl", "-n", "machdep.cpu.brand_string"]
    try:
        return subprocess.run(asked, capture_output=True, encoding="utf-8").stdout.strip()
    except OSError:
        return ""


def _cpu_of_windows() -> str:
    try:
        import winreg
    except ImportError:
        return ""
    place = r"HARDWARE\DESCRIPTION\System\CentralProcessor\0"
    try:
        with winreg.OpenKey(winreg.HKEY_LOCAL_MACHINE, place) as key:  # type: ignore[attr-defined]
            return str(winreg.QueryValueEx(key, "ProcessorNameString")[0]).strip()  # type: ignore[attr-defined]
    except OSError:
        return ""
