"""Matrices of nodes and directions, as decks have them, brought to points and modes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from solidgear.core import SceneError, listed, nearest, show
from solidgear.core.reduction.matrix_units import matrix_units
from solidgear.core.reduction.port_matrices import PortMatrices, checked_matrices
from solidgear.core.scene.units import quantity
from solidgear.exchange.matrices.header import Stated

#: a node and a direction, 1 to 6
Label = tuple[int, int]
#: entries by row and column
Entries = dict[tuple[Label, Label], float]


@dataclass
class NodeMatrices:
    """Entries of matrices by nodes, with what the file says of the nodes."""

    source: str
    entries: dict[str, Entries] = field(default_factory=dict)  #: by name of the matrix
    places: dict[int, np.ndarray] = field(default_factory=dict)  #: in the units of the file
    head: Stated = field(default_factory=Stated)

    def add(self, name: str, row: Label, column: Label, value: float, symmetric: bool) -> None:
        """Add an entry, of a symmetric matrix the mirrored one as well."""
        entries = self.entries.setdefault(name, {})
        entries[row, column] = value
        if symmetric:
            entries[column, row] = value

    def matrices(self, points: Mapping[str, Any] | None, units: str) -> PortMatrices:
        """Return the matrices by points, named as the user or else the file has it, and modes."""
        labels = {label for entries in self.entries.values() for pair in entries for label in pair}
        nodes: dict[int, set[int]] = {}
        for node, direction in sorted(labels):
            nodes.setdefault(node, set()).add(direction)
        names = self._names(points, nodes)
        for node, name in names.items():
            if nodes[node] != {1, 2, 3, 4, 5, 6}:
                raise self.wrong(
                    f"node {node} of point {name!r} has {len(nodes[node])} directions; a point has "
                    "all six: couple solid faces to a reference node before they are condensed"
                )
        modal = [(node, d) for node in nodes if node not in names for d in sorted(nodes[node])]
        order = [(node, d) for node in names for d in range(1, 7)] + modal
        row_of = {label: row for row, label in enumerate(order)}
        arrays = {}
        for name, entries in self.entries.items():
            arrays[name] = np.zeros((len(order), len(order)))
            for (row, column), value in entries.items():
                arrays[name][row_of[row], row_of[column]] = value
        system = matrix_units(units or self.head.units or "m-kg-N")
        places = self._places(points, names, system.length)
        return checked_matrices(self.source, arrays, places, system)

    def wrong(self, reason: str) -> SceneError:
        """Return an error that names the file."""
        return SceneError(reason, where=self.source)

    def _names(self, points: Mapping[str, Any] | None, nodes: Iterable[int]) -> dict[int, str]:
        """Return names of points by node: those given, those of the head, or numbers of all nodes
        with a place and six directions.
        """
        nodes = {*nodes}
        if points:
            out = {}
            for name, entry in points.items():
                node = entry.get("node") if isinstance(entry, Mapping) else entry
                if not isinstance(node, int) or node not in nodes:
                    hint = nearest(str(node), map(str, nodes))
                    raise self.wrong(
                        f"point {name!r}: {show(node, 20)} is no node of the matrices{hint}; there "
                        f"are {listed(map(str, sorted(nodes)), 12)}"
                    )
                if node in out:
                    raise self.wrong(f"points {out[node]!r} and {name!r} are one node, {node}")
                out[node] = name
            return out
        names = {node: name for node, name in self.head.names.items() if node in nodes}
        return names or {node: str(node) for node in sorted(nodes) if node in self.places}

    def _places(self, points: Mapping[str, Any] | None, names: Mapping[int, str], length: float):
        """Return positions by name, in the units of the file."""
        out = {}
        for node, name in names.items():
            entry = (points or {}).get(name)
            if isinstance(entry, Mapping) and "position" in entry:
                out[name] = np.array([quantity(v, "length") for v in entry["position"]]) / length
            elif node in self.places:
                out[name] = self.places[node]
            else:
                raise self.wrong(
                    f"nothing says where node {node} lies; write points = {{{name!r} = {{node = "
                    f'{node}, position = ["0 mm", "120 mm", "0 mm"]}}}}'
                )
        return out


def node_of(row: int, points: int) -> Label:
    """Return the node and direction of a coordinate, each mode a node of its own."""
    if row < 6 * points:
        return row // 6 + 1, row % 6 + 1
    return row - 5 * points + 1, 1
