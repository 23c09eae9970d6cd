"""A shaft of one's own, from Python to a better design, a report and a file.

It illustrates how to:

* build a shaft by the words of a file,
* sweep, search and report from one object.
"""

import tempfile
from pathlib import Path

import solidgear as sg


def main(folder=None):
    out = Path(folder or tempfile.mkdtemp())
    ends = {"length": "60 mm", "diameter": "30 mm"}
    seat = sg.Segment.cylinder("seat", length="70 mm", diameter="45 mm")
    segments = [sg.Segment.cylinder("left", **ends), seat, sg.Segment.cylinder("right", **ends)]
    places = {"A": "15 mm", "B": "175 mm"}
    bearings = [
        sg.Bearing(name=name, position=place, seat_width="16 mm", designation="6206")
        for name, place in places.items()
    ]
    gear = sg.Port(name="gear", at="seat.middle", attach_to="seat")
    load = {"x": "2 kN", "z": "1 kN"}
    shaft = sg.Scene.from_parts(segments, "42CrMo4", bearings=bearings, port=gear, load=load)

    print(sg.answer(shaft, "1 %", ["C_zz", "bending 1"]))
    rows = sg.sweep(shaft, "segment.seat.diameter=40 mm:50 mm:3", model="timoshenko", n=1)
    print(rows.to_dataframe()[["segment.seat.diameter", "C_zz", "f1_hz"]])
    vary, limit = ["segment.seat.diameter=35 mm:60 mm"], ["mass < 1.6 kg"]
    best = sg.optimise(shaft, vary, "min C_zz", limit, model="timoshenko")
    print(best.sentences[0])
    best.write(out / "search")
    sg.compare(shaft, ("timoshenko", "harmonic")).write_report(out / "report", renders=False)
    shaft.to_toml(out / "shaft.toml")
    return {"folder": out, "shaft": shaft, "rows": rows, "best": best}


if __name__ == "__main__":
    main()
