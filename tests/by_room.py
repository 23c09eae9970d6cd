"""Tests of one room: those files that import it, themselves or by a helper beside them."""

import ast
import functools
from pathlib import Path

TESTS = Path(__file__).parent
PACKAGE = TESTS.parent / "solidgear"
#: runs whatever the room: who may import whom
ALWAYS = ("test_house.py",)


def is_room(name):
    """Whether the package has such a folder or module; dots lead into folders."""
    path = PACKAGE.joinpath(*name.split("."))
    return path.is_dir() or path.with_suffix(".py").exists()


@functools.cache
def named(path):
    """Dotted names that a file imports, wherever in it, and attributes that it takes of the package."""
    names, attributes = set(), set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            if node.value.id in ("sg", "solidgear"):
                attributes.add(node.attr)
    return names, attributes


def imported(path):
    """Dotted names that a file imports."""
    return named(path)[0]


@functools.cache
def exported():
    """Module of each name that the package hands to users."""
    tree = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8"))
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    return {alias.name: node.module for node in imports for alias in node.names}


@functools.cache
def taken_from_the_door(path):
    """Modules of the exported names that a file writes, such as `sg.correlate`."""
    names, attributes = named(path)
    names = {name.removeprefix("solidgear.") for name in names}
    return {module for name, module in exported().items() if name in attributes | names}


def helpers(path):
    """Modules beside a test file that it imports."""
    stems = {name.removeprefix("tests.").partition(".")[0] for name in imported(path)}
    return [file for stem in sorted(stems) if (file := TESTS / f"{stem}.py").exists()]


def belongs(path, room):
    """Whether a test file is one of a room."""
    if path.name in ALWAYS:
        return True
    files = (path, *helpers(path))
    names = {name for file in files for name in imported(file) | taken_from_the_door(file)}
    return any(f"{name}.".startswith(f"solidgear.{room}.") for name in names)
