"""Pages and pictures that other parts of the project write, brought under `docs/` when it is built.

The validation manual and the claims are written by `python -m validation.manual` and
`python -m validation.thesis.claims`; what is shown here is a copy of those files, made at every build.
"""

import re
import shutil
from pathlib import Path

DOCS = Path(__file__).parent.parent
ROOT = DOCS.parent
#: where copies go, not under version control
COPIES = DOCS / "validation" / "written"

#: file of the project -> name of its copy
WRITTEN = {
    **{p: p.name for p in sorted((ROOT / "validation" / "manual").glob("*.md"))},
    ROOT / "validation" / "thesis" / "claims.md": "thesis_claims.md",
    ROOT / "validation" / "thesis" / "bearings.md": "thesis_bearings.md",
}
PICTURES = ("speed_accuracy.png", "keyed_speed_accuracy.png", "pinion_bending_1.png")


def copy_pages(app=None):
    """Copies of all written pages; the list of cases becomes a chapter with a table of contents."""
    shutil.rmtree(COPIES, ignore_errors=True)
    COPIES.mkdir(parents=True)
    for source, name in WRITTEN.items():
        text = source.read_text()
        if name == "README.md":
            name, text = "cases.md", with_contents(text)
        (COPIES / name).write_text(text)
    for name in PICTURES:
        shutil.copy(ROOT / "validation" / "figures" / name, COPIES / name)


def with_contents(text: str) -> str:
    """The list of cases, its links also in the side bar."""
    cases = [link.removesuffix(".md") for link in re.findall(r"\]\((\w+\.md)\)", text)]
    contents = "\n".join(["```{toctree}", ":hidden:", "", *cases, "```"])
    return text.replace("# Validation manual", "# Cases with a known answer", 1) + f"\n{contents}\n"


def setup(app):
    """Copy before sources are read."""
    app.connect("builder-inited", copy_pages)
