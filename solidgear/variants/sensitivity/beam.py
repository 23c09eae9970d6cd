"""Derivatives of a beam by shape and material, with the same elements, moved.

The derivatives of numbers by nodes, seats and segments are gathered once from the energies of
elements and then multiplied with the velocities of any number of parameters. Derivatives of an
element by shape and material are imaginary parts (:mod:`solidgear.core.models.beam.element`), exact to
rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from solidgear.core import Body, Scene, SolidgearError
from solidgear.core.models.beam.body import (
    matrices,
    pieces,
    port_rows,
    seat,
    softened,
    softening,
    unknowns,
)
from solidgear.core.models.beam.element import MATTER, SHAPE, Elements, Section, owners
from solidgear.core.models.beam.shoulder import hinges
from solidgear.core.scene.shaft import attached_stations
from solidgear.variants.sensitivity.adjoint import (
    SEAT,
    Form,
    in_plane,
    line_velocities,
    rates,
    shared_blocks,
)

#: imaginary step: its square is negligible beside 1
STEP = 1e-30
#: places of seats that nodes follow
FOLLOWED = {"section": ("y",), "rigid": ("lo", "hi"), "average": ()}
HINGE = ("bend", "stretch", "twist")


class BeamAdjoint:
    """Derivatives of numbers of a beam, each array (..., forms)."""

    velocity: np.ndarray  #: (n,) of the nodes, at the last call of :meth:`by`

    def __init__(self, scene, body: Body, forms: Sequence[Form]):
        self.scene, self.body = scene, body
        self.places = body.geometry.nodes  # type: ignore[union-attr]
        self.stations = [*attached_stations(scene.stations)]
        self.owner = owners(scene.segments, self.places)
        self.elements = Elements.of(scene.segments, self.places)
        self.hinges = hinges(scene.segments) if body.mesh["shoulder"] else ()
        self.soft = softening(self.places, self.hinges)
        f, s = len(forms), len(scene.segments)
        #: by places of nodes, which follow the ends of segments, rigid seats and sections
        self.nodes = np.zeros((len(self.places), f))
        self.segments, self.materials = np.zeros((s, len(SHAPE), f)), np.zeros((s, len(MATTER), f))
        self.seats = np.zeros((len(self.stations), len(SEAT), f))
        self.steps = np.zeros((len(self.hinges), len(HINGE), f))  # compliances of shoulders
        by_family = self._matrices(self.elements, self.soft)
        self.shape = {name: part[2] for name, part in by_family.items()}
        self.dofs = unknowns(by_family, len(self.places))
        families = self._families(forms)
        for family in families:
            self._tied(family, by_family)
        self._gather(families)

    def _matrices(self, elements: Elements, soft: np.ndarray):
        """Return stiffness, mass and fields of elements with the options of the body, by family."""
        facts = self.body.mesh
        section = Section(elements, facts["head"], facts["kappa"])
        if self.hinges:
            section.soften(*soft)
        shear = facts["element"] == "timoshenko"
        return matrices(section, shear, facts["rotary_inertia"], facts["mass"])

    def _families(self, forms: Sequence[Form]) -> list[_Family]:
        pairs: dict[str, list] = {}
        for k, form in enumerate(forms):
            for pair in form.pairs:
                for index, shapes in shared_blocks(self.body, pair):
                    states = [
                        (u, *(in_plane(self.body, index, six) for six in (s.forces, s.motions)))
                        for s, u in zip(pair, shapes)
                    ]
                    name = self.body.block(index).name.partition("_")[0]
                    pairs.setdefault(name, []).append((k, form.scale, pair[0].eigenvalue, *states))
        return [_Family(name, members, len(forms)) for name, members in pairs.items()]

    def _gather(self, families: list[_Family]) -> None:
        """Gather the derivatives from all elements and seats, once for each of their fields, with
        an imaginary step in it.
        """
        element_names = [field.name for field in fields(Elements)]
        names = [*element_names, *(HINGE if self.hinges else ()), *SEAT]
        rows, count = len(names), len(self.owner)

        def stepped(values: np.ndarray | float, name: str) -> np.ndarray:
            """Return (rows, e) values; those in the row of the name take the step."""
            step = 1j * STEP * (np.array(names) == name)
            return np.atleast_1d(values) + step[:, None]

        elements = Elements(
            **{n: stepped(getattr(self.elements, n), n).ravel() for n in element_names}
        )
        soft = np.array([stepped(part, n).ravel() for part, n in zip(self.soft, HINGE)])
        by_family = {
            kind: [part.reshape(rows, count, *part.shape[1:]) for part in parts]
            for kind, parts in self._matrices(elements, soft).items()
        }
        rates = np.zeros((rows, count, self.nodes.shape[1]))
        for family in families:
            rates += family.energy(by_family[family.name], self.dofs[family.name])
        for p, (station, how) in enumerate(self.stations):
            if how != "average":
                continue
            under, lo, hi = pieces(self.elements, station)
            begin = stepped(self.elements.left[under], "left")
            end = stepped(self.elements.right[under], "right")
            # inside the seat its pieces end where elements do
            begin[:, 0], end[:, -1] = stepped(lo[0], "lo")[:, 0], stepped(hi[-1], "hi")[:, 0]
            places = (np.arange(rows)[:, None] * count + under).ravel()
            shape = {
                kind: parts[2][:, under].reshape(len(places), *parts[2].shape[2:])
                for kind, parts in by_family.items()
            }
            y = np.repeat(stepped(station.y, "y"), len(under), axis=0)
            terms = seat(elements.only(places), shape, begin.ravel(), end.ravel(), y)
            for family in families:
                gram, row = (t.reshape(rows, len(under), *t.shape[1:]) for t in terms[family.name])
                seat_rates = family.port(p, gram, row, self.dofs[family.name][under])
                rates[:, under] += seat_rates
                self.seats[p] += seat_rates[-len(SEAT) :].sum(axis=1)
        for name, element_rates in zip(names, rates):
            self._add(name, element_rates)

    def _add(self, name: str, rates: np.ndarray) -> None:
        """Add (e, forms) derivatives by a field of elements to the node, segment or step it is of."""
        if name == "left":
            self.nodes[:-1] += rates
        elif name == "right":
            self.nodes[1:] += rates
        elif name in SHAPE:
            np.add.at(self.segments[:, SHAPE.index(name)], self.owner, rates)
        elif name in MATTER:
            np.add.at(self.materials[:, MATTER.index(name)], self.owner, rates)
        elif name in HINGE:
            for k, step in enumerate(self.hinges):
                self.steps[k, HINGE.index(name)] += rates[softened(self.places, step)]

    def _tied(self, family: _Family, by_family) -> None:
        """Add derivatives by rigid seats, which take their nodes along as they lie about the port."""
        if family.name != "bending" or all(how != "rigid" for _, how in self.stations):
            return
        stiff, heavy, _ = by_family["bending"]
        dofs = self.dofs["bending"]
        size = {name: int(part.max()) + 1 for name, part in self.dofs.items()}
        rows = [
            port_rows(station, how, self.elements, self.shape, self.dofs, size)["bending"]
            for station, how in self.stations
        ]
        for i, j in ((0, 1), (1, 0)):
            u, forces = family.u[i], family.forces[i]
            pull = np.zeros_like(u)
            local = stiff @ u[dofs] - family.eigenvalue * (heavy @ u[dofs])
            np.add.at(pull, dofs, local)
            for row, force in zip(rows, forces.transpose(1, 2, 0)):
                pull -= row.T @ force
            for p, (station, how) in enumerate(self.stations):
                if how != "rigid":
                    continue
                tol = 1e-9 * self.places[-1]
                inside = np.flatnonzero(
                    (self.places > station.lo - tol) & (self.places < station.hi + tol)
                )
                rates = family.sums(-family.scale * pull[2 * inside] * family.motions[j][:, p, 1])
                self.nodes[inside] += rates
                self.seats[p, 0] -= rates.sum(axis=0)

    def by(self, low: Scene, high: Scene, step: float) -> np.ndarray:
        """Compute the derivatives (f,) along the way from one scene to another; refuse a shaft that
        takes another form, and places of one line that move apart.
        """
        segments = rates(low.segments, high.segments, SHAPE, step)
        seats = rates(low.stations, high.stations, SEAT, step)
        before, after = ([s.material for s in scene.segments] for scene in (low, high))
        matter = rates(before, after, MATTER, step)
        out = np.einsum("sk,skf->f", segments, self.segments)
        out += np.einsum("sk,skf->f", matter, self.materials)
        out += np.einsum("pk,pkf->f", seats, self.seats)
        if self.body.mesh["shoulder"]:
            bends = rates(hinges(low.segments), hinges(high.segments), HINGE, step)
            if len(bends) != len(self.hinges):
                raise SolidgearError("a step opens there, with another derivative to either side")
            out += np.einsum("hk,hkf->f", bends.reshape(-1, len(HINGE)), self.steps)
        lines, moved = line_velocities(self.scene, self.stations, segments, seats, FOLLOWED)
        self.velocity = np.interp(self.places, lines, moved)
        return out + self.velocity @ self.nodes


class _Family:
    """Pairs of states in the blocks of one family of motion."""

    def __init__(self, name: str, pairs: list, forms: int):
        self.name = name
        form, scale, eigenvalue, first, second = zip(*pairs)
        self.scale, self.eigenvalue = np.array(scale), np.array(eigenvalue)
        self.owner = np.eye(forms)[list(form)]
        sides = [[np.array(part) for part in zip(*side)] for side in (first, second)]
        # of both states: (n, pairs) unknowns, (pairs, p, c) forces and motions of ports
        self.u = [side[0].T for side in sides]
        self.forces, self.motions = [side[1] for side in sides], [side[2] for side in sides]

    def sums(self, values: np.ndarray) -> np.ndarray:
        """Return the sums (..., forms) over the pairs of each form."""
        return values @ self.owner

    def energy(self, element_matrices, dofs: np.ndarray) -> np.ndarray:
        """Compute the derivatives (..., e, forms) from elements with an imaginary step in them."""
        stiff, heavy = (part.imag / STEP for part in element_matrices[:2])
        u, v = (states[dofs] for states in self.u)
        rates = (u * (self.eigenvalue * (heavy @ v) - stiff @ v)).sum(axis=-2)
        return self.sums(self.scale * rates)

    def port(self, p: int, gram: np.ndarray, rows: np.ndarray, dofs: np.ndarray) -> np.ndarray:
        """Compute the derivatives (..., k, forms) from the pieces of a seat with an imaginary step
        in them.
        """
        seat_gram = gram[0].sum(axis=0).real
        gram, rows = gram.imag / STEP, rows.imag / STEP
        total = np.zeros((*rows.shape[:2], len(self.scale)))
        for i, j in ((0, 1), (1, 0)):
            force = np.linalg.solve(seat_gram, self.forces[i][:, p].T)
            moved = rows @ self.u[j][dofs] - gram @ self.motions[j][:, p].T
            total += (moved * force).sum(axis=-2)
        return self.sums(self.scale * total)
