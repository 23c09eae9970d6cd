"""A harmonic solid as some seventy coordinates, and back.

It illustrates how to:

* keep a station without a bearing, such as a sensor at the end of a shaft,
* let a gear blank sit on a port as a rigid inertia,
* read the proven error of what was left out,
* bring a mode shape back to the mesh.
"""

from pathlib import Path

import numpy as np

import solidgear as sg

GEOMETRY = Path(__file__).parent.parent / "geometry"


def main():
    scene = sg.load(GEOMETRY / "pinion_overhung.toml")
    # A station without a bearing is a bearing without stiffness.
    sensor = sg.Bearing(name="sensor", y=0.271, seat_width=0.008, stiffness=np.zeros((6, 6)))
    scene = scene.with_changes(bearings=(*scene.bearings, sensor))
    body = sg.build(scene, "harmonic", order=4, layers=2)

    blank = sg.PortInertia("shaft.pinion", np.diag([2, 2, 2, 0.003, 0.005, 0.003]))
    links = {**sg.grounded("shaft", scene), "blank": blank}
    bound = {}
    for reduce in (sg.craig_bampton, sg.rubin):
        part = reduce(body, n=20)
        system = sg.System({"shaft": part}, links)
        modes = system.modes(6)
        bound[part.kind] = modes.error_bound.max()
        print(
            f"{part.kind:13s} {part.size} coordinates for {body.size} unknowns, "
            f"frequencies within {bound[part.kind]:.1e}"
        )

    # Back on the mesh: first bending, of which the shaft alone has this share of the modal mass.
    shape = modes.shapes[:, 1]
    fields = system.expand("shaft", shape)
    share = sum(u @ (body.blocks[b].mass @ u) for b, u in fields.items())
    swing = np.linalg.norm((system.motion("shaft.sensor") @ shape)[:3])
    print(f"{modes.frequency_hz[1]:.1f} Hz, {100 * share:.0f} % of the modal mass in the shaft")
    return {"bound": bound, "bending": modes.frequency_hz[1], "share": share, "sensor": swing}


if __name__ == "__main__":
    main()
