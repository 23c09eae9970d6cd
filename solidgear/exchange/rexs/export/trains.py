"""Trains as REXS documents: shafts in their places, gears, stages, engines, loads, load cases."""

from __future__ import annotations

from typing import Any

import numpy as np

from solidgear.core import Scene
from solidgear.exchange.rexs.document import Component
from solidgear.exchange.rexs.export.gears import (
    add_flanks,
    bevel,
    cylindrical,
    with_mate,
    write_stiffness,
)
from solidgear.exchange.rexs.export.parts import Parts, attribute_of
from solidgear.exchange.rexs.export.planets import SunPlace, add_stage
from solidgear.exchange.rexs.export.shafts import add_points, add_shaft, forces
from solidgear.exchange.rexs.planets import pins_name
from solidgear.exchange.rexs.rest import key_of
from solidgear.trains.assembly.layout import contacts, places, rotor_torques, senses
from solidgear.trains.file.gears import Gear
from solidgear.trains.file.operation import OperatingPoint
from solidgear.trains.file.pairs import Pair
from solidgear.trains.file.planetary import Stage
from solidgear.trains.file.train import Train

#: mass of the sections of a shaft that stands for a machine: none, for its inertia is given
WEIGHTLESS = 0.0


class TrainParts:
    """The document of a train, with the numbers of its components by name."""

    def __init__(self, train: Train) -> None:
        self.train, self.parts = train, Parts()
        self.contacts = contacts(train)
        scenes = {name: shaft.scene for name, shaft in train.shafts.items()}
        self.places = places(train, self.contacts, scenes)
        self.shafts: dict[str, int] = {}
        self.gears: dict[tuple[str, str], int] = {}
        self.rotors: dict[str, int] = {}
        #: numbers of the lumped points without gears, by shaft and name
        self.points: dict[str, int] = {}
        #: components of the load case that is being made
        self.case: dict[int, Component] = {}
        for name, scene in scenes.items():
            axes, origin = self.places[name]
            self.shafts[name] = add_shaft(self.parts, name, scene, origin, axes)
            # a stage that is read makes the point of its pins
            pins = [pins_name(stage.called) for stage in train.stages if stage.shafts[1] == name]
            taken = [*train.shafts[name].gears, *pins]
            points = add_points(self.parts, self.shafts[name], scene, taken)
            self.points |= {f"{name}.{point}": number for point, number in points.items()}
        for pair in train.pairs:
            self._add_pair(pair)
        for stage in train.stages:
            self._add_stage(stage)
        for name in (*train.engines, *train.loads):
            self._add_rotor(name)
        for point in train.operation:
            self._add_case(point)

    def _place(self, shaft: str, y: float) -> np.ndarray:
        axes, origin = self.places[shaft]
        return origin + axes @ np.array([0.0, y, 0.0])

    def _gear(self, shaft: str, port: str) -> Gear:
        return self.train.shafts[shaft].gears[port]

    def _add_gear(
        self,
        shaft: str,
        port: str,
        kind: str,
        pressure_angle: float | None,
        mate: Gear | None = None,
    ) -> int:
        """Add a gear with its flanks at a lumped point, with what its file leaves to its mate; return
        its number.
        """
        if (shaft, port) in self.gears:
            return self.gears[shaft, port]
        gear, scene = self._gear(shaft, port), self.train.shafts[shaft].scene
        if kind == "cylindrical_gear" and mate is not None:
            gear = with_mate(gear, mate)
        place = next(p for p in scene.ports if p.name == port)
        number = self.parts.add(
            kind,
            port,
            self.shafts[shaft],
            **self.parts.frame(self._place(shaft, place.y), self.places[shaft][0]),
            u_coordinate_on_shaft=place.y,
            face_width=gear.face_width or place.hi - place.lo,
            number_of_teeth=gear.teeth,
            mass_of_component=None if gear.head is None else gear.head.mass,
        )
        self.gears[shaft, port] = number
        if kind == "bevel_gear":
            self.parts.write(number, **bevel(gear))
        else:
            self.parts.write(number, **cylindrical(gear))
            add_flanks(self.parts, number, gear, pressure_angle)
        return number

    def _add_pair(self, pair: Pair) -> None:
        """Add a stage of two gears."""
        mesh, parts = pair.mesh, self.parts
        parallel = mesh.shaft_angle == 0
        kind = "cylindrical" if parallel else "bevel"
        ends = [*zip(pair.shafts, pair.ports)]
        gears = [
            self._add_gear(*end, f"{kind}_gear", mesh.pressure_angle, self._gear(*mate))
            for end, mate in zip(ends, reversed(ends))
        ]
        name = key_of({"name": mesh.name, "between": mesh.between}, 0)
        number = parts.add(f"{kind}_stage", name, parts.unit)
        parts.relate("stage", stage=number, gear_1=gears[0], gear_2=gears[1])
        if not parallel:
            parts.write(
                number,
                shaft_angle=mesh.shaft_angle,
                nominal_design_pressure_angle_drive=mesh.pressure_angle,
            )
            return
        spans = [self.parts.components[gear].number("face_width") for gear in gears]
        apart = self._place(pair.shafts[0], 0.0) - self._place(pair.shafts[1], 0.0)
        axis = self.places[pair.shafts[0]][0][:, 1]
        distance = mesh.centre_distance or float(np.linalg.norm(np.cross(axis, apart)))
        parts.write(number, center_distance=distance)
        write_stiffness(parts, number, mesh.stiffness, min(w for w in spans if w))

    def _add_stage(self, stage: Stage) -> None:
        """Add a planetary stage."""
        parts, (shaft, carrier) = self.parts, stage.shafts
        angle = stage.table.mesh.pressure_angle
        gear = self._add_gear(shaft, stage.ports[0], "cylindrical_gear", angle)
        component = parts.components[gear]
        y, carrier_y = (
            next(p.y for p in self.train.shafts[side].scene.ports if p.name == port)
            for side, port in zip(stage.shafts, stage.ports)
        )
        sun = SunPlace(
            gear,
            (self.shafts[shaft], self.shafts[carrier]),
            self._place(shaft, y),
            self.places[shaft][0],
            carrier_y,
            module=component.number("normal_module") or 0.0,
            helix=-(component.number("helix_angle_reference_diameter") or 0.0),
            width=component.number("face_width") or 0.0,
        )
        add_stage(parts, stage, sun)

    def _add_rotor(self, name: str) -> None:
        """Add the machine of an engine or a load: a shaft of its inertia behind a coupling."""
        rotor, parts = self.train.rotors[name], self.parts
        scene = self.train.shafts[rotor.shaft].scene
        y = _spring_at(self.train, name)
        size = 2 * scene.segments[-1].radius_at(scene.segments[-1].y1)[1]
        shaft = parts.add("shaft", name, parts.unit, **parts.frame(
            self._place(rotor.shaft, y), self.places[rotor.shaft][0]
        ))  # fmt: skip
        material = parts.add("material", "without mass", density=WEIGHTLESS)
        parts.relate("reference", origin=shaft, referenced=material)
        parts.add_cylinder(shaft, size, size)
        parts.add(
            "additional_mass",
            name,
            shaft,
            u_coordinate_on_shaft=size / 2,
            moment_of_inertia_u_axis=rotor.inertia,
        )
        coupling = parts.add(
            "coupling",
            f"coupling of {name}",
            u_coordinate_on_shaft_inner_side=y,
            u_coordinate_on_shaft_outer_side=0.0,
            rotational_stiffness=rotor.spring.stiffness,
        )
        parts.relate(
            "side", assembly=coupling, inner_part=self.shafts[rotor.shaft], outer_part=shaft
        )
        self.rotors[name] = parts.add(
            "external_load",
            name,
            shaft,
            u_coordinate_on_shaft=size / 2,
            transmits_torque=True,
            defines_torque=name in self.train.engines[:1],
        )

    def _add_case(self, point: OperatingPoint) -> None:
        """Add an operating point as a load case: torque, speed, share of the time, weight, forces."""
        train, engine = self.train, self.train.engines[0]
        shaft = train.rotors[engine].shaft
        mesh_contacts = contacts(train, point.coast)
        torque = abs(rotor_torques(train, mesh_contacts, point)[engine])
        if point.of == shaft and len(train.engines) == 1:
            torque = abs(point.torque)  # to the bit
        sense = senses(train, mesh_contacts, point.coast)
        ways = {name: 1.0 if way == "+y" else -1.0 for name, way in sense.items()}
        signed = ways[shaft] * torque * (-1.0 if point.coast else 1.0)
        self._write_in_case(self.parts.unit, name=point.name, operating_time_fraction=point.share)
        self._write_in_case(self.rotors[engine], torque_around_u_axis=signed)
        if point.speed is not None:
            speed = ways[point.of] * point.speed
            self._write_in_case(self.shafts[point.of], rotational_speed=speed, defines_speed=True)
        if point.weight is not None:
            self._write_in_case(self.parts.unit, account_for_gravity=True, **_gravity(point.weight))
        for force in point.force:
            if force.at in self.points:
                self._write_in_case(
                    self.points[force.at], **forces(force.model_dump(exclude={"at"}))
                )
        self.parts.add_case(self.case.values())
        self.case = {}

    def _write_in_case(self, number: int, name: str = "", **attributes: Any) -> None:
        """Add attributes to a component in the load case that is being made."""
        component = self.parts.components[number]
        there = self.case.get(number, Component(number, component.type, name or component.name))
        given = {key: attribute_of(key, v) for key, v in attributes.items() if v is not None}
        self.case[number] = there.with_attributes(given)


def _gravity(weight: str) -> dict[str, Any]:
    """Return the direction of weight along u, v, w of the gear unit, which are y, z, x."""
    size = -1.0 if weight.startswith("-") else 1.0
    axes = zip("uvw", "yzx")
    return {f"direction_vector_gravity_{u}": size * (axis == weight[-1]) for u, axis in axes}


def _spring_at(train: Train, name: str) -> float:
    """Return the place of the spring of a rotor along its shaft, m."""
    rotor = train.rotors[name]
    scene: Scene = train.shafts[rotor.shaft].scene
    stations = {s.name: s.y for s in (*scene.ports, *scene.bearings)}
    if rotor.spring.at in stations:
        return stations[rotor.spring.at]
    offset = rotor.spring.position or 0.0
    origin = {"start": 0.0, "end": scene.length}.get(rotor.spring.from_, 0.0)
    return min(max(origin + offset, 0.0), scene.length)
