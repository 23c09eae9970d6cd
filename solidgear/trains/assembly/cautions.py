"""Cautions on the numbers of a train: what its file leaves doubtful, and what its models leave out."""

from __future__ import annotations

from collections.abc import Mapping

from solidgear.core import Scene, number_cautions
from solidgear.trains.assembly.gear_bodies import gear_cautions
from solidgear.trains.assembly.housing import housing_cautions
from solidgear.trains.assembly.layout import Place
from solidgear.trains.assembly.matrices_body import matrices_cautions
from solidgear.trains.assembly.space import overlaps
from solidgear.trains.file.train import Train
from solidgear.trains.load.contact import Contact


def train_cautions(
    train: Train,
    contacts: Mapping[str, Contact],
    scenes: Mapping[str, Scene],
    places: Mapping[str, Place],
    models: Mapping[str, str],
) -> tuple[str, ...]:
    """Return sentences on meshes, teeth whose contact was solved, gears, shafts that take the same
    space, the housing, and on the seats of shafts whose models are given.
    """
    sentences = []
    for name, contact in contacts.items():
        head = f"{name}: " if len(contacts) > 1 else ""
        sentences += [head + text for text in contact.cautions]
    sentences += train.solved_meshes.cautions
    sentences += gear_cautions(train, contacts)
    sentences += map(str, overlaps(train, scenes, places))
    for side, shaft in train.shafts.items():
        if shaft.matrices is not None:
            sentences += matrices_cautions(side, shaft.matrices, scenes[side])
    sentences += housing_cautions(train, places)
    for side, model in models.items():
        head = "" if train.is_one_shaft else f"the {side}: "
        body = model.rpartition("/")[2]  # a lumped shaft rests on it
        sentences += [head + text for text in number_cautions(scenes[side], model=body)]
    return tuple(sentences)
