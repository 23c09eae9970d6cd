"""Gearboxes in REXS beside the trains made of them: counts, ratio, distances, masses.

    python -m validation.rexs_files gearbox.rexs ...

What a file holds is read here from its XML alone, by none of the package's code; the trains are
those of :func:`solidgear.exchange.rexs.importing.imported`, read back from the files they make.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from math import dist, pi
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import solidgear as sg
from solidgear.exchange.rexs.importing import imported, name_of
from solidgear.exchange.rexs.reading import read

#: relative difference that ends in a word
SAME = 1e-9
#: of places of axes, which writers round
PLACED = 1e-4


class Row(NamedTuple):
    """A number of a file beside that of the train."""

    name: str
    file: float
    train: float

    def agrees(self, tolerance: float = SAME) -> bool:
        """Return True where both are one number."""
        return abs(self.file - self.train) <= tolerance * max(abs(self.file), 1e-12)


class Tree:
    """Components and relations of a REXS file in XML."""

    def __init__(self, path: Path):
        root = ElementTree.parse(path).getroot()
        self.kinds, self.values, self.vectors = {}, {}, {}
        for component in root.iterfind("components/component"):
            number = component.get("id")
            self.kinds[number] = component.get("type")
            for attribute in component:
                key = number, attribute.get("id")
                cells = [
                    float(c.text)
                    for c in attribute.iterfind("array/c")
                    if c.text[0] in "-0123456789"
                ]
                if cells:
                    self.vectors[key] = cells
                elif attribute.text:
                    self.values[key] = attribute.text.strip()
        self.relations = [
            (relation.get("type"), {ref.get("role"): ref.get("id") for ref in relation})
            for relation in root.iterfind("relations/relation")
        ]

    def number(self, component: str, name: str) -> float:
        """Return a number as the file has it; 0 where it has none."""
        return float(self.values.get((component, name), 0.0))

    def parts(self, whole: str, kind: str) -> list[str]:
        """Return the parts of a component of a type."""
        return [
            refs["part"]
            for name, refs in self.relations
            if name == "assembly" and refs["assembly"] == whole and self.kinds[refs["part"]] == kind
        ]

    def stages(self) -> Iterator[tuple[str, str, str]]:
        """Yield stages with their two gears."""
        for name, refs in self.relations:
            if name == "stage":
                yield refs["stage"], refs["gear_1"], refs["gear_2"]

    def shaft_of(self, gear: str) -> str:
        """Return the shaft of a gear."""
        pairs = (refs for name, refs in self.relations if name == "assembly")
        return next(refs["assembly"] for refs in pairs if refs["part"] == gear)

    def mass(self, shaft: str, density: float) -> float:
        """Return the mass of a shaft by its sections as frusta, kg."""
        volume = 0.0
        for section in self.parts(shaft, "shaft_section"):
            for sign, side in ((1, "outer"), (-1, "inner")):
                a, b = (self.number(section, f"{side}_diameter_{end}") for end in ("begin", "end"))
                volume += sign * self.number(section, "length") * (a * a + a * b + b * b) * pi / 12
        return 1e-9 * volume * density

    def density(self, shaft: str) -> float:
        """Return the density of a shaft, kg/m^3; that of steel where the file gives none."""
        for name, refs in self.relations:
            if name == "reference" and refs["origin"] == shaft:
                if self.kinds[refs["referenced"]] == "material":
                    return 1e3 * self.number(refs["referenced"], "density")
        return 7850.0


def rows(path: Path) -> list[Row]:
    """Return the numbers of a file beside those of the train made of it."""
    tree = Tree(path)
    made = imported(read(path), name_of(path))
    with tempfile.TemporaryDirectory() as folder:
        for name, text in made.files.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        train = sg.load_train(Path(folder) / next(iter(made.files)))
    out = [*_stages(tree, train)]
    by_title = {shaft.scene.title: shaft for shaft in train.shafts.values()}
    names = _names(path)
    for number, kind in tree.kinds.items():
        shaft = by_title.get(names.get(number, ""))
        if kind != "shaft" or shaft is None:
            continue
        title, scene = names[number], shaft.scene
        sections = tree.parts(number, "shaft_section")
        out.append(Row(f"{title}: sections", len(sections), len(scene.segments)))
        length = sum(tree.number(section, "length") for section in sections) / 1e3
        out.append(Row(f"{title}: length, m", length, scene.length))
        mass = tree.mass(number, tree.density(number))
        out.append(Row(f"{title}: mass, kg", mass, _mass(scene)))
    out += [*_bearings(tree, train)]
    return out


def _names(path: Path) -> dict[str, str]:
    root = ElementTree.parse(path).getroot()
    return {c.get("id"): c.get("name") for c in root.iterfind("components/component")}


def _mass(scene: sg.Scene) -> float:
    """Return the mass of segments of a scene, kg."""
    return sum(
        s.material.density
        * pi
        / 3
        * s.length
        * (_square(s.outer0, s.outer1) - _square(s.inner0, s.inner1))
        for s in scene.segments
    )


def _square(a: float, b: float) -> float:
    return a * a + a * b + b * b


def _stages(tree: Tree, train: sg.Train) -> Iterator[Row]:
    """Yield teeth, distances and the ratio of stages of a train without planets."""
    pairs = {frozenset((p.pinion.teeth, p.gear.teeth)): p for p in train.pairs}
    ratio = 1.0
    plain = [s for s in tree.stages() if "ring_gear" not in (tree.kinds[s[1]], tree.kinds[s[2]])]
    if train.stages:
        yield from _planets(tree, train)
        return
    yield Row("stages", len(plain), len(train.pairs))
    for stage, first, second in plain:
        teeth = [abs(int(tree.number(gear, "number_of_teeth"))) for gear in (first, second)]
        pair = pairs[frozenset(teeth)]
        ratio *= teeth[1] / teeth[0]
        distance = tree.number(stage, "center_distance") / 1e3
        yield Row(f"{stage}: centre distance, m", distance, pair.mesh.centre_distance)
        places = [
            tree.vectors[tree.shaft_of(gear), "support_vector"][1:] for gear in (first, second)
        ]
        apart = round(dist(*places) / 1e3, 7)
        yield Row(f"{stage}: axes apart, m", apart, round(pair.mesh.centre_distance, 7))
    yield Row("ratio", max(ratio, 1 / ratio), max(train.ratio, 1 / train.ratio))


def _planets(tree: Tree, train: sg.Train) -> Iterator[Row]:
    """Yield teeth, planets, distance and ratio of the planetary stage of a train."""
    stage = train.stages[0]
    rings = [s for s in tree.stages() if "ring_gear" in (tree.kinds[s[1]], tree.kinds[s[2]])]
    suns = [s for s in tree.stages() if s not in rings]
    counts = [abs(int(tree.number(gear, "number_of_teeth"))) for gear in (suns[0][1], rings[0][1])]
    ring = next(gear for gear in rings[0][1:] if tree.kinds[gear] == "ring_gear")
    ring_teeth = abs(tree.number(ring, "number_of_teeth"))
    yield Row("planets", len(rings), len(stage.teeth.azimuths))
    yield Row("teeth of a planet", counts[1], stage.teeth.planet)
    distance = tree.number(suns[0][0], "center_distance") / 1e3
    yield Row("centre distance, m", distance, round(stage.teeth.pin_radius, 9))
    yield Row("ratio", 1 + ring_teeth / counts[0], train.ratio)


def _bearings(tree: Tree, train: sg.Train) -> Iterator[Row]:
    """Yield the number of bearings between shafts of the train and the casing, or each other."""
    count = sum(1 for kind in tree.kinds.values() if "bearing" in kind and "row" not in kind)
    if not train.stages:
        yield Row("bearings", count, sum(len(s.scene.bearings) for s in train.shafts.values()))


def main() -> None:
    """Print the rows of files, and a word where a number differs."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="+", type=Path)
    for path in parser.parse_args().files:
        print(path.name)
        for row in rows(path):
            tolerance = PLACED if "apart" in row.name else SAME
            word = "" if row.agrees(tolerance) else "  DIFFERS"
            print(f"  {row.name:45s} {row.file:14.9g} {row.train:14.9g}{word}")


if __name__ == "__main__":
    main()
