"""Environment that a result was made with."""

from __future__ import annotations

import platform
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version

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
    try:
        with open("/proc/cpuinfo") as f:
            for line in f:
                if line.startswith("model name"):
                    return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or "unknown"
