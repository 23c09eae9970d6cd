"""The documentation says what the program does: commands, code, lists of what there is.

What a page shows was printed by the program.  Words must be the same; numbers may differ by 2 %,
far more than libraries and processors move them and less than a slip would; times and megabytes are
a machine's own.
"""

import doctest
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import solidgear as sg
from solidgear import app as cli
from validation.stability import page as stability

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
sys.path.insert(0, str(DOCS / "tools"))

import bearing_keys  # noqa: E402
import build  # noqa: E402
import console  # noqa: E402
import gallery  # noqa: E402
import pages  # noqa: E402
import prose  # noqa: E402

MADE = ("written",)
PAGES = sorted(
    p.relative_to(DOCS).as_posix()
    for p in DOCS.rglob("*.md")
    if not set(MADE) & set(p.relative_to(DOCS).parts)
)
#: pages whose commands take longer than a few seconds
LONG = {
    "tutorial.md",
    "gallery.md",
    "guide/verdict.md",
    "guide/tolerance.md",
    "guide/trains.md",
    "guide/real_parts.md",
    "guide/large.md",
    "guide/stiffness.md",
    "guide/sweeps.md",
    "guide/compare.md",
    "guide/nonlinear.md",
}


def kinds(page):
    return {block.kind for block in console.blocks((DOCS / page).read_text())}


SHOWING = [p for p in PAGES if "console" in kinds(p)]


@pytest.fixture
def here(monkeypatch, capfd, no_sudden_end):
    """Commands of pages in this process: starting one costs more than most of them take.

    That the program starts as one is the claim of `tests/test_cli.py`, and of the slow pages.
    """
    starts = console.run

    def run(command, folder):
        plain, tell, _ = command.partition(" ; echo exit code $?")
        words = shlex.split(plain)
        if words[0] != "solidgear" or set(plain) & set("|<>&;$"):
            return starts(command, folder)
        with pytest.MonkeyPatch.context() as patch:
            patch.chdir(folder)
            for name, value in {
                "COLUMNS": console.COLUMNS,
                "TERM": "dumb",
                "NO_COLOR": "1",
            }.items():
                patch.setenv(name, value)
            patch.setattr(sys, "argv", ["solidgear", "--quiet", *words[1:]])
            code = 0
            capfd.readouterr()
            try:
                cli.main()
            except SystemExit as end:
                code = end.code or 0
            printed = "".join(capfd.readouterr())
        lines = [line.rstrip() for line in printed.splitlines()]
        return "\n".join([*lines, f"exit code {code}"] if tell else lines)

    monkeypatch.setattr(console, "run", run)


#: some seconds each; shorter pages show what these do, commands beside what they print
SECONDS = {
    "guide/contact.md",
    "guide/frequencies.md",
    "guide/housings.md",
    "guide/planetary.md",
    "guide/points.md",
    "guide/uncertainty.md",
    "guide/stress.md",
}
#: code that takes a second and more
SLOW_CODE = {"guide/python.md", "guide/sweeps.md", "theory/stress.md", "guide/stiffness.md"}


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(p, marks=pytest.mark.long if p in SECONDS else ())
        for p in SHOWING
        if p not in LONG
    ],
)
def test_a_page_shows_what_the_program_prints(page, here):
    assert console.check(DOCS / page) == []


@pytest.mark.slow
@pytest.mark.parametrize("page", [p for p in SHOWING if p in LONG])
def test_a_long_page_shows_what_the_program_prints(page):
    assert console.check(DOCS / page) == []


@pytest.mark.long
def test_the_tutorial_runs_but_for_its_long_step(here):
    assert console.check(DOCS / "tutorial.md", without="compare") == []


def test_the_tutorial_has_eight_steps_each_with_something_to_do():
    steps = re.split(r"(?m)^## (?=\d)", (DOCS / "tutorial.md").read_text())[1:]
    assert [int(s.split(".")[0]) for s in steps] == list(range(1, 9))
    assert all("```" in s for s in steps)


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(p, marks=pytest.mark.long if p in SLOW_CODE else ())
        for p in PAGES
        if "pycon" in kinds(p)
    ],
)
def test_code_on_a_page_runs(page, tmp_path, monkeypatch):
    shutil.copytree(ROOT / "geometry", tmp_path / "geometry")
    monkeypatch.chdir(tmp_path)
    shown = [b for b in console.blocks((DOCS / page).read_text()) if b.kind == "pycon"]
    code = "\n".join(line for b in shown for line in [*b.lines, ""])
    case = doctest.DocTestParser().get_doctest(code, {}, page, page, 0)
    words = []
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    runner.run(case, out=words.append)
    assert runner.tries > 0
    assert runner.failures == 0, "".join(words)


SHOWN = """
 quantity         value   unit        bar   from
 C_zz        596.120e-12   m/N   +- 0.12 %   2 meshes

 tried      dofs   time, s
 harmonic   1.1k      0.30
Within 1.00 %: harmonic, 0.47 s for all meshes tried, pardiso.
"""


@pytest.mark.parametrize(
    "was, now",
    [("596.120e-12", "606.120e-12"), ("596.120e-12", "601.120e-12"), ("0.30\n", "0.97\n")]
    + [("0.47 s", "3.1 s"), ("pardiso", "superlu")],
)
def test_what_makes_no_difference(was, now):
    assert console.same(SHOWN, SHOWN.replace(was, now)) == ""


@pytest.mark.parametrize(
    "was, now",
    [("596.120e-12", "616.120e-12"), ("0.12 %", "0.13 %"), ("2 meshes", "3 meshes")]
    + [("m/N", "N/m"), ("Within", "Not within"), ("1.1k      0.30", "1.2k      0.30")]
    + [("596.120e-12", "-596.120e-12"), ("596.120e-12", "596.120e-9")],
)
def test_what_makes_one(was, now):
    assert console.same(SHOWN, SHOWN.replace(was, now))


def test_rounding_in_a_row_is_no_difference_and_a_coupling_is():
    row = " x  463.04e6   0  20.591e-9   0  -24.771e6"
    assert console.same(row, row.replace("20.591e-9", "-3.1e-9")) == ""
    assert console.same(row, row.replace("20.591e-9", "0")) == ""
    assert console.same(row, row.replace("20.591e-9", "20.591e3"))


def test_lines_left_out_are_found_wherever_they_are():
    step = console.Step("x", ["...", "Trust: harmonic solid", "..."])
    assert console.differs(step, "a table\nTrust: harmonic solid\nmore") == ""
    assert "not printed" in console.differs(step, "a table\nTrust: 3D solid\nmore")


def test_the_gallery_shows_every_example():
    page = (DOCS / "gallery.md").read_text()
    for name in gallery.examples():
        assert f"$ python examples/{name}.py" in page
        assert (gallery.PICTURES / f"{name}.png").is_file()
    # but for what scripts print, the page is what it is made from
    bare = re.sub(r"(?m)^(\$ python \S+\n)(?:(?!```).*\n)*", r"\1", page)
    assert bare.rstrip() == gallery.page().rstrip()


def test_the_reference_holds_all_that_is_exported():
    page = (DOCS / "api.md").read_text()
    for name in set(sg.__all__) - {"__version__"}:
        assert re.search(rf"(?:   ~solidgear\.|py:data:: ){name}$", page, re.M), name


def test_every_mark_and_column_of_the_final_table_is_explained():
    from solidgear.comparison.page import sheet
    from solidgear.comparison.page.tables import NOT_RESOLVED
    from solidgear.core.judge.record import Record

    page = (DOCS / "guide" / "verdict.md").read_text()
    # what the program prints explains nothing
    page = re.sub(r"(?ms)^```.*?^```", "", page)
    words = [*sheet.VALID.values(), NOT_RESOLVED, "ref.", "INCOMPLETE", "caution:"]
    table = sheet.final_table(Record()).renderables[0]
    words += [head.replace("bar\n", "bar ").split("\n")[0] for head in table.heads]
    assert [w for w in words if w not in page] == []


def test_every_command_and_exit_code_is_listed():
    import typer.main

    from solidgear.app import app

    page = (DOCS / "guide" / "commands.md").read_text()
    for name in typer.main.get_command(app).commands:
        assert f"`solidgear {name}" in page, name
    for code in (0, 1, 2, 3, 130):
        assert f"| {code} |" in page


def test_the_page_of_bearing_keys_is_that_of_the_models():
    assert bearing_keys.PAGE.read_text() == bearing_keys.page()


def test_every_finding_of_the_stability_scripts_has_a_place():
    page = (DOCS / "validation" / "stability.md").read_text()
    for name in (n for names in stability.CHAPTERS.values() for n in names):
        assert f"pictures/stability/{name}.png" in page
        assert (stability.PICTURES / f"{name}.png").exists()


def test_tests_named_as_guards_are_there():
    page = (DOCS / "validation" / "stability.md").read_text()
    guards = re.findall(r"Held by the test `(tests/\w+\.py)::(\w+)", page)
    assert len(guards) > 20
    for path, name in guards:
        assert f"def {name}(" in (ROOT / path).read_text(), name


def tracked():
    """Files as a clone has them; of a source distribution those that are there."""
    if (ROOT / ".git").exists() and shutil.which("git"):
        asked = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(asked, cwd=ROOT, capture_output=True, text=True, check=True)
        return {path for path in map(ROOT.joinpath, listed.stdout.splitlines()) if path.exists()}
    return {path for path in ROOT.rglob("*") if path.is_file() and path.parent != pages.COPIES}


def astray(files):
    """Links, pictures and includes of Markdown files that lead to none of these files."""
    folders = {folder for path in files for folder in path.parents}
    for path in sorted(path for path in files if path.suffix == ".md"):
        text = re.sub(
            r"(?ms)^(`{3,})(?!\{).*?^\1\s*$|`[^`\n]*`", "", path.read_text(encoding="utf-8")
        )
        for link in pages.LINK.finditer(text):
            target = link[2].partition("#")[0]
            place = Path(os.path.normpath(path.parent / target))
            if target and not re.match(r"\w+:", target) and not {place} & (files | folders):
                yield f"{path.relative_to(ROOT)}: {link[2]}"


def test_links_pictures_and_includes_of_a_clone_lead_to_files_that_it_has():
    files = tracked()
    assert list(astray(files)) == []
    assert len(list(astray(files - {DOCS / "guide" / "stress.md"}))) > 3


def test_a_build_links_to_copies_of_what_lies_outside_of_it():
    text = "[case](../../validation/manual/roller_row.md#top), ![x](../../validation/figures/backlash.png)"
    assert pages.to_copies(text, DOCS / "guide") == (
        "[case](../validation/written/roller_row.md#top), ![x](../validation/written/backlash.png)"
    )
    assert "written/cases.md" in pages.to_copies(
        (DOCS / "validation" / "index.md").read_text(), DOCS / "validation"
    )


def test_tables_in_pages_are_those_of_the_program():
    names = []
    for page in PAGES:
        text = (DOCS / page).read_text(encoding="utf-8")
        names += [mark[2] for mark in pages.TABLE.finditer(text)]
        assert pages.with_tables(text) == text, f"{page}: run docs/tools/pages.py"
    assert sorted(names) == sorted(pages.TABLES)


def test_a_broken_link_and_a_file_from_a_network_are_seen(tmp_path):
    (tmp_path / "a.html").write_text('<p id="here"><a href="b.html#there">x</a></p>')
    (tmp_path / "b.html").write_text('<p id="there"><a href="a.html#here">y</a></p>')
    assert build.broken(tmp_path) == []
    (tmp_path / "b.html").write_text('<a href="c.html">y</a><script src="https://x.org/y.js">')
    told = build.broken(tmp_path)
    assert len(told) == 3 and all(any(w in t for t in told) for w in ("#there", "c.html", "x.org"))


@pytest.mark.slow
def test_the_site_builds_without_a_warning_and_without_a_broken_link(tmp_path):
    pytest.importorskip("sphinx")
    assert build.build(tmp_path / "site") == 0
    assert build.broken(tmp_path / "site") == []


def test_pages_and_pictures_stay_small():
    written = DOCS / "validation" / "written"  # by other tests and by whoever runs a validation
    files = [p for p in DOCS.rglob("*") if p.is_file() and written not in p.parents]
    assert sum(p.stat().st_size for p in files) < 3e6


def test_pages_are_within_their_limits():
    assert prose.faults(prose.hand_written()) == []


LONG_SENTENCE = "A shaft " + "is long and " * 12 + "ends."


@pytest.mark.parametrize(
    "text, rule",
    [
        ("It is short. " * 41, "paragraph"),
        (LONG_SENTENCE, "more than 35"),
        (f"| a | {LONG_SENTENCE} |", "more than 35"),
        (f"$$x = 1,$$\n{LONG_SENTENCE}", "more than 35"),
        ("Its eigenfrequency is high.", "natural frequency"),
        ("The mode is told.", "shown"),
        ("A row tells its bound.", "shows"),
        ("Stiffness is a matter of load.", "depends on"),
        ("Peaks hang on losses.", "depends on"),
        ("It is short. Of an idler the flank may be left out.", "begins with its subject"),
        ("With teeth, of a bevel gear, it is the mean.", "begins with its subject"),
        ("The bar is wide.", "error bar"),
        ("\n\n".join(f"It is that of part {k}." for k in range(16)), "in 16 places"),
        ("\n\n".join(["No run of twelve words may stand on any page more than once."] * 2), "too"),
        ("\n\n".join(f"Word {k} of many." for k in range(prose.PAGE // 4 + 1)), "page"),
        ("\n\n".join(f"Word {k} of many." for k in range(prose.TOTAL // 4 + 1)), "all pages"),
    ],
    ids=[
        "paragraph",
        "sentence",
        "cell",
        "formula",
        "glossary",
        "told",
        "tells",
        "matter",
        "hang",
        "of",
        "of it",
        "bar",
        "that of",
        "twice",
        "page",
        "total",
    ],
)
def test_prose_beyond_a_limit_is_reported_with_its_place(text, rule):
    faults = prose.faults({"page.md": f"# Page\n\n{text}\n"})
    assert [f for f in faults if rule in f or (rule == "page" and f.startswith("page.md:1:"))]


def test_an_error_bar_and_a_flat_bar_are_heard_as_such():
    assert (
        prose.faults({"page.md": "# Page\n\nError bars hold. Flat and flat bars differ.\n"}) == []
    )


def test_code_is_no_prose():
    page = f"```sh\n{LONG_SENTENCE}\n```\n\n`{LONG_SENTENCE}` runs.\n"
    assert prose.faults({"page.md": page}) == [] and prose.size("page.md", page) == 2
