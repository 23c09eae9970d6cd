"""The gallery, from the scripts in `examples/`: a picture that leads to each, what it says of itself,
its source, and a place for its output.

    python docs/tools/gallery_pictures.py EXAMPLE             # draws it
    python docs/tools/gallery.py
    python docs/tools/console.py --write docs/gallery.md      # runs them
"""

from __future__ import annotations

import ast
from pathlib import Path

DOCS = Path(__file__).parent.parent
EXAMPLES = DOCS.parent / "examples"
PAGE = DOCS / "gallery.md"
PICTURES = DOCS / "pictures" / "gallery"
#: of the table of pictures
COLUMNS = 3

#: from the first answer to whole trains; a new example is added where it belongs
ORDER = (
    "first_answer",
    "shaft_in_python",
    "shaft_to_report",
    "before_solving",
    "which_model",
    "how_sure",
    "attachments",
    "ovalising",
    "exact_beam",
    "many_bearings",
    "two_gears",
    "teeth_in_contact",
    "lumped_model",
    "way_back",
    "two_shafts",
    "geared_train",
)
HEAD = """# Gallery

Short scripts, each with what it prints: a picture opens its script. They are in `examples/` and run from the folder of the project; the tests run them too. This page is made from them by `docs/tools/gallery.py`.

Four notebooks in `examples/notebooks/` hold their outputs: `tutorial` (a shaft of one's own), `compare` (which model to trust, and why), `bearings_and_systems` (a hundred bearings, and two parts in one system), `tap_test` (from measured responses to a modulus; the data are synthetic). The tests run them without Jupyter.
"""


def examples() -> list[str]:
    """Names of all examples, those without a place of their own at the end."""
    there = {p.stem for p in EXAMPLES.glob("*.py")}
    return [n for n in ORDER if n in there] + sorted(there - set(ORDER))


def cards() -> str:
    """A table of pictures, each a link to its example."""
    cells = [
        f"[![{title(n)}](pictures/gallery/{n}.png)](#{n.replace('_', '-')})<br>{title(n)}"
        for n in examples()
    ]
    cells += [""] * (-len(cells) % COLUMNS)
    rows = [cells[k : k + COLUMNS] for k in range(0, len(cells), COLUMNS)]
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join([*lines[:1], "|" + " --- |" * COLUMNS, *lines[1:], ""])


def title(name: str) -> str:
    """Words of an example's name."""
    return name.replace("_", " ").capitalize()


def page() -> str:
    """The whole page, without outputs."""
    return "\n".join([HEAD, cards(), *map(section, examples())]).rstrip() + "\n"


def section(name: str) -> str:
    """An example on the page."""
    source = (EXAMPLES / f"{name}.py").read_text()
    head, _, rest = ast.get_docstring(ast.parse(source)).partition("\n")
    # the text above is the docstring; the code begins below it
    first = next(n for n in ast.parse(source).body if not isinstance(n, ast.Expr)).lineno
    return "\n".join(
        [
            f"## {title(name)}\n",
            f"{head.strip()}\n",
            f"{rest.strip()}\n",
            f"```{{literalinclude}} ../examples/{name}.py",
            f":language: python\n:lines: {first}-\n```\n",
            f"```console\n$ python examples/{name}.py\n```\n",
        ]
    )


def main() -> None:
    """Write the page, without outputs."""
    PAGE.write_text(page())


if __name__ == "__main__":
    main()
