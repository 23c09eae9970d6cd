"""Which model to trust: every model of one shaft, with the evidence and a verdict.

It illustrates how to:

* ask for a tolerance,
* compare models, and read why one of them will not do.
"""

from pathlib import Path

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    scene = sg.load(GEOMETRY / "shaft_hollow.toml")
    scene = scene.with_changes(ask=scene.ask.with_changes(tolerance=0.02))
    comparison = sg.compare(scene, ("euler", "timoshenko", "harmonic"))
    verdict = comparison.record.verdict
    for model, record in comparison.record.models.items():
        status = "valid" if record.valid else record.why_not
        print(f"{model:11s} {status}")
    print("trust:", verdict.trust, "- cheapest:", verdict.cheapest)
    # comparison.write_report("out") makes the page, the pictures and results.json
    return {"trust": verdict.trust, "cheapest": verdict.cheapest}


if __name__ == "__main__":
    main()
