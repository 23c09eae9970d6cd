"""Rooms of the package from the ground up: each imports those before it, and no other."""

GROUND = {
    "core.errors",
    "core.frames",
    "core.elements",
    "core.factoring",
    "core.quantity",
    "core.springs",
    "core.display",
    "core.plain",
    "core.named",
    "core.machine",
    "core.registry",
    "core.safety",
}
#: rooms of the core: what each may import
CORE = {
    "core.errors": set(),
    "core.elements": set(),
    "core.factoring": set(),
    "core.display": set(),
    "core.plain": set(),
    "core.named": {"core.errors"},
    "core.registry": set(),
    "core.safety": set(),
    "core.frames": {"core.errors"},
    "core.springs": {"core.errors"},
    "core.quantity": {"core.frames"},
    "core.machine": GROUND - {"core.machine"},
}
#: further rooms of the core, from the ground up
CORE_FLOORS = (
    "core.gears",
    "core.scene",
    "core.body",
    "core.meshing",
    "core.solve",
    "core.kernel",
    "core.models",
    "core.bounds",
    "core.ladder",
    "core.loading",
    "core.scene_text",
    "core.arguments",
    "core.reduction",
    "core.system",
    "core.judge",
)
#: how results are shown, then a room a question, then the command line
FEATURES = (
    "show",
    "petsc",
    "parts",
    "cuts",
    "bearings",
    "guards",
    "trains",
    "strength",
    "teeth",
    "exchange",
    "variants",
    "measured",
    "backlash",
    "datasheet",
    "comparison",
    "app",
)


def room_of(module: str) -> str:
    """Return the room of a module: of the core its part, else the first name below the package."""
    names = module.split(".")[1:]
    return ".".join(names[:2]) if names[:1] == ["core"] else ".".join(names[:1])


def floors() -> dict[str, set[str]]:
    """Return for each room the rooms that it may import."""
    below = dict(CORE)
    for room in (*CORE_FLOORS, *FEATURES):
        below[room] = {*below}
    return below


MAY_IMPORT = floors()
