"""The page of measured edges, from what `python -m validation.stability` has left in its results.

    python -m validation.stability          # or one script at a time: python -m validation.stability.ties
    python docs/tools/stability.py

Writes `docs/validation/stability.md` and its charts, made smaller. What is not in the results keeps the
program from writing the page: it never mixes runs that are missing.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

DOCS = Path(__file__).parent.parent
RESULTS = DOCS.parent / "validation" / "results" / "stability"
PAGE = DOCS / "validation" / "stability.md"
PICTURES = DOCS / "pictures" / "stability"
#: width of a chart on the page, pixels
WIDTH = 760

#: chapters, and the findings of each: folder of the results
CHAPTERS = {
    "Beams": ["slenderness_euler", "slenderness_timoshenko", "shoulder_step", "thin_hollow_shaft", "krylov_duncan"],
    "Elements and meshes": [
        "linear_elements", "nearly_incompressible", "bad_elements", "sharp_shoulder", "ties", "split_pairs",
    ],
    "Modes": ["free_body_shift", "shift_on_eigenvalue", "clusters", "circumferential_families"],
    "Lumped models": ["guyan_in_frequency", "effective_mass_limits"],
    "Bearings and scenes": [
        "bearing_extremes", "doubtful_six_by_six", "strong_coupling", "odd_geometry", "impossible_geometry", "wrong_units",
    ],
    "The machine": ["operation"],
}  # fmt: skip
HEAD = """# Where methods fail

Every method was driven to its edge: what fails, where it was measured to fail, and what the program does about it. `python -m validation.stability` measures all, `python -m validation.stability.NAME` one, and `docs/tools/stability.py` makes the page.
"""


def titles() -> dict[str, tuple[str, str]]:
    """Folder of a finding -> its method and the test that guards it, from the report of a run."""
    report = (RESULTS / "report.md").read_text()
    out = {}
    for part in re.split(r"(?m)^## ", report)[1:]:
        name = part.split("\n", 1)[0].replace("-", "_")
        method = re.search(r"\*\*(.+?)\.\*\*", part)
        guard = re.search(r"Guard held by `(.+?)`", part)
        out[name] = (method[1] if method else name, guard[1] if guard else "")
    return out


def sections(known: dict[str, tuple[str, str]]) -> list[str]:
    """The page, line by line."""
    lines = [HEAD]
    for chapter, names in CHAPTERS.items():
        lines.append(f"## {chapter}\n")
        for name in names:
            method, guard = known[name]
            fails, edge, program = (RESULTS / name / "finding.txt").read_text().splitlines()
            lines += [f"### {method}\n", f"{fails}\n", f"**Measured.** {edge}\n"]
            lines.append(f"**What the program does.** {program}\n")
            lines.append(
                f"```{{image}} ../pictures/stability/{name}.png\n:alt: {method}\n:class: picture\n```\n"
            )
            if guard:
                lines.append(f"Held by the test `{guard}`.\n")
    return lines


def shrink(names: list[str]) -> None:
    """Charts at the width of the page, in few colours."""
    from PIL import Image

    PICTURES.mkdir(parents=True, exist_ok=True)
    for name in names:
        with Image.open(RESULTS / name / "chart.png") as chart:
            height = round(chart.height * WIDTH / chart.width)
            small = chart.convert("RGB").resize((WIDTH, height), Image.Resampling.LANCZOS)
            small.quantize(32).save(PICTURES / f"{name}.png", optimize=True)


def main() -> int:
    """Write the page, or say what is missing."""
    names = [name for chapter in CHAPTERS.values() for name in chapter]
    missing = [n for n in names if not (RESULTS / n / "finding.txt").exists()]
    if missing or not (RESULTS / "report.md").exists():
        print(f"not in {RESULTS}: {', '.join(missing) or 'report.md'}")
        return 1
    PAGE.write_text("\n".join(sections(titles())).rstrip() + "\n")
    shrink(names)
    return 0


if __name__ == "__main__":
    sys.exit(main())
