"""Check of a scene: mass against the closed form, free body free, and every guard on the scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from solidgear.core import (
    BEAM,
    LADDER,
    Body,
    Outline,
    Sheeted,
    SolidgearError,
    Solution,
    listed,
    pinned,
    without_axis,
)
from solidgear.core.judge.effort import heavy_meshes
from solidgear.core.judge.record import GuardRecord
from solidgear.core.ladder.model import LUMPED, SOLID
from solidgear.core.plain import plain
from solidgear.core.registry import added
from solidgear.core.scene.closed_form import mass_properties, whole_mass
from solidgear.core.scene.own_mass import beside, mass_with_masses, own_mass
from solidgear.core.scene.shaft import feature_labels, resolved
from solidgear.guards.details import details
from solidgear.guards.notice import LEVELS, Notice, Notices, beams, everything
from solidgear.guards.probe import Probe
from solidgear.guards.registry import GUARDS
from solidgear.guards.round_part import against_the_part, described, of_files

if TYPE_CHECKING:
    from solidgear.core import Scene

#: verdict on a model by the worst level of its notices
VERDICTS = {
    "fact": "holds",
    "caution": "holds with caution",
    "open": "uncertain",
    "avoid": "will not hold",
    "fault": "will not hold",
}
#: verdicts from the best to the worst
BEST = tuple(dict.fromkeys(VERDICTS.values()))
#: relative error of the mass beside arcs, which coarse elements follow to their order
FOLLOWED = 1e-6
#: guards whose answer a comparison finds itself, or that do not concern models
NOT_IN_COMPARISONS = (
    "beam_against_solid",
    "lumped_against_solid",
    "rigid_seats",
    "memory",
    "renderer",
    "spin",
    "seats_on_joints",
)
#: guards that compare beams and lumped models with a light solid
COMPARES = ("beam_against_solid", "lumped_against_solid")
#: guards on other models than a body, on the machine, or on what commands say beside the frequencies
#: that they show
NOT_HEARD_ALONE = (
    "rigid_seats",
    "memory",
    "renderer",
    "effective_mass",
    "lumped_against_solid",
    "frequency_range",
    "doubtful_data",
    "spin",
    "seats_on_joints",
)
#: guards on the mesh of one solid
OF_A_MESH = (
    "linear_elements",
    "hexahedra_at_fillets",
    "nearly_incompressible",
    "uniform_at_shoulder",
)
#: guards on what is lumped
OF_A_POINT = ("effective_mass", "lumped_against_solid", "frequency_range")
#: guards on a body without an axis too
OF_ANY_BODY = ("linear_elements", "nearly_incompressible")


@dataclass(frozen=True)
class Verdict:
    """Verdict on a model."""

    verdict: str  #: of ``VERDICTS``
    reasons: tuple[str, ...] = ()  #: names of guards, or of shafts of a train


@dataclass(frozen=True, repr=False)
class Check(Sheeted):
    """Check of a shaft, or of a train with the checks of its shafts."""

    sheeted: ClassVar[str] = "guards.sheet:check_sheet"

    name: str
    records: tuple[GuardRecord, ...]  #: what every guard says
    verdicts: dict[str, Verdict]  #: by model
    shafts: dict[str, Check] = field(default_factory=dict)  #: of a train

    @property
    def facts(self) -> list[str]:
        """Sentences that are good to know."""
        return self._sentences("fact")

    @property
    def cautions(self) -> list[str]:
        """Sentences on what will not hold as well as one might think."""
        return self._sentences("caution", "open", "avoid")

    @property
    def faults(self) -> list[str]:
        """Sentences on what must not be used."""
        return self._sentences("fault")

    def _sentences(self, *levels: str) -> list[str]:
        return [record.sentence for record in self.records if record.level in levels]

    @property
    def faulty(self) -> bool:
        """True for a fault, of a train also in one of its shafts."""
        return bool(self.faults) or any(check.faulty for check in self.shafts.values())

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        parts: dict[str, Any] = {side: check.as_dict() for side, check in self.shafts.items()}
        reasons = "shafts" if parts else "guards"
        verdicts = {
            model: {"verdict": verdict.verdict, reasons: verdict.reasons}
            for model, verdict in self.verdicts.items()
        }
        sentences = {"facts": self.facts, "cautions": self.cautions, "faults": self.faults}
        return plain(sentences | (parts or {"records": self.records}) | {"verdicts": verdicts})


@pinned
def check_scene(scene: Scene, body: Body, probe: Probe | None = None) -> Check:
    """Check a scene by every guard, with a verdict on each model.

    Parameters
    ----------
    body : Body
        The model asked for; the mesh is compared with the closed form.
    probe : Probe, optional
        Of the plain part of the scene and that body, for solutions that it has or will have.
    """
    probe = probe or Probe(scene.plain, body, whole=scene)
    free = without_axis(scene)
    by_guard = [("shaft", notice) for notice in (_of_a_body if free else _of_the_shaft)(scene)]
    by_guard += [("mesh", notice) for notice in _of_the_mesh(scene, body)]
    by_guard += [("features", notice) for notice in _beyond_the_segments(scene)]
    if not free:
        by_guard += [("round_part", notice) for notice in described(scene)]
    by_guard += [(name, n) for name in _guards(scene) for n in _heard(name, probe)]
    records = tuple(record(name, notice, notice.models) for name, notice in by_guard)
    judged = beams() if scene.ports else LADDER.of(BEAM)
    verdicts = {model: _verdict(model, records) for model in (*judged, *_solids(scene))}
    return Check(scene.name, records, verdicts)


def notices(scene: Scene, solutions: dict[str, Solution]) -> list[GuardRecord]:
    """Return notices on models that are solved, facts left out, of the guards that a comparison
    does not answer by itself.
    """
    plain = scene.plain
    # quick solutions are of the plain part; solutions with features cannot stand in for them
    plain_solutions = solutions if plain is scene else {}
    probes = [Probe(plain, s.body, plain_solutions, scene) for s in solutions.values()]
    out: dict[str, GuardRecord] = {}
    if scene.body is not None and probes:
        of_part = [*described(scene), *against_the_part(scene, solutions, probes[-1])]
        for notice in (n for n in of_part if n.level != "fact"):
            out[notice.sentence] = record("round_part", notice, _about(notice, solutions))
    for name in (n for n in _guards(scene) if n not in NOT_IN_COMPARISONS):
        for probe in probes if name in OF_A_MESH else probes[-1:]:
            for notice in _heard(name, probe):
                models = _about(notice, solutions)
                concerned = name not in OF_A_MESH or probe.body.fidelity in notice.models
                if notice.level != "fact" and concerned and (models or not notice.models):
                    out.setdefault(notice.sentence, record(name, notice, models))
    return list(out.values())


def record(guard: str, notice: Notice, models: Iterable[str]) -> GuardRecord:
    """Return a notice as a record, with the models that are asked about."""
    return GuardRecord(
        guard=guard, level=notice.level, models=list(models), sentence=notice.sentence
    )


def _about(notice: Notice, solutions: dict[str, Solution]) -> list[str]:
    """Return the solved models that a notice is about; a notice on beams does not concern a lumped
    model that rests on a solid.
    """
    beam_models = set(notice.models) & set(LADDER.of(BEAM))
    lumped = () if beam_models and not beam_models & set(solutions) else LADDER.of(LUMPED)
    return [m for m in notice.models if m in solutions or m in lumped]


def cautions(scene: Scene, body: Body, name: str | None = None) -> list[str]:
    """Return the sentences of the guards to be read before the numbers of one model are used,
    without facts and notices on other models; the mesh of the body is not judged where the numbers
    are of another model.
    """
    model = name or body.fidelity
    probe, silent = Probe(scene.plain, body, whole=scene), set(NOT_HEARD_ALONE)
    if LADDER[model].family != BEAM:
        silent.add("beam_against_solid")
    if model != body.fidelity:
        silent.update(OF_A_MESH)
    sentences = [
        notice.sentence
        for guard in _guards(scene)
        if guard not in silent
        for notice in _heard(guard, probe)
        if notice.level != "fact" and (not notice.models or model in notice.models)
    ]
    return list(dict.fromkeys(sentences))


def _heard(name: str, probe: Probe) -> list[Notice]:
    """Return the notices of a guard; one that cannot be run must not hide those of the others."""
    try:
        return _of_this_lumped(GUARDS[name](probe), name, probe)
    except (
        SolidgearError,
        ArithmeticError,
        RuntimeError,
        MemoryError,
        np.linalg.LinAlgError,
    ) as error:
        text = f"not checked ({name.replace('_', ' ')}): {error}"
        # A result that a comparison would have given is open; nothing holds for want of a check.
        concerned = beams() if name in COMPARES else ()
        return [Notice("open" if concerned else "caution", concerned, text)]


def _of_this_lumped(heard: Notices, name: str, probe: Probe) -> list[Notice]:
    """Return the notices without the lumped model where they are about beams that it does not rest
    on.
    """
    if probe.beam_fits:
        return list(heard)
    if name == "lumped_against_solid":  # that of the plain part, on its beam
        return []
    lumped, beam = set(LADDER.of(LUMPED)), set(LADDER.of(BEAM))
    out = []
    for notice in heard:
        if beam & set(notice.models):
            others = tuple(m for m in notice.models if m not in lumped)
            notice = replace(notice, models=others)
        out.append(notice)
    return out


def _solids(scene: Scene) -> list[str]:
    """Return the solids that get a verdict: those solved when none is named, and those that hold
    the scene.
    """
    fit = LADDER.fit(scene)
    return [m for m in LADDER.of(SOLID) if m in fit or LADDER[m].can_model(scene)]


def _verdict(model: str, records: Iterable[GuardRecord]) -> Verdict:
    relevant = [
        r for r in records if model in r.models or (r.guard == "free_motions" and r.level != "fact")
    ]
    worst = max((r.level for r in relevant), key=LEVELS.index, default="fact")
    guards = [r.guard for r in relevant if r.level == worst and worst != "fact"]
    return Verdict(VERDICTS[worst], tuple(dict.fromkeys(guards)))


def _beyond_the_segments(scene: Scene) -> Iterator[Notice]:
    """Yield notices on features, and on models that answer for the plain part only."""
    if scene.features:
        for of_features in added("notices of features").values():
            yield from of_features(scene)
    yield from details(scene)
    features = resolved(scene)
    if not features:
        return
    unfit = [m for m in LADDER.names if m in (*everything(), *LADDER.fit(scene))]
    unfit = [m for m in unfit if not LADDER[m].can_model(scene)]
    if not unfit:
        return  # a part from a file may be of revolution all through
    if without_axis(scene):
        yield Notice(
            "avoid",
            tuple(unfit),
            f"{feature_labels(features)} has no axis, and models of shafts cannot solve it",
        )
        return
    names = feature_labels(features)
    # fillets of a part from a file are neither, and are not recognised
    as_recognised = ", judged by cylinders and cones" if scene.body is not None else ""
    yield Notice(
        "fact",
        (),
        f"not of revolution{as_recognised}: {names}; beams and the harmonic solid are judged on its plain part",
    )
    fit = LADDER.holding(scene)
    use = f"use {' or '.join(fit)}" if fit else "no model solves all of them"
    for model in (m for m in unfit if LADDER[m].holds):
        yield Notice("avoid", (model,), f"{LADDER[model].unfit(scene)}; {use}")
    for model in (m for m in fit if m in LADDER.fit(scene)):
        for sentence in heavy_meshes(scene, LADDER[model]) if LADDER[model].holds else ():
            small = "small features need small cells"
            yield Notice("fact", (model,), f"{sentence}; {small}")
    lumped = tuple(m for m in unfit if LADDER[m].family == LUMPED)
    blind = tuple(m for m in unfit if m not in lumped and not LADDER[m].holds)
    if lumped:
        on = " or ".join(m for m in fit if LADDER[m].family == SOLID)
        rests = f"the scene has {names}: its lumped model comes from a solid that solves "
        rests += "it" if len(features) == 1 else "them"
        yield Notice(
            "open" if fit else "avoid",
            lumped,
            f"{rests} ({on}), and costs as much; run compare to judge it"
            if fit
            else f"{rests}, and there is none",
        )
    if blind:
        yield Notice(
            "avoid",
            blind,
            f"the scene has {names}, so a model of revolution would answer for the plain part; "
            f"{use}",
        )


def _guards(scene: Scene) -> tuple[str, ...]:
    """Return the names of the guards that apply: most speak of the plain part of a shaft."""
    if without_axis(scene):
        return OF_ANY_BODY
    return tuple(name for name in GUARDS if scene.ports or name not in OF_A_POINT)


def _of_a_body(scene: Scene) -> Iterator[Notice]:
    """Yield notices on edges, mass and materials of a body without an axis, and doubts about the
    files.
    """
    body = scene.body
    assert body is not None and body.edges is not None  # so it is without an axis
    edges = " x ".join(f"{1e3 * edge:.6g}" for edge in body.edges)
    block = body.kind == "block"
    yield Notice(
        "fact",
        (),
        f"{scene.name}: {'block' if block else body.name} of {edges} mm along x, y and z, mass "
        f"{body.mass(scene.material):.4g} kg; {_held_at(scene)}",
    )
    yield from of_files(scene)


def _held_at(scene: Scene) -> str:
    """Return the patches that are held, or those that could be, in words."""
    supports = [repr(b.patch.name) for b in scene.bearings if b.patch is not None]
    if supports:
        return f"held at {listed(supports)}"
    patches = listed([repr(p.name) for p in scene.body.patches], 12) if scene.body else ""
    return f"free; patches: {patches or 'none, for the file names no groups of surfaces'}"


def _of_the_shaft(scene: Scene) -> Iterator[Notice]:
    """Yield notices on length, mass and inertia, with all rigid masses."""
    shaft, inertia = own_mass(scene), whole_mass(scene)
    mass, centre = mass_with_masses(scene)
    source = "closed form"
    if beside(scene):
        source = "closed form, inertia of the round part"
        if scene.body is not None:
            source = "mass and centre of the file, inertia of the round part"
    yield Notice(
        "fact",
        (),
        f"{scene.name}: length {1e3 * scene.length:.6g} mm, mass {mass:.4g} kg, centre at y = "
        f"{1e3 * centre:.4g} mm, polar inertia {inertia.iyy:.4g}, transverse {inertia.ixx:.4g} "
        f"kg m^2 ({source})",
    )
    if scene.masses:
        masses = listed(
            f"{m.name!r} {m.mass:.4g} kg on "
            + (f"y = {1e3 * m.lo:.6g} to {1e3 * m.hi:.6g} mm" if m.on is None else repr(m.on))
            for m in scene.masses
        )
        yield Notice("fact", (), f"the shaft has {shaft.mass:.4g} kg of this mass, {masses}")


def _of_the_mesh(scene: Scene, body: Body) -> Iterator[Notice]:
    """Yield notices on mass and inertia of the mesh against the closed form, and on the stiffness
    against rigid motions, which must be none.
    """
    exact = mass_properties(scene.outline)
    matrix, model = body.mass_matrix(), (body.fidelity,)
    # beams leave out fillets and chamfers, and are compared with the segments alone
    beam = LADDER[body.fidelity].family == BEAM
    due = mass_properties(Outline(scene.segments)) if beam else exact
    # with cuts there is no closed form; a part has the mass of its file
    closed = [("mass", matrix[0, 0], due.mass), ("polar inertia", matrix[4, 4], due.iyy)]
    bare = " without fillets and chamfers" if beam and scene.outline.corners else ""
    source, off = f"closed form{bare}", f"the closed form{bare}"
    if not body.mesh.get("round", True):
        part = scene.body
        closed, source, off = [], "the part", "that of the part"
        if part is not None:
            closed = [("mass", matrix[0, 0], part.mass(scene.material))]
    residual, errors = body.rigid_residual(), []
    tolerance = LADDER[body.fidelity].mass_tolerance
    limit = max(tolerance, FOLLOWED if scene.outline.corners else 0.0)
    for name, meshed, exact_value in closed:
        error = meshed / exact_value - 1
        errors.append(f"{name} {error:+.1e}")
        if abs(error) > limit:
            yield Notice(
                "fault",
                model,
                f"{name} of the {body.fidelity} mesh is {error:+.2e} off {off}, limit {limit:g}: "
                "use a finer mesh",
            )
    against = f"{' and '.join(errors)} against {source}, " if errors else ""
    yield Notice(
        "fact",
        model,
        f"mesh checked: {body.fidelity}, {body.size} unknowns, {against}stiffness {residual:.1e} "
        "against rigid motions (rounding, for a free body)",
    )
    if residual > 1e-9:
        yield Notice(
            "fault",
            model,
            f"the body is not free: rigid motions meet a stiffness of {residual:.1e}, limit 1e-9",
        )
