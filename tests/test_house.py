"""The house: which room may import which, no circle, and no file that has become two things."""

import ast
import functools
import gc
import graphlib
import subprocess
import sys
from pathlib import Path

import pytest

from solidgear import core
from solidgear.core.registry import addition, register
from solidgear.rooms import ADDITIONS
from validation.house import structure
from validation.house.floors import BASE, MAY_IMPORT, ROOMS, room_of
from validation.house.source import sources, statements
from validation.house.words import shapes

PACKAGE = Path(__file__).parent.parent / "solidgear"
#: lines of a file
LONGEST = 700


@functools.cache
def files():
    """All files of the package, each parsed once for all that look at it."""
    parsed = sources(PACKAGE)
    # what looks for garbage would go through half a million nodes that stay, again and again
    gc.disable()
    for source in parsed:
        source.tree  # noqa: B018
    gc.freeze()
    gc.enable()
    return parsed


@functools.cache
def read_graph():
    """Imports of every file as they are read: those for types alone and those in functions too."""
    return structure.graph(files())


@pytest.mark.long
def test_a_room_imports_only_what_lies_below():
    """Read as it stands, `TYPE_CHECKING` too: a reader follows these arrows, whatever runs."""
    assert structure.arrows_up(read_graph(), MAY_IMPORT) == []


def test_modules_import_each_other_in_no_circle():
    """Read with `TYPE_CHECKING` and imports inside functions: whoever reads a module reads on below."""
    assert structure.circles(read_graph()) == []


def test_every_room_is_on_a_floor():
    rooms = {room_of(module) for module in read_graph()} - {"", "core", "rooms", "__main__"}
    assert rooms == set(MAY_IMPORT)
    graphlib.TopologicalSorter(MAY_IMPORT).prepare()  # raises CycleError


def test_beams_share_no_code_with_solids():
    beams = {m: to for m, to in read_graph().items() if m.startswith("solidgear.core.models.beam")}
    assert beams
    for module, targets in beams.items():
        for name in targets:
            parts = set(name.split("."))
            assert not parts & {"meshing", "solid", "harmonic", "assembly"}, (module, name)


def test_a_file_is_one_thing():
    assert [s.place for s in files() if len(s.text.splitlines()) > LONGEST] == []


def test_modules_are_imported_at_the_top_or_by_a_statement():
    assert [s.place for s in files() if "__import__(" in s.text] == []


#: files that are imported at every start, and import each of their models when it is built
DOORS = {
    *(PACKAGE / "core" / "ladder").glob("*.py"),
    PACKAGE / "cuts" / "corrected" / "model.py",
    PACKAGE / "cuts" / "sector" / "model.py",
}


def unexplained(source):
    """Imports inside functions without a comment on their line or above their run: of the command
    line all, elsewhere those of this package.
    """
    lines = [line.strip() for line in source.text.splitlines()]
    late = [
        node
        for function in source.functions
        for node in statements(function)
        if isinstance(node, ast.Import | ast.ImportFrom)
    ]
    inside = {k for node in late for k in range(node.lineno, node.end_lineno + 1)}
    for node in late:
        above = node.lineno - 1
        while above in inside:
            above -= 1
        own = (
            "solidgear" in ast.unparse(node)
            or source.path.stem.endswith("command")
            or source.room == "app"
        )
        said = lines[above - 1].startswith("#") or "#" in lines[node.lineno - 1]
        if own and not said:
            yield ast.unparse(node)


def test_an_import_inside_a_function_says_why():
    """An optional dependency, or start-up: whatever else a module needs stands at its top."""
    silent = {s.place: list(unexplained(s)) for s in files() if s.path not in DOORS}
    assert {place: lines for place, lines in silent.items() if lines} == {}


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
    forms = shapes(files())
    assert set(forms) <= {"starred name in a call"}


WITHOUT = """
import sys
from importlib.abc import MetaPathFinder

class Missing(MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] == "solidgear" and name.split(".")[1:2] and name.split(".")[1] in ROOMS:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Missing())
from solidgear.app import main
main()
"""


@pytest.mark.parametrize(
    "words",
    [
        ("modes", "-f", "timoshenko"),
        pytest.param(("modes", "-f", "harmonic"), marks=pytest.mark.slow),
        ("stiffness", "-f", "timoshenko"),
        ("answer",),
    ],
    ids=" ".join,
)
def test_the_core_answers_without_any_room_of_features(words):
    command, *options = words
    shaft = PACKAGE.parent / "geometry" / "shaft_stepped.toml"
    code = WITHOUT.replace("ROOMS", repr(ROOMS))
    line = [sys.executable, "-c", code, command, str(shaft), *options]
    run = subprocess.run(line, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr
    # an answer has no title
    said = "Within the 5 % asked." if command == "answer" else "shaft_stepped"
    assert said in run.stdout


def test_every_addition_stands_where_the_table_of_rooms_says():
    """A wrong place would be an error; one that is not there must not pass for a missing room."""
    places = [(kind, name) for kind, names in ADDITIONS.items() for name in names]
    assert [place for place in places if addition(*place) is None] == []
    register("made-up", "moved", "solidgear.cuts.nowhere:Cut")
    with pytest.raises(ModuleNotFoundError, match="nowhere"):
        addition("made-up", "moved")


def test_names_that_features_share_come_through_the_door_of_the_core():
    users = {}
    for source in files():
        if source.room in ("core", "__init__", "rooms", "__main__"):
            continue
        for node in statements(source.tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(
                "solidgear.core"
            ):
                for name in (alias.name for alias in node.names):
                    # the base is one, and knows the core
                    room = "base" if source.room in BASE else source.room
                    users.setdefault((node.module, name), set()).add(room)
    door = {name for module, name in users if module == "solidgear.core"}
    assert door <= set(core.__all__)
    beside_it = {
        (module, name)
        for (module, name), rooms in users.items()
        if len(rooms) > 2 and module != "solidgear.core" and not _hidden_by_a_module(name)
    }
    assert beside_it == set()
    assert len(core.__all__) <= 71 and all(hasattr(core, name) for name in core.__all__)


def _hidden_by_a_module(name):
    """A module of the core has this name: the package hands that out."""
    return (PACKAGE / "core" / f"{name}.py").exists() or (PACKAGE / "core" / name).is_dir()
