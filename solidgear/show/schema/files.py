"""Schemas of the files that solidgear reads, one of each kind."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from solidgear.core import SolidgearError, nearest, show
from solidgear.core.registry import added
from solidgear.core.scene.file import SceneFile
from solidgear.core.scene.toml_file import describes_train
from solidgear.show.schema.nodes import Node, also, either
from solidgear.show.schema.tables import of_model

DRAFT = "http://json-schema.org/draft-07/schema#"
#: kinds of files, and what they hold
KINDS = {
    "scene": "one shaft on its bearings",
    "train": "shafts that mesh, with engines and loads",
    "measured": "measured resonances",
}
#: condition on trains: only a carrier of a planetary stage is a shaft without gears
WITHOUT_STAGES: Node = {
    "if": {"not": {"required": ["planetary"]}},
    "then": {
        "properties": {
            "shaft": {
                "additionalProperties": {
                    "anyOf": [{"required": ["gears"]}, {"required": ["teeth"]}]
                }
            }
        }
    },
}
FOLDER = Path(__file__).parent


def path_of(kind: str) -> Path:
    """Return the schema file of a kind of files; refuse a kind that there is not."""
    if kind not in KINDS:
        raise SolidgearError(
            f"files of the kind {show(kind, 40)} have no schema{nearest(kind, KINDS)}; there are "
            f"{', '.join(KINDS)}"
        )
    return FOLDER / f"{kind}.json"


def directive(tables: Mapping[str, Any]) -> str:
    """Return the line of a scene or train file that names its schema on this machine to an editor;
    to everything else it is a comment.
    """
    kind = "train" if describes_train(tables) else "scene"
    return f"#:schema {path_of(kind).resolve().as_uri()}"


def made(kind: str) -> Node:
    """Return the schema of a kind of files, made from the types that read them."""
    if kind == "scene":
        node = of_model(SceneFile)
    elif kind == "train":
        node = either([of_model(model) for model in added("file").values()])
        shafts = {"anyOf": [{"required": ["shaft"]}, {"required": ["pinion", "gear"]}]}
        node = also(node, shafts, WITHOUT_STAGES)
    else:
        node = of_model(added("further file")[kind])
    title = f"solidgear {kind}: {KINDS[kind]}"
    return {"$schema": DRAFT, "title": title, **node, "description": title}


def text_of(schema: Any) -> str:
    """Return a schema as the text of its file."""
    return json.dumps(schema, indent=1, ensure_ascii=False) + "\n"


def write() -> None:
    """Write the schema files of the package from the types."""
    for kind in KINDS:
        path_of(kind).write_text(text_of(made(kind)), encoding="utf-8")
