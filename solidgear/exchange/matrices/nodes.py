"""Matrices of nodes and directions, as decks have them, brought to points and modes.

What moves beside the points is either a coordinate of a mode already, as where the program has
condensed its body, or it is condensed here (Craig and Bampton 1968), with the static fields of the
inertia of its static shapes beside the modes, a Krylov step: modes alone converge slowly where a
rigid face ends.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
import scipy.sparse.linalg as ssl

from solidgear.core import SceneError, listed, nearest, show
from solidgear.core.reduction.matrix_units import MatrixUnits, matrix_units
from solidgear.core.reduction.port_matrices import (
    MOST,
    PortMatrices,
    checked_matrices,
    rigid_motions,
)
from solidgear.core.scene.units import quantity
from solidgear.exchange.matrices.header import Stated

#: a node and a direction, 1 to 6
Label = tuple[int, int]
#: keys of a point that is a table
POINT_KEYS = ("node", "position")
#: modes that are kept of a body that is condensed here
KEPT = 40
#: unknowns up to which all modes are computed
DENSE = 600
#: part of a field that is not in the modes and no rounding
NEW = 1e-6
#: strain energy of rigid motions, over that of the entries, that rounding leaves
STRAINED = 1e-6


@dataclass
class NodeMatrices:
    """Matrices by nodes, with what the file says of the nodes."""

    source: str
    #: entries by row and column, by name of the matrix
    entries: dict[str, dict[tuple[Label, Label], float]] = field(default_factory=dict)
    places: dict[int, np.ndarray] = field(default_factory=dict)  #: in the units of the file
    head: Stated = field(default_factory=Stated)
    #: directions (3, 3) of nodes that are turned, as columns in x, y, z
    turns: dict[int, np.ndarray] = field(default_factory=dict)
    left_out: dict[str, None] = field(default_factory=dict)  #: what the file has beside matrices
    #: in place of entries: nodes and directions of rows, and the matrices
    stored: tuple[list[Label], dict[str, sp.csr_matrix]] | None = None

    def add(self, name: str, row: Label, column: Label, value: float, symmetric: bool) -> None:
        """Add an entry, of a symmetric matrix the mirrored one as well."""
        entries = self.entries.setdefault(name, {})
        entries[row, column] = value
        if symmetric:
            entries[column, row] = value

    def wrong(self, reason: str) -> SceneError:
        """Return an error that names the file."""
        return SceneError(reason, where=self.source)

    def matrices(self, points: Mapping[str, Any] | None, units: str) -> PortMatrices:
        """Return the matrices by points, called as the user or else the file has it, and modes."""
        labels, tables = self._in_axes(*(self.stored or self._assembled()))
        rows = {label: k for k, label in enumerate(labels)}
        nodes: dict[int, int] = {}
        for node, _ in labels:
            nodes[node] = nodes.get(node, 0) + 1
        point_nodes = self._named(points, nodes)
        chosen = []
        for name, (node, turned) in point_nodes.items():
            motions = [(node, d) for d in (1, 2, 3)]
            motions += [(turned, d if turned != node else d + 3) for d in (1, 2, 3)]
            for label in motions:
                if label not in rows:
                    raise self.wrong(
                        f"node {label[0]} of point {name!r} does not move in direction {label[1]}; "
                        "a point has six: a reference node that faces are coupled to, of CalculiX "
                        "REF NODE and ROT NODE, node = [5, 6]"
                    )
                chosen.append(rows[label])
        others = np.setdiff1d(np.arange(len(labels)), chosen)
        order = np.r_[np.array(chosen, int), others]
        arrays = {name: table[order][:, order] for name, table in tables.items()}
        system = matrix_units(units or self.head.units or "m-kg-N")
        places = self._places(points, point_nodes, system)
        arrays, notes = self._with_modes(arrays, places)
        if self.left_out:
            notes = (*notes, f"left out: {', '.join(self.left_out)}")
        return checked_matrices(self.source, arrays, places, system, notes)

    def _assembled(self) -> tuple[list[Label], dict[str, sp.csr_matrix]]:
        """Return labels in order, and the matrices of the entries."""
        labels = sorted({label for e in self.entries.values() for pair in e for label in pair})
        rows = {label: k for k, label in enumerate(labels)}
        tables = {}
        for name, entries in self.entries.items():
            at = np.array([(rows[row], rows[column]) for row, column in entries]).T
            size = (len(labels), len(labels))
            tables[name] = sp.csr_matrix((list(entries.values()), tuple(at)), shape=size)
        return labels, tables

    def _in_axes(
        self, labels: list[Label], tables: Mapping[str, sp.csr_matrix]
    ) -> tuple[list[Label], Mapping[str, sp.csr_matrix]]:
        """Return the matrices with the motions of turned nodes along x, y, z."""
        rows = {label: k for k, label in enumerate(labels)}
        turn = sp.eye(len(labels), format="lil")
        for node, axes in self.turns.items():
            for triple in ((1, 2, 3), (4, 5, 6)):
                places = [rows[node, d] for d in triple if (node, d) in rows]
                if places and len(places) < 3:
                    raise self.wrong(
                        f"node {node} has turned directions and moves in {len(places)} of three; give "
                        "all three, or none"
                    )
                if places:
                    turn[np.ix_(places, places)] = axes
        if not self.turns:
            return labels, tables
        turn = turn.tocsr()
        return labels, {name: turn @ table @ turn.T for name, table in tables.items()}

    def _named(
        self, points: Mapping[str, Any] | None, nodes: Mapping[int, int]
    ) -> dict[str, tuple[int, int]]:
        """Return the nodes that move and turn every point: those given, those of the head, or all
        with a place and six directions.
        """
        if not points:
            point_nodes = {name: (k, k) for k, name in self.head.names.items() if k in nodes}
            alone = (k for k in sorted(nodes) if k in self.places and nodes[k] == 6)
            return point_nodes or {str(k): (k, k) for k in alone}
        out: dict[str, tuple[int, int]] = {}
        for name, entry in points.items():
            for key in (*entry,) if isinstance(entry, Mapping) else ():
                if key not in POINT_KEYS:
                    hint = nearest(key, POINT_KEYS)
                    raise self.wrong(f"point {name!r}: unknown key {show(key, 20)}{hint}")
            node: Any = entry.get("node") if isinstance(entry, Mapping) else entry
            pair = node if isinstance(node, (list, tuple)) else [node, node]
            for number in pair:
                if len(pair) != 2 or not isinstance(number, int) or number not in nodes:
                    hint = nearest(str(number), map(str, nodes))
                    raise self.wrong(
                        f"point {name!r}: {show(node, 20)} is no node of the matrices{hint}; there "
                        f"are {listed(sorted(nodes), 12)}"
                    )
            if (pair[0], pair[1]) in out.values():
                raise self.wrong(f"point {name!r} is at node {pair[0]}, which has a name already")
            out[name] = (pair[0], pair[1])
        return out

    def _places(
        self,
        points: Mapping[str, Any] | None,
        point_nodes: Mapping[str, tuple[int, int]],
        units: MatrixUnits,
    ) -> dict[str, np.ndarray]:
        """Return positions by name, in the units of the file."""
        out = {}
        for name, (node, _) in point_nodes.items():
            entry = (points or {}).get(name)
            if isinstance(entry, Mapping) and "position" in entry:
                position = entry["position"]
                if not isinstance(position, (list, tuple)) or len(position) != 3:
                    raise self.wrong(f"position of point {name!r} is no three lengths")
                place = [quantity(value, "length") for value in position]
                out[name] = np.array(place) / units.length
            elif node in self.places:
                out[name] = self.places[node]
            else:
                raise self.wrong(
                    f"nothing says where node {node} lies; write points = {{{name!r} = {{node = "
                    f'{node}, position = ["0 mm", "120 mm", "0 mm"]}}}}'
                )
        return out

    def _with_modes(
        self, tables: Mapping[str, sp.csr_matrix], places: Mapping[str, np.ndarray]
    ) -> tuple[dict[str, np.ndarray], tuple[str, ...]]:
        """Return dense matrices of points and modes, condensed where there are other unknowns."""
        p = 6 * len(places)
        stiffness = tables.get("stiffness")
        if not places or stiffness is None or "mass" not in tables:
            return {name: table.toarray() for name, table in tables.items()}, ()
        n = stiffness.shape[0]
        rigid = rigid_motions(places.values())
        strained = stiffness[:, :p] @ rigid
        size = abs(stiffness[:, :p]) @ abs(rigid)
        others = np.abs(strained[p:]).max(initial=0.0)
        if n <= MOST and others <= STRAINED * size.max():
            return {name: table.toarray() for name, table in tables.items()}, ()
        shapes = self._shapes(tables, p)
        dense = {name: shapes.T @ (table @ shapes) for name, table in tables.items()}
        for name in dense.keys() - {"gyroscopic"}:
            dense[name] = (dense[name] + dense[name].T) / 2
        count = shapes.shape[1] - p
        return dense, (f"condensed from {n} unknowns to its points and {count} modes",)

    def _shapes(self, tables: Mapping[str, sp.csr_matrix], p: int) -> np.ndarray:
        """Return static shapes of unit motions of points, and the lowest modes with points held."""
        stiffness, mass = (tables[name][p:, p:].tocsc() for name in ("stiffness", "mass"))
        n = stiffness.shape[0]
        try:
            factor = ssl.splu(stiffness)
            static = -factor.solve(tables["stiffness"][p:, :p].toarray())
            if n <= DENSE:
                modes = sla.eigh(stiffness.toarray(), mass.toarray())[1][:, :KEPT]
            else:
                modes = ssl.eigsh(stiffness, KEPT, mass, sigma=0.0)[1]
        except (RuntimeError, sla.LinAlgError, ssl.ArpackError) as error:
            raise self.wrong(
                f"cannot be condensed to its points ({error}); unknowns beside them need stiffness "
                "and mass, all held by the points"
            ) from None
        if not np.isfinite(static).all():
            raise self.wrong("cannot be condensed: the points do not hold all that moves")
        inertia = mass @ static + tables["mass"][p:, :p].toarray()
        modes = _with_fields(stiffness, mass, modes, factor.solve(inertia))
        points = np.eye(p, p + modes.shape[1])
        return np.vstack([points, np.hstack([static, modes])])


def _with_fields(stiffness, mass, modes: np.ndarray, fields: np.ndarray) -> np.ndarray:
    """Return the Ritz vectors of modes of unit mass and of further fields, of unit mass too."""
    size = np.sqrt(np.abs(np.einsum("ij,ij->j", fields, mass @ fields)))
    fields = fields / np.where(size > 0, size, 1.0)
    for _ in range(2):
        fields = fields - modes @ (modes.T @ (mass @ fields))
    share, mix = np.linalg.eigh(fields.T @ (mass @ fields))
    new = share > NEW**2
    basis = np.hstack([modes, fields @ (mix[:, new] / np.sqrt(share[new]))])
    gram, energy = basis.T @ (mass @ basis), basis.T @ (stiffness @ basis)
    return basis @ sla.eigh((energy + energy.T) / 2, (gram + gram.T) / 2)[1]


def real(value: float) -> str:
    """Return a number in 20 characters, the most that Abaqus and CalculiX read."""
    return f"{value:.13e}"


def node_of(row: int, points: int) -> Label:
    """Return the node and direction of a coordinate, each mode a node of its own."""
    if row < 6 * points:
        return row // 6 + 1, row % 6 + 1
    return row - 5 * points + 1, 1
