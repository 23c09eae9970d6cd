"""The house: which room may import which, no circle, and no file that has become two things."""

import ast
import functools
import graphlib
from pathlib import Path

import pytest

from validation.house.floors import MAY_IMPORT
from validation.house.source import sources
from validation.house.words import shapes

PACKAGE = Path(__file__).parent.parent / "solidgear"
#: lines of a file
LONGEST = 700


def statements(body):
    """All that runs, wherever in a file: what is for types alone does not."""
    for node in body:
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            continue
        yield node
        for inner in ("body", "orelse", "handlers", "finalbody", "cases"):
            yield from statements(getattr(node, inner, ()))


def imports(path):
    """Modules of this package that a file imports when it runs, wherever in it; names of types
    alone are no arrow.
    """
    for node in statements(ast.parse(path.read_text()).body):
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names = [f"{node.module}.{a.name}" for a in node.names]
        elif isinstance(node, ast.Import):
            names = [a.name for a in node.names]
        else:
            continue
        yield from (n for n in names if n.startswith("solidgear."))


def room(path):
    first = path.relative_to(PACKAGE).parts[0]
    return first.removesuffix(".py")


@functools.cache
def arrows():
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        for name in imports(path):
            there = name.split(".")[1]
            if there != room(path) and there != "__version__":
                found.setdefault(room(path), {}).setdefault(there, path.relative_to(PACKAGE))
    return found


FACES = {"__init__", "__main__", "cli"}


@functools.cache
def tree_of(path):
    """A file as Python reads it, once for all that look at it."""
    return ast.parse(path.read_text())


def test_a_room_imports_only_what_lies_below():
    wrong = {
        name: {there: str(p) for there, p in arrows().get(name, {}).items() if there not in below}
        for name, below in MAY_IMPORT.items()
    }
    assert not {name: found for name, found in wrong.items() if found}


def test_every_room_is_on_a_floor_and_there_is_no_circle():
    rooms = {room(p) for p in PACKAGE.rglob("*.py")}
    assert rooms - FACES == set(MAY_IMPORT)
    graphlib.TopologicalSorter(MAY_IMPORT).prepare()  # raises CycleError


def test_beams_share_no_code_with_solids():
    files = list((PACKAGE / "models" / "beam").rglob("*.py"))
    assert files
    for path in files:
        for name in imports(path):
            parts = set(name.split("."))
            assert not parts & {"meshing", "solid", "harmonic", "assembly"}, (path.name, name)


def test_a_file_is_one_thing():
    files = PACKAGE.rglob("*.py")
    assert [str(p) for p in files if len(p.read_text().splitlines()) > LONGEST] == []


def test_modules_are_imported_at_the_top_or_by_a_statement():
    files = PACKAGE.rglob("*.py")
    assert [str(p) for p in files if "__import__(" in p.read_text()] == []


#: rooms that are imported at every start, and import each of their models when it is built
DOORS = {"ladder"}


def unexplained(path):
    """Imports inside functions without a comment on their line or above their run: of the command
    line all, elsewhere those of this package.
    """
    lines = [line.strip() for line in path.read_text().splitlines()]
    functions = [n for n in ast.walk(tree_of(path)) if isinstance(n, ast.FunctionDef)]
    late = [
        node
        for function in functions
        for node in ast.walk(function)
        if isinstance(node, ast.Import | ast.ImportFrom)
    ]
    inside = {k for node in late for k in range(node.lineno, node.end_lineno + 1)}
    for node in late:
        above = node.lineno - 1
        while above in inside:
            above -= 1
        own = "solidgear" in ast.unparse(node) or room(path) == "cli"
        said = lines[above - 1].startswith("#") or "#" in lines[node.lineno - 1]
        if own and not said:
            yield ast.unparse(node)


@pytest.mark.parametrize("path", sorted(PACKAGE.rglob("*.py")), ids=lambda p: p.stem)
def test_an_import_inside_a_function_says_why(path):
    """An optional dependency, or start-up: whatever else a module needs stands at its top."""
    assert room(path) in DOORS or not list(unexplained(path))


def test_a_division_by_zero_in_our_own_code_is_an_error_and_in_others_is_theirs():
    # warnings go to the module whose line divides
    divide = "import numpy as np\ndef divide():\n    return np.zeros(2) / np.zeros(2)"
    ours, theirs = {"__name__": "solidgear.made_up"}, {"__name__": "made_up"}
    exec(divide, ours)
    exec(divide, theirs)
    with pytest.raises(RuntimeWarning, match="invalid value"):
        ours["divide"]()
    with pytest.warns(RuntimeWarning, match="invalid value"):
        theirs["divide"]()


@pytest.mark.long
def test_no_sentence_is_multiplied_by_a_truth_value_and_no_condition_holds_another():
    """What a reader would have to parse twice; names are starred in calls still."""
    forms = shapes(sources(PACKAGE))
    assert set(forms) <= {"starred name in a call"}
