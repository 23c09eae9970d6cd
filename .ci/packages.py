#!/usr/bin/env python3
"""What would be published: built, unpacked, and tried from there.

    python .ci/packages.py [FOLDER]         # build/packages unless told otherwise

The source distribution holds all that is under version control, and the tests that reach farthest into the tree are
collected from it; the wheel is built from the source distribution and holds scenes, templates and `py.typed`.  Needs the extra `dev`.
"""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
#: tracked, and of use only in a checkout
CHECKOUT = (".ci/", ".git", ".pre-commit")
#: into documentation, notebooks, examples, scenes, validation and what tests share
REACHING = [
    f"tests/test_{name}.py" for name in ("docs", "notebooks", "examples", "campaign", "report")
]


def tracked() -> list[str]:
    """Files under version control, but for those of a checkout alone."""
    names = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout
    return [name for name in names.splitlines() if not name.startswith(CHECKOUT)]


def missing_in_wheel(wheel: Path, names: list[str]) -> list[str]:
    """Files of the package and scenes that the wheel does not hold."""
    held = zipfile.ZipFile(wheel).namelist()
    needed = [name for name in names if name.startswith("solidgear/")]
    scenes = [name for name in names if name.startswith("geometry/")]
    lost = sorted({*needed} - {*held})
    return lost + [
        name for name in scenes if not any(h.endswith(f"/share/solidgear/{name}") for h in held)
    ]


def main() -> int:
    """Build and check; 0 if all is there."""
    out = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build" / "packages").resolve()
    for old in out.glob("solidgear-*"):
        if old.is_file():
            old.unlink()
    subprocess.run(
        [sys.executable, "-m", "build", "--outdir", str(out), str(ROOT)],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    (source,), (wheel,) = out.glob("*.tar.gz"), out.glob("*.whl")
    names = tracked()
    lost = missing_in_wheel(wheel, names)
    shutil.rmtree(out / "unpacked", ignore_errors=True)
    shutil.unpack_archive(source, out / "unpacked")
    (tree,) = (out / "unpacked").glob("solidgear-*")
    lost += [f"sdist: {name}" for name in names if not (tree / name).exists()]
    if lost:
        print("not packaged: " + ", ".join(lost), file=sys.stderr)
        return 1
    # from the tree itself, not from what is installed beside it
    collect = [
        sys.executable,
        "-m",
        "pytest",
        "-n0",
        "--collect-only",
        "-p",
        "no:cacheprovider",
        *REACHING,
    ]
    done = subprocess.run(collect, cwd=tree, capture_output=True, text=True)
    print(
        f"{source.name} {source.stat().st_size / 1e6:.1f} MB, {wheel.name} {wheel.stat().st_size / 1e6:.1f} MB;",
        end=" ",
    )
    print(f"tests of the unpacked source: {done.stdout.strip().splitlines()[-1]}")
    if done.returncode:
        print(done.stdout + done.stderr, file=sys.stderr)
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
