"""A shaft by the matrices of another program: its body, with the stations of its scene as ports."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy.sparse as sp

from solidgear.core import Body, Scene, SceneError, listed, nearest
from solidgear.core.body import Block, Port
from solidgear.core.reduction.port_matrices import PortMatrices
from solidgear.trains.file.train import Train

#: model of a shaft by the matrices that its table names
MATRICES = "matrices"
#: distance of a point from its station that gives a caution, m
ASTRAY = 1e-3


def matrices_body(matrices: PortMatrices, scene: Scene) -> Body:
    """Return the body; refuse matrices without a point at a station of the scene."""
    names = [*matrices.positions]
    for station in scene.stations:
        if station.name not in names:
            raise SceneError(
                f"has no point {station.name!r}{nearest(station.name, names)}, where the shaft has "
                f"a bearing, a gear or a spring; there are {listed(names)}",
                where=matrices.source,
            )
    omega, strain = matrices.elastic
    places = [matrices.positions[station.name] for station in scene.stations]
    ports = tuple(
        Port(s.name, float(p[1]), s.attachment, float(p[0]), float(p[2]))
        for s, p in zip(scene.stations, places)
    )
    rows = np.vstack([matrices.ports[port.name].rows for port in ports])
    along = [place[1] for place in matrices.positions.values() for _ in range(6)]
    block = Block(
        "full",
        tuple(range(6)),
        sp.csr_matrix(strain.T @ strain),
        sp.csr_matrix(matrices.mass),
        matrices.rigid(),
        np.r_[along, np.full(matrices.modes, np.nan)],
        sp.csr_matrix(rows),
    )
    scale = float(omega[0]) ** 2
    return Body(MATRICES, (block,), ports, scale, scene.length)


def matrices_facts(train: Train) -> Iterator[str]:
    """Yield a sentence on each shaft with matrices."""
    for side, shaft in train.shafts.items():
        if (matrices := shaft.matrices) is not None:
            yield (
                f"the {side} has matrices of {matrices.rigid_mass[0, 0]:.4g} kg "
                f"({matrices.sentence}), which the model {MATRICES} takes"
            )


def matrices_cautions(side: str, matrices: PortMatrices, scene: Scene) -> list[str]:
    """Return sentences on units of a shaft's matrices, and on points away from their stations."""
    out = [f"matrices of the {side} count in the model {MATRICES} alone"]
    out += [f"matrices of the {side}: {doubt}" for doubt in matrices.doubts]
    for station in scene.stations:
        place = matrices.positions.get(station.name)
        distance = 0.0 if place is None else np.linalg.norm(place - [0.0, station.y, 0.0])
        if distance > ASTRAY:
            out.append(
                f"point {station.name!r} of the matrices of the {side} lies {1e3 * distance:.3g} mm "
                "from that station of the scene"
            )
    return out
