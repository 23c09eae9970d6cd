"""What will hold, asked before anything large is solved.

It illustrates how to:

* check a scene,
* read verdicts and cautions.
"""

from pathlib import Path

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    found = sg.check(GEOMETRY / "pinion_overhung.toml")
    for model, verdict in found.verdicts.items():
        print(f"{model:11s} {verdict.verdict}")
    for caution in found.cautions:
        print("-", caution)
    return {model: verdict.verdict for model, verdict in found.verdicts.items()}


if __name__ == "__main__":
    main()
