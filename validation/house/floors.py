"""Rooms of the package from the ground up, and what each may import."""

GROUND = {"errors", "elements", "factoring", "frames", "display", "quantity", "springs"}

#: room: what it may import, from the ground up
MAY_IMPORT = {
    "errors": set(),
    "frames": {"errors"},
    "factoring": set(),
    "elements": set(),
    "springs": {"errors"},
    "display": set(),
    "quantity": {"frames"},
    "machine": GROUND,
    "scene": GROUND,
    "body": GROUND,
    "meshing": GROUND | {"machine", "scene"},
    "solve": GROUND | {"machine", "body"},
    "kernel": GROUND | {"machine", "body", "meshing"},
    "models": GROUND | {"machine", "scene", "body", "meshing", "solve", "kernel"},
    "bounds": GROUND | {"scene", "body", "meshing", "solve", "kernel", "models"},
    "ladder": GROUND | {"machine", "scene", "meshing", "solve", "kernel", "models", "bounds"},
    "reduction": GROUND | {"machine", "body", "solve"},
    "bearings": GROUND | {"scene", "body", "solve"},
    "system": GROUND | {"machine", "scene", "body", "reduction", "bearings"},
    "nonlinear": GROUND | {"machine", "system"},
    "judge": GROUND
    | {"machine", "scene", "body", "meshing", "solve", "models", "bounds", "ladder", "reduction"},
    "report": GROUND | {"machine", "body", "judge"},
    "studies": GROUND
    | {"machine", "scene", "body", "meshing", "solve", "models", "bounds", "ladder", "reduction"}
    | {"kernel", "bearings", "system", "nonlinear", "judge", "report"},
}
