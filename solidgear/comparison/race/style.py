"""Style of the families and series of a race: colours, markers and names."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from solidgear.comparison.race.pareto import AUTOMATIC, Race
from solidgear.show.panel import SHAPES

#: of a family that is not listed
GREY = "#777777"
#: the reference itself and its error bar
REFERENCE = "#00603f"
#: families, in the order of the legend: name there, colour
FAMILIES = {
    "lumped": ("lumped", "#b3305c"),
    "beam": ("beams", "#0072b2"),
    "harmonic": ("harmonic solid", "#00805e"),
    "tetrahedra": ("3D, tetrahedra", "#d08a00"),
    "hexahedra": ("3D, hexahedra", "#5a3e8c"),
    AUTOMATIC: ("automatic choice", "#111111"),
}
#: series without its grading -> shape, by the letters of ``plot.SHAPES``
MARKERS = {
    "lumped": "P",
    AUTOMATIC: "*",
    "Euler": "v",
    "Timoshenko": "s",
    "harmonic h": "o",
    "harmonic p": "D",
    "TET4": "<",
    "TET10": "^",
    "HEX8": "s",
    "HEX20": "D",
    "HEX27": "h",
}
#: families that have no mesh to refine: they do not converge to the reference
SCATTERED = ("lumped", "beam")


@dataclass(frozen=True)
class Look:
    """Style of one series: dashed and pale for uniform meshes."""

    series: str
    family: str

    @property
    def colour(self) -> str:
        return FAMILIES[self.family][1] if self.family in FAMILIES else GREY

    @property
    def shape(self) -> str:
        kind = self.series.removesuffix(" uniform").removesuffix(" graded")
        return SHAPES[MARKERS.get(kind, "o")]

    @property
    def uniform(self) -> bool:
        return self.series.endswith("uniform")

    @property
    def converges(self) -> bool:
        """True where the levels refine one mesh."""
        return self.family not in SCATTERED

    @property
    def width(self) -> float:
        return 1.0 if self.uniform else 1.5

    @property
    def dash(self) -> list[float]:
        return [5, 3] if self.uniform else [1, 0]

    @property
    def fill(self) -> str:
        """Inside of the markers; empty means like for like."""
        if not self.uniform:
            return self.colour
        parts = (int(self.colour[k : k + 2], 16) for k in (1, 3, 5))
        return "#" + "".join(f"{round(0.35 * part + 0.65 * 255):02x}" for part in parts)

    @property
    def marks(self) -> dict[str, Any]:
        """Markers in Vega-Lite."""
        look = {"type": "point", "shape": self.shape, "stroke": self.colour, "fill": self.fill}
        return look | {"size": 45, "strokeWidth": 1}

    @property
    def name(self) -> str:
        """Name in the legend, below the family."""
        if self.family == AUTOMATIC:
            return "automatic, by tolerance:\nall meshes tried"
        name = self.series.replace("harmonic ", "")
        return name.replace("h ", "h, order 2, ").replace("p ", "p, order 1 up, ")


def looks(race: Race) -> dict[str, list[Look]]:
    """Return the series of a race by family, in the order of the legend."""
    by_family: dict[str, list[Look]] = {family: [] for family in FAMILIES}
    for row in race.rows:
        look = Look(row.series, row.family)
        same = by_family.setdefault(row.family, [])
        if look not in same:
            same.append(look)
    return {family: series for family, series in by_family.items() if series}


def family_name(family: str) -> str:
    """Return the name of a family in the legend."""
    return FAMILIES[family][0] if family in FAMILIES else family
