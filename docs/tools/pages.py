"""Pages that other parts of the project write, and tables of what the program knows, brought under
`docs/` when it is built.

The validation manual and the claims are written by `python -m validation.manual` and
`python -m validation.thesis.claims`; what is shown here is a copy of those files, made at every build.
"""

import re
import shutil
from pathlib import Path

from validation.common import read_result
from validation.race.real_costs import markdown, rows_of
from validation.race.real_lines import PARTS

DOCS = Path(__file__).parent.parent
#: tables of what the program knows, not under version control
TABLES = DOCS / "written"
ROOT = DOCS.parent
#: where copies go, not under version control
COPIES = DOCS / "validation" / "written"

#: file of the project -> name of its copy
WRITTEN = {
    **{p: p.name for p in sorted((ROOT / "validation" / "manual").glob("*.md"))},
    ROOT / "validation" / "thesis" / "claims.md": "thesis_claims.md",
    ROOT / "validation" / "thesis" / "bearings.md": "thesis_bearings.md",
}
PICTURES = (
    "speed_accuracy.png",
    "real_keyed.png",
    "real_toothed.png",
    "real_step.png",
    "pinion_bending_1.png",
    "reducer.png",
    "reducer_spectra.png",
    "backlash.png",
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
    thesis = (ROOT / "validation" / "thesis").glob("claim_*.png")
    for picture in [*(ROOT / "validation" / "figures" / name for name in PICTURES), *thesis]:
        shutil.copy(picture, COPIES)


def fenced(text: str) -> str:
    """Sketches drawn with characters, in a fence of their own: their lines begin with blanks, and
    those that begin with fewer than four would be taken for text.
    """
    sketch = re.compile(r"(?m)(?<=\n\n)((?: +\S.*\n)+)(?=\n|\Z)")
    return sketch.sub(lambda found: f"```text\n{found[1]}```\n", text)


def with_contents(text: str) -> str:
    """The list of cases, its links also in the side bar."""
    cases = [link.removesuffix(".md") for link in re.findall(r"\]\((\w+\.md)\)", text)]
    contents = "\n".join(["```{toctree}", ":hidden:", "", *cases, "```"])
    return text.replace("# Validation manual", "# Cases with a known answer", 1) + f"\n{contents}\n"


def write_tables(app=None):
    """Materials and builder options, as the program has them, and tables of measured costs."""
    TABLES.mkdir(exist_ok=True)
    (TABLES / "materials.md").write_text(materials())
    (TABLES / "options.md").write_text(options())
    rows = rows_of(read_result("real_parts"))
    for part in PARTS:
        (TABLES / f"real_{part}.md").write_text("\n".join(markdown(rows, part)) + "\n")


def materials() -> str:
    """The table of materials by name, those with the same constants in one row."""
    from solidgear.scene.materials import MATERIALS

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
    from solidgear.cli.files import _default, _may_be
    from solidgear.ladder.registry import LADDER

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


def setup(app):
    """Write all of it before sources are read."""
    app.connect("builder-inited", copy_pages)
    app.connect("builder-inited", write_tables)
