"""Orders of magnitude in the data of a train that a slip in units leaves."""

from __future__ import annotations

from solidgear.core import build
from solidgear.guards import data
from solidgear.guards.notice import slip_in_units
from solidgear.guards.probe import Probe
from solidgear.trains.assembly.assembly import Assembly
from solidgear.trains.file.planetary import PlanetMesh

#: model of shafts, whose data are all that counts
SHAFT = "timoshenko"
#: ranges that a slip of 1000 in the data of a mesh leaves: ISO 6336 puts some 20 N/(mm um) into a steel
#: mesh, 0.1 of E times the face width, and a face is 0.1 to 3 lever arms wide; errors of teeth are
#: some thousandths of the module at most, and no gear is ground to 1e-5 of it
SOUND = {
    "mesh stiffness over E r": (1e-3, 2.0),
    "transmission error over 2 r / z": (1e-5, 0.05),
}


def unit_slips(assembly: Assembly) -> tuple[str, ...]:
    """Return sentences on meshes and shafts; none where every number can be true.

    Examples
    --------
    >>> import solidgear as sg
    >>> train = sg.load_train("geometry/axle_overhung.toml")
    >>> unit_slips(Assembly(train))
    ()
    >>> soft = train.with_changes(mesh=train.mesh.with_changes(stiffness=2.5e5))
    >>> unit_slips(Assembly(soft))[0][:59]
    'probably a wrong unit: mesh stiffness over E r is 2.73e-05,'
    """
    out = mesh_unit_slips(assembly)
    for side in assembly.scenes:
        scene = assembly.scenes[side].plain
        probe = Probe(scene, build(scene, SHAFT))
        out += [f"{side}: {notice.sentence}" for notice in data.units(probe)]
    return tuple(out)


def mesh_unit_slips(assembly: Assembly) -> list[str]:
    """Return sentences on the stiffness and the transmission error of meshes; none where all are
    sound.
    """
    out = []
    stiff = max(s.material.E for scene in assembly.scenes.values() for s in scene.segments)
    for pair in assembly.train.drivers:
        if isinstance(pair, PlanetMesh):
            lever, teeth = pair.stage.teeth.base_radii[0], pair.stage.teeth.sun
            stiffness = pair.stiffness
        else:
            contact, teeth = assembly.contacts[pair.name], pair.pinion.teeth
            lever, stiffness = abs(contact.pinion.lever), contact.stiffness
        table = pair.mesh.transmission_error
        error = max((*table.orders, *table.amplitude), default=0.0) if table else 0.0
        values = stiffness / (stiff * lever), error * teeth / (2 * lever)
        rows = [(name, value, "") for name, value in zip(SOUND, values)]
        if not error:
            rows.pop()  # zero has a caution elsewhere, and without an error there is nothing to check
        legend = f"r: lever arm of the pinion, {1e3 * lever:.4g} mm; z: its {teeth} teeth"
        if sentence := slip_in_units(rows, SOUND, legend):
            out.append(f"{pair.name}: {sentence}" if pair.label else sentence)
    return out
