"""One BLAS thread for the whole suite, as on the command line, before anything imports numpy, and one
that factors: processes of tests are as many as cores. Ctrl-C is heard.
"""

import ctypes
import functools
import gc
import hashlib
import os
import pickle
import signal
import sys
from pathlib import Path

import pytest

from solidgear.core.machine.processes import resident_mb
from solidgear.core.machine.threads import pin
from tests.by_room import belongs, is_room

pin()
os.environ.setdefault("MKL_NUM_THREADS", "1")
# Compiled modules are kept, whatever a shell exports: every process that tests start would compile
# them anew, a second each, and every worker the tests.
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
# A shell starts what it runs in the background deaf to Ctrl-C; tests that interrupt themselves
# would wait for ever.
signal.signal(signal.SIGINT, signal.default_int_handler)


# Five thousand tests are half a million objects that stay: what looks for garbage passes them over.
gc.disable()


def pytest_collection_finish():
    gc.collect()
    gc.freeze()
    gc.enable()


def pytest_addoption(parser):
    text = "only test files that import solidgear.NAME, and the house; such as measured, core.judge"
    parser.addoption("--room", metavar="NAME", help=text)


def pytest_configure(config):
    room = config.getoption("--room")
    if room and not is_room(room):
        raise pytest.UsageError(f"--room {room}: solidgear has no such room")


def pytest_ignore_collect(collection_path, config):
    """Files of other rooms are not even read."""
    room = config.getoption("--room")
    if room and collection_path.name.startswith("test_") and not belongs(collection_path, room):
        return True
    return None


#: cases of wide grids, each of a test that has others in the default run
LONG_CASES = Path(__file__).with_name("long_cases.txt")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """A test is `long` or `slow`: otherwise `-m long`, which CI runs, would run slow ones as well.
    Of a test with long cases one is in the default run.
    """
    long = set(LONG_CASES.read_text(encoding="utf-8").splitlines()[1:])
    left, marked = set(), set()
    for item in items:
        test = item.nodeid.partition("[")[0]
        if item.nodeid in long:
            item.add_marker(pytest.mark.long)
            marked.add(test)
        elif not any(map(item.get_closest_marker, ("long", "slow"))):
            left.add(test)
    if marked - left and not any("::" in argument for argument in config.args):
        raise pytest.UsageError(f"{sorted(marked - left)}: no case is left for the default run")
    for item in items:
        if item.get_closest_marker("long") and item.get_closest_marker("slow"):
            raise pytest.UsageError(f"{item.nodeid} is marked long and slow; one of them is right")


GEOMETRY = Path(__file__).parent.parent / "geometry"
#: MB from which on a process gives back what its files have used
HELD = 600.0


@pytest.fixture(scope="module", autouse=True)
def given_back():
    """Memory that a file has used goes back to the system, which the allocator would keep: a process
    that runs a hundred files would hold the largest of each.  It costs a tenth of a second and
    what comes back costs again, so that it is done where much is held.
    """
    yield
    if (resident_mb() or HELD) < HELD:
        return
    gc.collect()
    gc.freeze()  # what is left stays: it is looked through once and not after every file
    if sys.platform == "linux" and hasattr(libc := ctypes.CDLL(None), "malloc_trim"):
        libc.malloc_trim(0)


@pytest.fixture(scope="session")
def overhung():
    """The overhung pinion, which most files of tests look at."""
    import solidgear as sg

    return sg.load(GEOMETRY / "pinion_overhung.toml")


@pytest.fixture(scope="session")
def drawable(overhung):
    """Body and modes of the overhung pinion by a model, each built once for files that draw them."""
    import solidgear as sg

    options = {"timoshenko": {}, "harmonic": {"order": 4}, "solid": {"refinement": 0.5}}
    made = {}

    def get(model):
        if model not in made:
            body = sg.build(overhung, model, **options[model])
            made[model] = body, sg.modes(body, overhung, n=5)
        return made[model]

    return get


@pytest.fixture(scope="session")
def made_up_charts():
    """Charts of the made-up run as its page draws them, once for all files of a process: three
    seconds, and many look at them.
    """
    from tests.made_up_run import fixture_results
    from tests.plain import drawn_charts

    return drawn_charts(fixture_results())


#: light solids that are kept
KEPT = 24


@pytest.fixture(scope="session", autouse=True)
def solved_once():
    """Light solids by which guards judge a scene, which every command on a beam asks for: the last
    scenes of a process once.
    """
    from solidgear.core.judge import refinement as loop
    from solidgear.guards import probe

    solve, known = probe.study, {}

    def once(*asked, **more):
        how = [loop.MOST_MESHES, *(v for k, v in os.environ.items() if "SOLIDGEAR" in k)]
        key = pickle.dumps((asked, more, how))
        known[key] = known.pop(key, None) or solve(*asked, **more)
        if len(known) > KEPT:
            del known[next(iter(known))]
        return known[key]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(probe, "study", once)
        yield


@pytest.fixture(scope="session", autouse=True)
def read_once():
    """What a process of its own has made of a file, for the next test that has the same file.

    Each start costs more than the reading.  Mesh files are read in this process; parts, whose reader
    may end it, and files that are broken at random have their own.
    """
    from solidgear.parts import part_file
    from solidgear.parts.mesh_file import mesh_from

    known, starts = {}, part_file.isolated

    def once(function, path, *arguments, **limits):
        content = hashlib.sha256(Path(path).read_bytes()).digest()
        key = (function.__qualname__, Path(path).suffix, content, pickle.dumps(arguments))
        if key not in known:
            here = function is mesh_from
            made = (
                function(path, *arguments) if here else starts(function, path, *arguments, **limits)
            )
            known[key] = pickle.dumps(made)
        return pickle.loads(known[key])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(part_file, "isolated", once)
        patch.setattr("solidgear.parts.part_body.isolated", once)
        yield


@pytest.fixture(scope="session", autouse=True)
def pixels_once():
    """Of charts in pixels, which no test looks into, the first stands for all: a fifth of a second
    each.
    """
    from solidgear.show import plot

    first = functools.cache(lambda: make('<svg xmlns="http://www.w3.org/2000/svg"/>'))
    make = plot.pixels
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(plot, "pixels", lambda svg: first())
        yield


@pytest.fixture
def no_charts(monkeypatch):
    """Reports without their charts: drawing is what takes the time, and few tests look at them."""
    from solidgear.comparison.page import charts

    monkeypatch.setattr(charts, "CHARTS", dict.fromkeys(charts.CHARTS, lambda results: None))


@pytest.fixture
def no_sudden_end(monkeypatch):
    """Where the program ends at once, as of an output that cannot be written, a test ends and not
    the process of all tests, without a word.
    """

    def end(code):
        pytest.fail(f"the program would have ended at once with code {code}")

    monkeypatch.setattr(os, "_exit", end)


@pytest.fixture
def run(monkeypatch, capsys, tmp_path, no_sudden_end):
    """The installed command's entry point, in an empty folder: exit code, standard output and error."""
    from command import hold_to_schema

    from solidgear import app as cli

    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("SOLIDGEAR_BACKEND", raising=False)
    monkeypatch.setenv("COLUMNS", "100")

    def call(*arguments) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["solidgear", *map(str, arguments)])
        capsys.readouterr()
        code = 0
        try:
            cli.main()
        except SystemExit as end:
            code = end.code or 0
        out, err = capsys.readouterr()
        hold_to_schema([*map(str, arguments)], out)
        return code, out, err

    return call


@pytest.fixture(scope="session")
def raced():
    """A small race on a light reference."""
    import solidgear as sg
    from solidgear.comparison.race.timing import race
    from tests.charted import SETUP, few

    scene = sg.load(Path(__file__).parent.parent / "geometry" / "shaft_stepped.toml")
    return race(scene, few(), runs=2, sure=1e-2, setup=SETUP)


@pytest.fixture(scope="module")
def coarse_teeth():
    """Contacts that name no model of their teeth have half the slices and places."""
    from solidgear.teeth.train_teeth import TeethModel

    usual = TeethModel.__init__.__defaults__
    quick = (usual[0], TeethModel.slices // 2, TeethModel.positions // 2, *usual[3:])
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(TeethModel.__init__, "__defaults__", quick)
        yield


@pytest.fixture
def two_meshes(monkeypatch):
    """A climb that ends with its second mesh, where a tolerance of 1e-8 is far away."""
    from solidgear.core.judge import refinement as loop

    monkeypatch.setattr(loop, "MOST_MESHES", 2)


@pytest.fixture
def builds_until(monkeypatch):
    """Lets a climb build so many meshes and refuses every further one for want of memory; gives the
    options that each was asked for with.
    """
    from solidgear.core.errors import SolidgearError
    from solidgear.core.judge import question

    def limit(count: int) -> list[dict]:
        real, calls = question.build, []

        def build(scene, model, **options):
            calls.append(options)
            if len(calls) > count:
                raise SolidgearError("12000 MB are needed, 3000 MB are free")
            return real(scene, model, **options)

        monkeypatch.setattr(question, "build", build)
        return calls

    return limit


@pytest.fixture
def refused(tmp_path):
    """Asks for one sentence from a scene in which one text stands for another."""
    import solidgear as sg

    def ask(text: str, old: str, new: str, says: str) -> None:
        assert old in text
        file = tmp_path / "bad.toml"
        file.write_text(text.replace(old, new))
        with pytest.raises(sg.SceneError) as caught:
            sg.load(file)
        assert says in str(caught.value) and len(str(caught.value).splitlines()) == 1

    return ask
