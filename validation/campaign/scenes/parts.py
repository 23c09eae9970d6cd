"""Random shafts with features, as text of scene files."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, field
from typing import Any

from validation.common import toml

Table = dict[str, Any]
#: sorts of parts, and how often they are drawn
SORTS = {"cut": 8, "cyclic": 5, "edges": 2, "cut and edges": 3, "smeared and cut": 2}
CUTS = ("keyway", "flat", "cross_hole")


@dataclass
class Drawn:
    """One random part: tables of its file, lengths in mm."""

    seed: int
    sort: str
    segments: list[Table]
    bearings: list[Table] = field(default_factory=list)
    masses: list[Table] = field(default_factory=list)
    features: list[Table] = field(default_factory=list)
    port: Table = field(default_factory=dict)

    @property
    def text(self) -> str:
        """The file."""
        head = [
            f'title = "part {self.seed}, {self.sort}"',
            "[material]",
            'E = "206 GPa"',
            "nu = 0.3",
            'density = "7850 kg/m^3"',
        ]
        for kind in ("segment", "feature", "bearing", "mass"):
            plural = {"mass": "masses"}.get(kind, f"{kind}s")
            for table in getattr(self, plural):
                head += ["", f"[[{kind}]]", *(f"{k} = {toml(v)}" for k, v in table.items())]
        head += ["", "[port]", *(f"{k} = {toml(v)}" for k, v in self.port.items())]
        head += ["", "[ask]", "modes = 6", "tolerance = 0.05"]
        return "\n".join(head) + "\n"

    @property
    def words(self) -> str:
        """Its features in a few words."""
        return " + ".join(f"{f['kind'].replace('_', ' ')}" for f in self.features)


def _mm(value: float) -> str:
    return f"{value:.4g} mm"


def draw(seed: int, sort: str | None = None) -> Drawn:
    """The part of a seed, of the sort that it chooses if none is given.

    Not every one fits together; what does not is refused in a sentence.
    """
    dice = random.Random(seed)
    sort = sort or dice.choices(list(SORTS), list(SORTS.values()))[0]
    segments = _segments(dice)
    out = Drawn(seed, sort, segments)
    seats = _seats(dice, segments)
    out.bearings = [_bearing(dice, name, *seat) for name, seat in zip("AB", seats)]
    loaded = max(range(len(segments)), key=lambda k: segments[k]["_d"])
    out.port = {"name": "gear", "at": f"{segments[loaded]['name']}.middle"}
    if "edges" in sort or dice.random() < 0.4:
        start = sum(s["_l"] for s in segments[:loaded])
        out.port["span"] = [_mm(start + q * segments[loaded]["_l"]) for q in (0.3, 0.7)]
    else:
        out.port["attach_to"] = segments[loaded]["name"]
    if dice.random() < 0.25:
        out.masses.append({"name": "disc", "on": "gear", "mass": f"{dice.uniform(0.5, 4):.3g} kg"})
    if "cut" in sort:
        for k in range(dice.choice((1, 1, 2, 3))):
            out.features.append(_cut(dice, k, segments))
    if "edges" in sort:
        for k in range(dice.choice((1, 2))):
            out.features += _edge(dice, k, segments)
    if sort in ("cyclic", "smeared and cut"):
        out.features += _cyclic(dice, segments, "smeared" in sort)
    for segment in segments:
        for key in [k for k in segment if k.startswith("_")]:
            del segment[key]
    return out


def _segments(dice: random.Random) -> list[Table]:
    bore = dice.choice((0.0, 0.0, dice.uniform(0.2, 0.5)))
    least = 40.0
    out: list[Table] = []
    for k in range(dice.randint(2, 5)):
        length, d = dice.uniform(30, 90), dice.uniform(least, 110)
        table: Table = {"kind": "cylinder", "name": f"s{k}", "length": _mm(length)}
        if dice.random() < 0.15:
            table["kind"] = "cone"
            table |= {"start_diameter": _mm(d), "end_diameter": _mm(d * dice.uniform(0.7, 1.3))}
        else:
            table["diameter"] = _mm(d)
        if bore:
            table["bore"] = _mm(bore * least)
        out.append(table | {"_l": length, "_d": d, "_bore": bore * least})
    if all(t["kind"] == "cone" for t in out):
        return _segments(dice)
    return out


def _seats(dice: random.Random, segments: list[Table]) -> list[tuple[str, float, float]]:
    """Segment, middle and width of two seats."""
    first, last = dice.uniform(0.15, 0.35), dice.uniform(0.65, 0.85)
    if len(segments) == 2 and dice.random() < 0.5:
        return [(segments[-1]["name"], q * segments[-1]["_l"], 12.0) for q in (first, last)]
    picked = sorted(dice.sample(range(len(segments)), 2))
    return [(segments[k]["name"], dice.uniform(0.3, 0.7) * segments[k]["_l"], 14.0) for k in picked]


def _bearing(dice: random.Random, name: str, segment: str, middle: float, width: float) -> Table:
    k = 10 ** dice.uniform(7.7, 9.3)
    tilt = k * 0.02**2
    return {
        "name": name,
        "position": _mm(middle),
        "from": f"{segment}.start",
        "seat_width": _mm(width),
        "attachment": dice.choice(("average", "average", "average", "rigid")),
        "stiffness": {
            "kxx": f"{k:.5g} N/m",
            "kzz": f"{k * dice.uniform(0.8, 1.2):.5g} N/m",
            "kyy": f"{k * dice.uniform(0.2, 0.6):.5g} N/m",
            "kthx": f"{tilt:.5g} N*m/rad",
            "kthz": f"{tilt:.5g} N*m/rad",
        },
    }


def _cylinder(dice: random.Random, segments: list[Table]) -> Table:
    return dice.choice([s for s in segments if s["kind"] == "cylinder"])


def _cut(dice: random.Random, k: int, segments: list[Table]) -> Table:
    s, kind = _cylinder(dice, segments), dice.choice(CUTS)
    r, wall = s["_d"] / 2, (s["_d"] - s["_bore"]) / 2
    angle = dice.choice((0, 0, 90, 180, dice.randint(1, 359)))
    out: Table = {"kind": kind, "name": f"f{k}", "segment": s["name"], "angle": f"{angle} deg"}
    if kind == "cross_hole":
        d = dice.uniform(0.15, 0.6) * r
        place = dice.uniform(0.3, 0.7) * s["_l"]
        return out | {"position": _mm(place), "diameter": _mm(d)}
    length = dice.uniform(0.4, 0.85) * s["_l"]
    place = dice.choice((0.0, 0.5, 0.9)) * (s["_l"] - length)
    out |= {"position": _mm(place), "length": _mm(length)}
    if kind == "flat":
        return out | {"depth": _mm(dice.uniform(0.08, 0.4) * wall)}
    width = min(dice.uniform(0.3, 0.7) * r, 0.7 * length)
    depth = max(dice.uniform(0.15, 0.4) * wall, 1.2 * (r - math.sqrt(r * r - width**2 / 4)))
    ends = dice.choice(("round", "square"))
    return out | {"width": _mm(width), "depth": _mm(depth), "ends": ends}


def _edge(dice: random.Random, k: int, segments: list[Table]) -> list[Table]:
    """A fillet or chamfer at a step, at its root or its rim, or at an end."""
    place = dice.randrange(len(segments))
    size = dice.uniform(1.0, 4.0)
    out: Table = {"name": f"e{k}", "at": f"s{place}.start"}
    if place and dice.random() < 0.3:
        out["edge"] = "rim"
    if dice.random() < 0.6:
        return [{"kind": "fillet", **out, "radius": _mm(size)}]
    angle = dice.choice(("45 deg", "30 deg"))
    return [{"kind": "chamfer", **out, "length": _mm(size), "angle": angle}]


def _cyclic(dice: random.Random, segments: list[Table], smeared: bool) -> list[Table]:
    s = _cylinder(dice, segments)
    count = dice.choice((6, 8, 12))
    teeth: Table = {
        "kind": dice.choice(("teeth", "spline")),
        "name": "teeth",
        "segment": s["name"],
        "count": count,
        "addendum": round(dice.uniform(0.4, 1.0), 2),
        "dedendum": round(dice.uniform(0.4, 1.0), 2),
        "angle": f"{dice.choice((0, 10, 25))} deg",
        "model": "pitch_cone" if smeared else "sector",
    }
    if not smeared and dice.random() < 0.3:
        teeth |= {"spiral_angle": "20 deg", "hand": dice.choice(("left", "right"))}
    if smeared:
        return [teeth]
    rest = [t for t in segments if t["name"] != s["name"]]
    bolts: list[Table] = []
    if rest and dice.random() < 0.5:
        b = dice.choice(rest)
        room = (b["_d"] - b["_bore"]) / 2
        bolts = [
            {
                "kind": "bolt_circle",
                "name": "bolts",
                "segment": b["name"],
                "count": count if count < 12 else 6,
                "diameter": _mm(0.35 * room),
                "circle": _mm(b["_bore"] + 2 * dice.uniform(0.4, 0.6) * room),
                "depth": _mm(dice.uniform(0.4, 1.0) * b["_l"]),
                "side": "start" if b is segments[0] else "end",
                "angle": f"{dice.choice((0, 7))} deg",
            }
        ]
    return [*dice.choice(([teeth], [teeth], [])), *bolts] or [teeth]
