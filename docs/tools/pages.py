"""Pages that other parts of the project write, brought under `docs/` when it is built, and tables of
what the program knows, between marks of the pages that hold them.

    python docs/tools/pages.py          # write those tables anew

The validation manual and the claims are written by `python -m validation.manual` and
`python -m validation.thesis.claims`. Pages link to those files, so that links lead somewhere in a clone;
a build links to copies instead, which it makes.
"""

import os
import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))

from validation.common import read_result  # noqa: E402
from validation.race import page as races  # noqa: E402
from validation.race.real_costs import markdown, rows_of  # noqa: E402

DOCS = ROOT / "docs"
#: where copies go, not under version control
COPIES = DOCS / "validation" / "written"

#: notebooks with what they show, and where their copies go
NOTEBOOKS = ROOT / "examples" / "notebooks"
NOTEBOOK_COPIES = DOCS / "notebooks"

#: file of the project -> name of its copy
WRITTEN = {
    **{p: p.name for p in sorted((ROOT / "validation" / "manual").glob("*.md"))},
    ROOT / "validation" / "thesis" / "claims.md": "thesis_claims.md",
    ROOT / "validation" / "thesis" / "bearings.md": "thesis_bearings.md",
}
PICTURES = tuple(
    ROOT / "validation" / "figures" / f"{name}.png"
    for name in (
        "speed_accuracy",
        "real_keyed",
        "real_toothed",
        "real_step",
        "pinion_bending_1",
        "reducer",
        "reducer_spectra",
        "backlash",
    )
)
#: what leads from a page to another file: a link, a picture, a directive
LINK = re.compile(
    r"(\]\(|^\[[^\]]+\]: *|^(?:```|:::)\{(?:image|figure|include|literalinclude)\} )([^)\s]+)", re.M
)
#: a table that is made, between its marks
TABLE = re.compile(
    r"(<!-- made by docs/tools/pages.py: (\w+) -->\n\n)(.*?)(\n<!-- made until here -->)", re.S
)


def copy_pages(app=None):
    """Copies of all written pages; the list of cases becomes a chapter with a table of contents."""
    shutil.rmtree(COPIES, ignore_errors=True)
    COPIES.mkdir(parents=True)
    for source, name in WRITTEN.items():
        text = source.read_text()
        if name == "README.md":
            name, text = "cases.md", with_contents(text)
        (COPIES / name).write_text(fenced(text))
    for picture in [*PICTURES, *(ROOT / "validation" / "thesis").glob("claim_*.png")]:
        shutil.copy(picture, COPIES)
    shutil.copytree(NOTEBOOKS, NOTEBOOK_COPIES, dirs_exist_ok=True)


def to_copies(text: str, folder: Path) -> str:
    """The text of a page in a folder with links to the copies of what they lead to."""
    copies = {source: COPIES / name for source, name in WRITTEN.items()}
    copies[ROOT / "validation" / "manual" / "README.md"] = COPIES / "cases.md"
    copies |= {picture: COPIES / picture.name for picture in PICTURES}

    def turned(link: re.Match) -> str:
        path, anchor, place = link[2].partition("#")
        copy = copies.get(Path(os.path.normpath(folder / path)))
        return link[1] + (
            link[2] if copy is None else os.path.relpath(copy, folder) + anchor + place
        )

    return LINK.sub(turned, text)


def fenced(text: str) -> str:
    """Sketches drawn with characters, in a fence of their own: their lines begin with blanks, and
    those that begin with fewer than four would be taken for text.
    """
    sketch = re.compile(r"(?m)(?<=\n\n)((?: +\S.*\n)+)(?=\n|\Z)")
    return sketch.sub(lambda found: f"```text\n{found[1]}```\n", text)


def with_contents(text: str) -> str:
    """The list of cases, its links also in the side bar."""
    cases = [link.removesuffix(".md") for link in re.findall(r"\]\((\w+\.md)\)", text)]
    contents = "\n".join(["```{toctree}", ":hidden:", "", *dict.fromkeys(cases), "```"])
    return text.replace("# Validation manual", "# Cases with a known answer", 1) + f"\n{contents}\n"


def with_tables(text: str) -> str:
    """A page whose tables are those of the program as it is."""
    return TABLE.sub(lambda mark: mark[1] + TABLES[mark[2]]() + mark[4], text)


def real(part: str) -> str:
    """The table of measured costs of a real part."""
    return "\n".join(markdown(rows_of(read_result("real_parts")), part)) + "\n"


def materials() -> str:
    """The table of materials by name, those with the same constants in one row."""
    from solidgear.core.scene.materials import MATERIALS

    rows: dict[object, list[str]] = {}
    for name, known in MATERIALS.items():
        rows.setdefault(known, []).append(f"`{name}`")
    lines = ["| names | E, GPa | nu | density, kg/m³ | source |", "| --- | --- | --- | --- | --- |"]
    lines += [
        f"| {', '.join(names)} | {k.E / 1e9:g} | {k.nu:g} | {k.density:g} | {k.source} |"
        for k, names in rows.items()
    ]
    return "\n".join(lines) + "\n"


def options() -> str:
    """One table a model, the words of `solidgear options`."""
    # the words of the command itself, which has no other place for them
    from solidgear.app.files import _default, _may_be
    from solidgear.core.ladder.registry import LADDER

    lines = []
    for name in LADDER.bodies:
        model = LADDER[name]
        defaults = model.defaults()
        lines += [f"## {name}: {model.title}", "", "| option | default | may be | what it is |"]
        lines.append("| --- | --- | --- | --- |")
        for key, option in model.options.items():
            default = _default(defaults.get(key))
            lines.append(f"| `{key}` | {default} | {_may_be(option)} | {option.meaning} |")
        lines.append("")
    return "\n".join(lines)


#: name of a table in its marks -> what makes it
TABLES: dict[str, Callable[[], str]] = {
    "materials": materials,
    "options": options,
    "real_keyed": lambda: real("keyed"),
    "real_toothed": lambda: real("toothed"),
    "real_step": lambda: real("step"),
    "race_error": lambda: races.lanes("peers", "error"),
    "race_ratios": races.ratios,
    "race_sizes": races.sizes,
    "race_checkouts": races.checkouts,
}


def setup(app):
    """Copy before sources are read, and link to the copies."""
    app.connect("builder-inited", copy_pages)
    app.connect("source-read", read)


def read(app, name, source):
    """Text of a page as it is built."""
    source[0] = to_copies(source[0], (DOCS / name).parent)


if __name__ == "__main__":
    for page in DOCS.rglob("*.md"):
        text = page.read_text(encoding="utf-8")
        if TABLE.search(text):
            page.write_text(with_tables(text), encoding="utf-8")
