"""Machines that lack something: the system libraries of gmsh and VTK, whole packages, and what only
Linux has.

What is missing is hidden by a `sitecustomize` that every process of a test reads, those that the
program starts itself too.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
#: as where libGL and its kin are not installed: the packages are there and cannot be loaded
DRAWN = ("gmsh", "pyvista", "vtk", "vtkmodules")
#: free and unfree factors, several processes, spreadsheets: extras
EXTRAS = ("pypardiso", "sksparse", "mumps", "joblib", "distributed", "pyarrow", "pandas", "xarray")
#: modules and functions that Windows does not have
POSIX = ("fcntl", "resource", "termios", "pwd", "grp")
FUNCTIONS = (
    "sched_getaffinity",
    "register_at_fork",
    "fork",
    "setpriority",
    "getuid",
    "geteuid",
    "sysconf",
    "getppid",
    "getpgid",
    "killpg",
)

HIDE = """
import os, sys
try:
    import psutil  # which has other ways where there are none of these
except ImportError:
    pass

class Hidden:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {names}:
            raise ImportError(name + " is hidden from this test")

sys.meta_path.insert(0, Hidden())
for name in {functions}:
    if hasattr(os, name):
        delattr(os, name)
"""
EVERYTHING = """
import importlib, pkgutil, solidgear
for found in pkgutil.walk_packages(solidgear.__path__, "solidgear."):
    if not found.name.endswith("__main__"):
        importlib.import_module(found.name)
"""


@pytest.fixture
def bare(tmp_path):
    """Runs Python on a machine without these modules and functions of `os`."""
    hidden = tmp_path / "hidden"
    hidden.mkdir()

    def run(*arguments, without, functions=()):
        (hidden / "sitecustomize.py").write_text(
            HIDE.format(names=tuple(without), functions=tuple(functions))
        )
        path = os.pathsep.join([str(hidden), str(ROOT)])
        return subprocess.run(
            [sys.executable, *arguments],
            cwd=tmp_path,
            env=os.environ | {"PYTHONPATH": path},
            capture_output=True,
            text=True,
            encoding="utf-8",
            timeout=300,
        )

    return run


def solidgear(*arguments):
    return ("-m", "solidgear.app", "--quiet", *map(str, arguments))


def scene(name):
    return ROOT / "geometry" / f"{name}.toml"


def test_what_is_hidden_is_hidden(bare):
    found = bare("-c", "import gmsh", without=DRAWN)
    assert "hidden from this test" in found.stderr
    assert bare("-c", "import os; os.fork", without=(), functions=FUNCTIONS).returncode == 1


def test_every_module_can_be_imported_without_any_of_it(bare):
    found = bare("-c", EVERYTHING, without=DRAWN + EXTRAS + POSIX, functions=FUNCTIONS)
    assert found.returncode == 0, found.stderr


TWO = """
import sys
from solidgear.app import main
for line in sys.argv[1:]:
    sys.argv = ["solidgear", "--quiet", *line.split()]
    try:
        main()
    except SystemExit as end:
        print(f"code {end.code}", flush=True)
"""


def test_the_harmonic_solid_answers_without_gmsh_and_vtk_and_what_needs_them_says_so(bare):
    lines = (
        f"answer {scene('pinion_overhung')} --tol 1e-2 --ask C_zz,bending",
        f"modes {scene('pinion_keyed')} -f solid",
    )
    found = bare("-c", TWO, *lines, without=DRAWN + EXTRAS)
    assert "Within the 1 % asked." in found.stdout
    assert re.findall("^code .*$", found.stdout, re.M) == ["code 0", "code 1"], found.stderr
    assert len(found.stderr.strip().splitlines()) == 1
    for words in ("gmsh cannot be loaded", "pip install gmsh", "apt-get install libglu1-mesa"):
        assert words in found.stderr


@pytest.mark.long
def test_a_comparison_writes_its_report_without_any_of_it(bare, tmp_path):
    out = tmp_path / "out"
    models = ("--models", "timoshenko,harmonic", "--set", "harmonic.order=2")
    models += ("--set", "harmonic.layers=0")
    asked = solidgear("compare", scene("shaft_stepped"), "--out", out, *models)
    found = bare(*asked, without=DRAWN + EXTRAS + POSIX, functions=FUNCTIONS)
    assert found.returncode == 0, found.stderr
    assert (out / "report.html").exists() and (out / "results.json").exists()
    # what is left out is told, and how to mend it
    assert "apt-get install" in found.stdout + found.stderr
