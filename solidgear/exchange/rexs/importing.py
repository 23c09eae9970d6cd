"""From a REXS document to the files of a train and its shafts."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from solidgear.exchange.rexs.commented import toml_of, wrapped
from solidgear.exchange.rexs.document import Component, Document
from solidgear.exchange.rexs.drive import cases_of, coupled_to, drive_of, ordered, turns_from
from solidgear.exchange.rexs.gearbox import Gearbox, couplings_of, gearbox_of
from solidgear.exchange.rexs.gears import gear_table, mesh_table
from solidgear.exchange.rexs.notes import Notes, unread
from solidgear.exchange.rexs.planets import stage_table
from solidgear.exchange.rexs.profile_shifts import fill_shifts
from solidgear.exchange.rexs.rest import read_rest, restored
from solidgear.exchange.rexs.running import load_table, operation_tables, rotor_tables
from solidgear.exchange.rexs.scenes import scene_table
from solidgear.exchange.rexs.shafts import LONGEST, Shaft, plain_name


@dataclass(frozen=True)
class Imported:
    """Files of a gearbox by name, the train first where there is one, and what is to be known."""

    files: dict[str, str]
    tables: dict[str, Any]  #: of each file, with the source of each value
    notes: Notes
    facts: tuple[str, ...]
    has_train: bool = True
    paths: tuple[Path, ...] = ()  #: of the files, where they are written

    def lying_in(self, folder: Path) -> Imported:
        """Return the same with the paths of its files in a folder."""
        return replace(self, paths=tuple(folder / name for name in self.files))


def imported(document: Document, name: str) -> Imported:
    """Return the files of a train and its shafts from a document.

    Parameters
    ----------
    document : Document
    name : str
        Of the train: its file is called so.

    Raises
    ------
    RexsError
        What no train can be made of, in a sentence.
    """
    notes = Notes()
    gearbox = gearbox_of(document, notes)
    for label, reason in unread(document):
        notes.drop(label, reason)
    shafts = _in_train(gearbox)
    fill_shifts(gearbox)
    cases = cases_of(gearbox)
    drive = drive_of(gearbox, cases) if shafts else None
    files: dict[str, Any] = {}
    loads: dict[int, str] = {}
    for shaft in [*shafts, *_alone(gearbox, shafts)]:
        tables, ports = scene_table(gearbox, shaft, cases, drive)
        loads |= ports
        if (
            document.is_ours
            and not shafts
            and (load := load_table(gearbox, shaft, cases[0], ports))
        ):
            tables["load"] = load
        files[f"{shaft.name}.toml"] = tables
    if document.is_ours:
        # what stands in place of what REXS has not is replaced by what the file had
        notes.assumed.clear()
        notes.contradictory.clear()
    _restore_shafts(gearbox, files)
    head = [f"Made from REXS {document.version} of {document.header.get('applicationId', '?')}."]
    if not shafts:
        texts = {file: toml_of(tables, head) for file, tables in files.items()}
        return Imported(texts, files, notes, ("no stage: shafts alone",), False)
    flanks = ordered(gearbox, drive)
    has_torque = drive is not None and drive.engine_sign != 0
    train: dict[str, Any] = {"title": name, "source": head[0]}
    train["shaft"] = _shaft_tables(gearbox, shafts, flanks)
    if flanks:
        train["mesh"] = [mesh_table(gearbox, stage, has_torque) for stage, _ in flanks]
    if gearbox.planetary:
        train["planetary"] = {
            stage.name: stage_table(gearbox, stage, has_torque) for stage in gearbox.planetary
        }
    if drive is not None:
        train |= rotor_tables(gearbox, drive, cases, loads)
        if has_torque:
            train["operation"] = operation_tables(gearbox, drive, cases, loads)
    if not document.is_ours:
        notes.ask(
            "the transmission_error of every mesh, which response needs: no file of REXS has it"
        )
    if document.is_ours:
        notes.assumed.clear()  # as above, of the tables since
        notes.unknown.clear()
    for unit in document.of_kind("gear_unit"):
        train = _restored(gearbox, train, unit)
    train_file = f"{name}.toml"
    if train_file in files:
        train_file = f"{name}_train.toml"
    texts = {train_file: toml_of(train, [*head, *_head(notes)])}
    texts |= {file: toml_of(tables, head) for file, tables in files.items()}
    return Imported(texts, {train_file: train} | files, notes, _facts(gearbox, shafts))


def _restored(gearbox: Gearbox, tables: dict[str, Any], component: Component) -> dict[str, Any]:
    """Return tables with what the rest of a component says of them."""

    def doubt(reason: str) -> None:
        gearbox.notes.doubt(component, reason)

    return restored(tables, read_rest(component), doubt)


def _restore_shafts(gearbox: Gearbox, files: dict[str, Any]) -> None:
    """Put what REXS has no place for into the scenes."""
    for shaft in gearbox.shafts.values():
        if (scene := files.get(f"{shaft.name}.toml")) is not None:
            files[f"{shaft.name}.toml"] = _restored(gearbox, scene, shaft.component)


def _shaft_tables(
    gearbox: Gearbox, shafts: Collection[Shaft], flanks: list[tuple[Any, str]]
) -> dict[str, Any]:
    sides = {stage.gears[0].component.id: flank for stage, flank in flanks}
    out: dict[str, Any] = {}
    for shaft in shafts:
        table: dict[str, Any] = {"scene": f"{shaft.name}.toml"}
        gears = {
            gear.name: gear_table(gearbox, gear, sides.get(gear.component.id, ""))
            for gear in gearbox.gears.values()
            if gear.shaft is shaft and _meshes(gearbox, gear.component)
        }
        out[shaft.name] = table | ({"gears": gears} if gears else {})
    return out


def _meshes(gearbox: Gearbox, gear: Component) -> bool:
    """Return True for a gear in a stage of the train."""
    pairs = [g.component for stage in gearbox.pairs for g in stage.gears]
    return gear in pairs or gear in [stage.sun.component for stage in gearbox.planetary]


def _in_train(gearbox: Gearbox) -> list[Shaft]:
    """Return the shafts of the largest group that teeth join, in the order of the file; the stages of
    other groups are left out.
    """
    notes = gearbox.notes
    groups: list[dict[int, float]] = []
    for first, _ in gearbox.joined:
        if not any(first.component.id in group for group in groups):
            groups.append(turns_from(gearbox, first))
    if not groups:
        return []
    group = max(groups, key=len)
    for stage in gearbox.pairs:
        if stage.gears[0].shaft.component.id not in group:
            notes.drop(stage.component, "no teeth lead from the rest of the train to it")
    for planets in gearbox.planetary:
        if planets.carrier.component.id not in group:
            notes.drop(planets.component, "no teeth lead from the rest of the train to it")
    gearbox.pairs = [s for s in gearbox.pairs if s.gears[0].shaft.component.id in group]
    gearbox.planetary = [s for s in gearbox.planetary if s.carrier.component.id in group]
    _note_others(gearbox, group)
    return [shaft for number, shaft in gearbox.shafts.items() if number in group]


def _alone(gearbox: Gearbox, shafts: Collection[Shaft]) -> list[Shaft]:
    """Return the shafts that no teeth of the train lead to, and no stage has in itself."""
    inside = _inside(gearbox, [shaft.component.id for shaft in shafts])
    return [shaft for number, shaft in gearbox.shafts.items() if number not in inside]


def _inside(gearbox: Gearbox, group: Collection[int]) -> set[int]:
    """Return the numbers of the shafts of a train, with those that are parts of its stages."""
    inside = {*group}
    for stage in gearbox.planetary:
        inside |= {part.id for part in stage.carrier_parts}
        inside |= {shaft.component.id for shaft in stage.pins}
        inside |= {planet.shaft.component.id for planet in stage.planets}
        ring = gearbox.document.whole_of(stage.ring, "shaft")
        inside |= {ring.id} if ring is not None else set()
    for number, shaft in gearbox.shafts.items():
        loads = gearbox.document.parts_of(shaft.component, "external_load")
        if number not in inside and loads and coupled_to(gearbox, shaft, {*group}) is not None:
            inside.add(number)
    return inside


def _note_others(gearbox: Gearbox, group: Collection[int]) -> None:
    """Note shafts and couplings that no train has."""
    inside = _inside(gearbox, group)
    for number, shaft in gearbox.shafts.items():
        if number not in inside:
            gearbox.notes.drop(
                shaft.component, "no teeth of the train lead to it: its scene stands alone"
            )
            continue
        for coupling, other in couplings_of(gearbox.document, shaft.component):
            if other.id not in inside and other.kind != "gear_casing":
                gearbox.notes.drop(coupling, f"joins {shaft.component.label} to {other.label}")


def _head(notes: Notes) -> list[str]:
    lines: list[str] = []
    for heading, entries in notes.groups:
        lines += ["", f"{heading}:"]
        lines += [line for entry in entries for line in wrapped(entry)]
    return lines


def _facts(gearbox: Gearbox, shafts: Collection[Shaft]) -> tuple[str, ...]:
    sections = sum(len(shaft.sections) for shaft in shafts)
    gears = {g.component.id for stage in gearbox.pairs for g in stage.gears}
    facts = [f"{len(shafts)} shafts of {sections} sections"]
    if gears:
        stages = (
            "1 cylindrical stage"
            if len(gearbox.pairs) == 1
            else f"{len(gearbox.pairs)} cylindrical stages"
        )
        facts.append(f"{stages} of {len(gears)} gears")
    facts += [f"planetary stage of {len(stage.planets)} planets" for stage in gearbox.planetary]
    return (", ".join(facts),)


def name_of(path: Path) -> str:
    """Return the name of a train from the name of a file."""
    name = path.name
    for suffix in (".zip", ".rexsz", ".rexsj", ".rexs", ".xml", ".json"):
        name = name.removesuffix(suffix)
    return plain_name(name, (), "gearbox", 2 * LONGEST)
