"""One BLAS thread for the whole suite, as on the command line, before anything imports numpy; and
Ctrl-C is heard.
"""

import signal

import pytest

from solidgear.machine.threads import pin

pin()
# A shell starts what it runs in the background deaf to Ctrl-C; tests that interrupt themselves
# would wait for ever.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(items):
    """A test is `long` or `slow`: otherwise `-m long`, which CI runs, would run slow ones as well."""
    for item in items:
        if item.get_closest_marker("long") and item.get_closest_marker("slow"):
            raise pytest.UsageError(f"{item.nodeid} is marked long and slow; one of them is right")


@pytest.fixture(scope="session")
def made_up_charts():
    """Charts of the made-up run as its page draws them, once for all files of a process: three
    seconds, and many look at them.
    """
    from solidgear.report.html import drawn_charts
    from tests.made_up_run import fixture_results

    return drawn_charts(fixture_results(), None)


@pytest.fixture
def no_charts(monkeypatch):
    """Reports without their charts: drawing is what takes the time, and few tests look at them."""
    from solidgear.report import charts

    monkeypatch.setattr(charts, "CHARTS", dict.fromkeys(charts.CHARTS, lambda results: None))


@pytest.fixture
def run(monkeypatch, capsys, tmp_path):
    """The installed command's entry point, in an empty folder: exit code, standard output and error."""
    import sys

    from solidgear import cli

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
        return code, *capsys.readouterr()

    return call


@pytest.fixture
def two_meshes(monkeypatch):
    """A climb that ends with its second mesh, where a tolerance of 1e-8 is far away."""
    from solidgear.judge import refinement as loop

    monkeypatch.setattr(loop, "MOST_MESHES", 2)


@pytest.fixture
def builds_until(monkeypatch):
    """Lets a climb build so many meshes and refuses every further one for want of memory; gives the
    options that each was asked for with.
    """
    from solidgear.errors import SolidgearError
    from solidgear.judge import climb

    def limit(count: int) -> list[dict]:
        real, calls = climb.build, []

        def build(scene, model, **options):
            calls.append(options)
            if len(calls) > count:
                raise SolidgearError("12000 MB are needed, 3000 MB are free")
            return real(scene, model, **options)

        monkeypatch.setattr(climb, "build", build)
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
