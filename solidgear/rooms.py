"""Additions to the core by the rooms of features.

A further kind of cut, mesh, back end or file is a line here; :mod:`solidgear.core.registry` imports
it when it is first needed.
"""

from __future__ import annotations

from solidgear.core.registry import register

#: kind of addition: its names, each with module and attribute below :mod:`solidgear`
ADDITIONS = {
    # tables of a scene file
    "feature": {
        "keyway": "cuts.features.keyway:Keyway",
        "flat": "cuts.features.flat:Flat",
        "cross_hole": "cuts.features.cross_hole:CrossHole",
        "teeth": "cuts.features.toothed:Teeth",
        "spline": "cuts.features.toothed:Spline",
        "bolt_circle": "cuts.features.bolt_circle:BoltCircle",
        "ring_groove": "cuts.features.grooves:RingGroove",
        "round_groove": "cuts.features.grooves:RoundGroove",
        "v_groove": "cuts.features.grooves:VGroove",
        "relief": "cuts.features.relief:Relief",
        "thread": "cuts.features.thread:Thread",
        "press_fit": "cuts.features.press_fit:PressFit",
    },
    "table": {
        "catalogue": "bearings.catalogue:Catalogue",
        "arrangement": "bearings.arrangement:Pairs",
        "list of bearings": "bearings.scene_list:complete",
        "body": "parts.table:Parts",
    },
    "file": {
        "long train": "trains.file.reading:LongFile",
        "short train": "trains.file.reading:ShortFile",
    },
    "further file": {"measured": "measured.data:Measured"},
    # rules and questions of features
    "rule of features": {"meeting": "cuts.features.around:meeting_problems"},
    "question of features": {
        "mirror plane": "cuts.solid.cuts:mirror_plane",
        "fine lines": "cuts.solid.cuts:fine_lines",
        "no sector": "cuts.sector.body:no_sector",
        "not together": "cuts.sector.body:not_together",
        "mass": "cuts.features.mass:mass_beside",
    },
    # models and bodies
    "model": {
        "corrected": "cuts.corrected.model:Corrected",
        "sector": "cuts.sector.model:Sector",
    },
    "bounds": {"corrected": "cuts.corrected.bounds:corrected_bounds"},
    "solid body": {
        "block": "parts.rectangular:block_body",
        "part": "parts.part_body:part_body",
        "cut": "cuts.solid.featured:cut_body",
        "cyclic": "cuts.sector.body:whole",
    },
    "solid mesh": {
        "block": "parts.rectangular:block_mesh",
        "cyclic": "cuts.sector.body:whole_mesh",
    },
    "solid size": {"cut": "cuts.solid.featured:cut_size_of"},
    # reading a file, and writing what reads back equal
    "document": {
        "read scene": "core.loading:scene_of",
        "write scene": "core.scene.writing:tables_of",
        "resolved scene": "core.scene.resolved:resolved",
        "text of scene": "core.scene_text:toml_of",
        "text of train": "trains.file.text:toml_of",
        "segment of words": "core.scene.shapes:segment_of",
        "settle scene": "core.loading:settled",
        "read train": "trains.loading:load_train",
        "write train": "trains.file.writing:tables_of",
    },
    "settling": {
        "solved": "bearings.solved:solved",
        "wants equilibrium": "bearings.solved:wants_equilibrium",
    },
    # remarks beside the numbers of one shaft
    "remark": {
        "numbers": "core.judge.cautions:number_cautions",
        "cautions": "guards.check:cautions",
        "open ranges": "variants.budget.budget:beside",
        "open numbers": "variants.budget.budget:opened",
        "seats": "bearings.fit:misfits",
        "directions": "guards.data:facing_one_way",
    },
    # guards on what a room adds to a shaft
    "guard": {"bearing_fit": "bearings.fit:bearing_fit"},
    "notices of features": {"smeared teeth": "cuts.sector.smearing:smearing"},
    # what commands of one shaft do with other files, and what they write beside
    "check": {"train": "trains.judge.check:check_source"},
    "compare": {
        "train": "trains.judge.study:judge",
        "file of a train": "trains.judge.command:compare_train",
        "two designs": "two_designs.study:beside",
        "two files": "two_designs.command:compare_two",
    },
    "chart": {"budget": "variants.budget.chart:of_record"},
    "sheet": {
        "languages": "datasheet.messages:LANGUAGES",
        "of a record": "datasheet.recorded:recorded_sheet",
        "of a train": "datasheet.study:sheet",
    },
    # numbers of a train that another room computes
    "mesh stiffness": {
        "teeth": "teeth.train_teeth:TeethOfTrain",
    },
    # what commands print as JSON
    "printed": {
        "answer": "app.printed:ANSWER",
        "modes": "app.printed:MODES",
        "stiffness": "app.printed:STIFFNESS",
        "compare": "app.printed:COMPARE",
        "check": "guards.printed:CHECK",
        "chart": "comparison.printed:CHART",
        "bearing": "bearings.printed:BEARING",
        "stress": "strength.printed:STRESS",
        "deflect": "strength.printed:DEFLECT",
        "sweep": "variants.printed:SWEEP",
        "sensitivities": "variants.printed:SENSITIVITIES",
        "optimise": "variants.printed:OPTIMISE",
        "budget": "variants.printed:BUDGET",
        "correlate": "measured.printed:CORRELATE",
        "identify": "measured.printed:IDENTIFY",
        "system-modes": "trains.printed:SYSTEM_MODES",
        "response": "trains.printed:RESPONSE",
        "receptance": "trains.printed:RECEPTANCE",
        "judge-system": "trains.printed:COMPARISON",
        "nonlinear": "backlash.printed:NONLINEAR",
        "contact": "teeth.printed:CONTACT",
        "sheet": "datasheet.printed:SHEET",
        "export": "exchange.printed:EXPORT",
        "import": "exchange.printed:IMPORT",
    },
    "printed by compare": {
        "train": "trains.printed:COMPARISON",
        "two designs": "two_designs.printed:TWO",
    },
    # matrices of other programs
    "matrices": {
        "read": "exchange.matrices.formats:read_matrices",
        "write": "exchange.matrices.formats:write_matrices",
    },
    # solvers
    "back end": {"mumps": "petsc.mumps:Mumps"},
    "engine": {"ranks": "petsc.solver:plan_on_ranks"},
}

for kind, names in ADDITIONS.items():
    for name, place in names.items():
        register(kind, name, f"solidgear.{place}")
