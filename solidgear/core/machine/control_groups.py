"""Linux control groups of this process, which may grant it less than the machine has."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path


def control_groups(root: Path, controller: str) -> Iterator[tuple[Path, bool]]:
    """Yield the groups of this process below a root, from the lowest up to the top, for each may
    carry the limit of a controller (``cpu`` or ``memory``; version 1 has a tree for each), and True
    for version 2.
    """
    for line in text_of(root / "proc/self/cgroup").splitlines():
        _, kinds, path = line.split(":", 2)
        if kinds == "":
            top = root / "sys/fs/cgroup"
        elif controller in kinds.split(","):
            top = root / "sys/fs/cgroup" / controller
        else:
            continue
        group = top / path.lstrip("/")
        # Inside a container the path is that of the host and need not exist here: its group is then
        # mounted at the top.
        for place in [group, *group.parents] if group.is_dir() else [top]:
            yield place, kinds == ""
            if place == top:
                break


def text_of(path: Path) -> str:
    """Return the text of a file, empty where it cannot be read."""
    try:
        return path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
