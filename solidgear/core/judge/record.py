"""Content of ``results.json``, typed.

A run is written by dumping a :class:`Record` and read by validating one; tables, charts and tests
read its attributes. Numbers are SI. A number that does not exist is None: JSON knows neither NaN
nor infinity. Quantities are called as in :data:`solidgear.core.quantity.QUANTITIES` everywhere.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AliasChoices, BeforeValidator, ConfigDict, Field

from solidgear.core.body.mode_names import ModeName, meant
from solidgear.core.judge.open_numbers import OpenNumbers
from solidgear.core.judge.part import Number, Part
from solidgear.core.judge.ties import SCENE, SECTION
from solidgear.core.ladder.model import BEAM
from solidgear.core.plain import plain
from solidgear.core.quantity import COMPLIANCE, Quantity

Numbers = Annotated[list[float | None], BeforeValidator(plain)]
Matrix = Annotated[list[list[float | None]], BeforeValidator(plain)]
Facts = Annotated[dict[str, Any], BeforeValidator(plain)]
Quantities = dict[str, Number]
#: for a model without a name
NAMELESS = "–"


def relative_change(value: float | None, base: float | None) -> float | None:
    """Return `value` over `base` less one; None where either is missing, or the base is zero."""
    return None if value is None or not base else value / base - 1


def _called(key: str, name: str) -> Any:
    """Return options of a field that JSON of every command calls in another way than its attribute."""
    return {"validation_alias": AliasChoices(key, name), "serialization_alias": key}


#: version of this layout; it rises when a field is renamed or removed
SCHEMA = 5


class ModeRecord(Part):
    """A mode; a pair is counted in ``multiplicity``."""

    name: ModeName = ModeName("")
    family: str = ""
    frequency_hz: Number = None
    multiplicity: int = 1
    captured: Number = None
    error: Number = Field(0.0, **_called("solver_error", "error"))


class BarRecord(Part):
    """Error bar of one quantity; see :class:`solidgear.core.judge.bars.ErrorBar`."""

    gci: Number = None
    change: Number = None
    factor: Number = None
    solver: Number = None
    extrapolated: Number = None
    method: str = ""


class BarSummary(Part):
    """Error bars of a model: relative, of every quantity, and the widest of a compliance."""

    compliance: Number = None
    method: str = ""
    each: Quantities = {}


class LevelRecord(Part):
    """One mesh of a sequence."""

    dofs: int | None = Field(None, **_called("unknowns", "dofs"))
    h: Number = None
    order: int | None = None
    quantities: Quantities = {}
    mesh: Facts = {}


class ConvergenceRecord(Part):
    """Meshes from coarse to fine, and the error bar of each quantity on the last one."""

    levels: list[LevelRecord] = []
    quantities: dict[str, BarRecord] = {}


class EvidenceRecord(Part):
    """Evidence for one solution: residuals, symmetry, count of modes."""

    asymmetry: Number = None
    refinement_residual: Number = None
    rigid_residual: Number = None
    modal_residual: Number = None
    orthogonality: Number = None
    eigensolver: str = ""
    mode_count: list[Facts] = []
    families: list[Facts] = []
    complete: str = ""
    complete_below_hz: Number = None
    rigid_modes: int | None = None
    coupling_bound: Number = None
    shift_rad2: Number = None


class PointRecord(Part):
    """Statics at a further lumped point."""

    stiffness: Matrix | None = None
    compliance: Matrix | None = None


class CoupledRecord(Part):
    """Statics between all lumped points: 6 n square matrices, point by point.

    ``stiffness_error`` is the relative error that inverting the compliance leaves.
    """

    ports: list[str] = []
    stiffness: Matrix | None = None
    compliance: Matrix | None = None
    stiffness_error: Number = None

    def block(self, a: str, b: str, kind: str) -> Matrix | None:
        """Return the 6x6 of two points; None where there is none."""
        values = matrix_of(self, kind)
        if values is None or not {a, b} <= set(self.ports):
            return None
        i, j = 6 * self.ports.index(a), 6 * self.ports.index(b)
        return [row[j : j + 6] for row in values[i : i + 6]]


class ModelRecord(Part):
    """One model.

    ``title``, ``short``, ``theory``, ``family``, ``colour`` and ``marker`` are those of the ladder
    (:class:`solidgear.core.ladder.model.Model`), so that a record can be shown without it.
    """

    title: str = ""
    short: str = ""
    theory: str = ""
    family: str = ""
    colour: str = "#777777"
    marker: str = "P"
    valid: bool | None = None
    open: bool = False
    why_not: str | None = None
    source: str | None = None
    variant: str | None = None
    compliance: Matrix | None = None
    stiffness: Matrix | None = None
    points: dict[str, PointRecord] = {}
    coupled: CoupledRecord | None = None
    modes: list[ModeRecord] = []
    band: BarSummary | None = None
    convergence: ConvergenceRecord | None = None
    dofs: int | None = Field(None, **_called("unknowns", "dofs"))
    seconds: Quantities = {}
    peak_mb: Number = None
    backend: str | None = None
    mesh: Facts = {}
    evidence: EvidenceRecord = EvidenceRecord()

    @property
    def validity(self) -> str:
        """``yes``, ``no``, ``open`` (not judged, or too close) or ``unknown``."""
        if self.valid is True:
            return "yes"
        if self.open:
            return "open"
        return "no" if self.valid is False else "unknown"

    @property
    def bars(self) -> Quantities:
        """Relative error bar of every quantity."""
        return self.band.each if self.band else {}

    @property
    def answer_seconds(self) -> float | None:
        """Seconds for building and solving, without error bars and variants."""
        spent = [self.seconds.get(stage) for stage in ("build", "statics", "modes")]
        known = [value for value in spent if value is not None]
        return sum(known) if len(known) == len(spent) else self.seconds.get("total")

    def value(self, quantity: Quantity) -> float | None:
        """Return an entry of a matrix, at the main point, a further one or between points."""
        matrix = None
        if quantity.pair:
            if self.coupled is not None:
                matrix = self.coupled.block(*quantity.pair, quantity.kind)
        elif quantity.points:
            point = self.points.get(quantity.points[0])
            matrix = None if point is None else matrix_of(point, quantity.kind)
        else:
            matrix = matrix_of(self, quantity.kind)
        return None if matrix is None else quantity.of(matrix)

    def first_frequency(self, family: str) -> float | None:
        """Return the lowest elastic frequency of a family ('bending', 'axial', 'torsion'), Hz."""
        for mode in self.modes:
            of_family = family in (mode.family, mode.name.family)
            if of_family and not mode.name.rigid and mode.frequency_hz is not None:
                return mode.frequency_hz
        return None

    def mode(self, name: str) -> ModeRecord | None:
        """Return the mode that a name such as 'bending 2' means."""
        modes = sorted(self.modes, key=lambda mode: mode.frequency_hz or 0.0)
        place = meant(name, [mode.name for mode in modes])
        return None if place is None else modes[place]


def matrix_of(statics: ModelRecord | PointRecord | CoupledRecord, kind: str) -> Matrix | None:
    """Return a stiffness or a compliance."""
    return statics.compliance if kind == COMPLIANCE else statics.stiffness


class VariantRecord(Part):
    """A model with one attachment at every station."""

    quantities: Quantities = {}
    stiffness: Matrix | None = None
    compliance: Matrix | None = None
    modes: list[ModeRecord] = []


class DeviationRecord(Part):
    """A quantity of a model against the reference."""

    model: str = ""
    reference: str = ""
    attachment: str = ""
    quantity: Quantity = Quantity("")
    unit: str = ""
    value: Number = None
    reference_value: Number = None
    relative: Number = None
    band: Number = None
    verdict: str | None = None
    pairing: str = ""

    @property
    def resolved(self) -> bool:
        """True unless the deviation lies inside the error bars of both models."""
        if self.verdict is not None:
            return self.verdict != "not resolved"
        return self.band is None or self.relative is None or abs(self.relative) > self.band


class CauseRecord(Part):
    """Relative change of quantities when one assumption is switched."""

    cause: str = ""
    change: str = ""
    model: str = ""
    quantities: Quantities = {}


class LumpedVariant(Part):
    """One lumped mass on a stiffness; further numbers by their own names."""

    mass: Matrix | None = None
    feasible: bool = False
    first: bool = False
    frequency_hz: Number = None
    frequency_error: Number = None
    slope_error: Number = None
    kinetic_error: Number = None
    valid_to_hz: Number = None
    verdict: str = ""


class LumpedRecord(Part):
    """Lumped models of one body, on z and thx; ``why_not`` where there is nothing to lump."""

    stiffness: Matrix | None = None
    motion: Numbers = []
    frequency_hz: Number = None
    static_share: Number = None
    total_mass: Number = None
    seconds: Number = None
    variants: dict[str, LumpedVariant] = {}
    why_not: str | None = None


class VerdictRecord(Part):
    """Model to trust, and the cheapest that will do."""

    trust: str | None = None
    reference: str | None = None
    cheapest: str | None = None
    tolerance: Number = None
    judged: list[Quantity] = []
    sentences: list[str] = []


class GuardRecord(Part):
    """Sentence of a guard on some models."""

    guard: str = ""
    level: str = ""
    models: list[str] = []
    sentence: str = ""


class PartnerRecord(Part):
    """A mode and the partner in the reference."""

    mode: str = ""
    partner: str | None = None
    mac: Number = None
    frequency_hz: Number = None
    reference_hz: Number = None
    relative: Number = None


class MacTable(Part):
    """Modal assurance criterion of a model's modes (rows) against the reference's (columns)."""

    rows: list[str] = []
    columns: list[str] = []
    values: Matrix = []
    pairs: list[PartnerRecord] = []


class MacRecord(Part):
    """Correlation of all models with the reference, on stations along the axis (m)."""

    reference: str | None = None
    stations: Numbers = []
    models: dict[str, MacTable] = {}


class PortRecord(Part):
    """The lumped point, the order of the six components, and those that nothing resists."""

    name: str = ""
    y: Number = None
    attachment: str = ""
    order: list[str] = []
    free: list[str] = []


class PlaceRecord(Part):
    """A place, ``shoulder``, ``seat end of A``, ... or ``elsewhere``, and a share of the error.

    ``y`` and ``r`` (m) of ``elsewhere`` are the middle of the cell with most of it. A place of a 3D
    solid that is no circle around the axis has ``x`` and ``z`` too, of what of it is nearest to its
    cell with the most, and no ``r`` where there is no axis. Cells whose middle lies within ``reach``
    (m) count as of the place, where no other is nearer.
    """

    what: str = ""
    x: Number = None
    y: Number = None
    z: Number = None
    r: Number = None
    share: Number = None
    reach: Number = None


class WhereRecord(Part):
    """Places of the error of a number of a solid, the largest share first.

    ``order`` is that of the elements, ``total`` the relative error bar of the quantity; of a
    coupling, it is relative to the geometric mean of the diagonal entries. Of a harmonic solid,
    ``points`` are r and y (m) of the corners of the cells, ``shares`` those of every cell, in sum
    one. ``picture`` is the name of a file that shows the cells of a 3D solid, empty without one.
    """

    model: str = ""
    quantity: str = ""
    order: int = 0
    total: Number = None
    sentence: str = ""
    rows: list[PlaceRecord] = []
    points: list[list[float]] = []
    cells: list[list[int]] = []
    shares: list[float] = []
    picture: str = ""
    seconds: Number = None


class Record(Part):
    """Results of a comparison.

    ``where`` has the places of the error of the harmonic solid, ``where_solid`` those of a 3D solid.
    ``missing`` are titles of models that have a body of their own and no record here. ``shown_in``
    is the choice of units of the page (:mod:`solidgear.show.units`); the record itself is in SI.

    Examples
    --------
    >>> record = Record.model_validate({"verdict": {"trust": "harmonic"}})
    >>> record.verdict.trust, record.complete
    ('harmonic', True)
    """

    model_config = ConfigDict(populate_by_name=True)

    version: int = Field(SCHEMA, alias="schema")
    complete: bool = True
    scene: Facts = {}
    load_case: str = ""  #: sentence on the case of several under which catalogue bearings settled
    port: PortRecord | None = None
    further_ports: list[PortRecord] = []
    models: dict[str, ModelRecord] = {}
    missing: list[str] = []
    attachments: dict[str, dict[str, VariantRecord]] = {}
    mac: MacRecord | None = None
    deviations: list[DeviationRecord] = []
    causes: list[CauseRecord] = []
    lumped: dict[str, LumpedRecord] = {}
    verdict: VerdictRecord = VerdictRecord()
    guards: list[GuardRecord] = []
    where: WhereRecord | None = None
    where_solid: WhereRecord | None = None
    open: OpenNumbers = OpenNumbers()
    environment: Facts = {}
    images: dict[str, str] = {}
    warnings: list[str] = Field([], **_called("cautions", "warnings"))
    #: of the whole run, with its report, and of all processes; and of the solution alone
    seconds_total: Number = None
    peak_mb_total: Number = None
    seconds_solved: Number = None
    peak_mb: Number = None
    expected_peak_mb: Number = None
    left_out: list[str] = []
    files: list[str] | None = None
    shown_in: str = "engineering"

    @property
    def reference(self) -> str | None:
        """Key of the model that others are compared with."""
        return self.verdict.reference or (self.mac.reference if self.mac else None)

    def model(self, key: str | None) -> ModelRecord:
        """Return the record of a model; an empty one where there is none."""
        return self.models.get(key or "") or ModelRecord()

    def name(self, key: str | None) -> str:
        """Return the name of a model in a sentence, its key if it has no title."""
        return self.model(key).title or key or NAMELESS

    def title(self, key: str) -> str:
        """Return the name of a model at the beginning of a cell or sentence."""
        name = self.name(key)
        return name[:1].upper() + name[1:]

    def headline(self, key: str, quantity: str) -> DeviationRecord | None:
        """Return the deviation that represents a model: like for like for a beam, as tied for a
        solid.

        A beam has no seat surface: its fair partner is the solid with section ties. A solid is
        compared as the scene has it.
        """
        rows = [r for r in self.deviations if r.model == key and r.quantity == quantity]
        tie = SECTION if self.model(key).family == BEAM else SCENE
        return next((r for r in rows if r.attachment == tie), rows[0] if rows else None)

    def as_dict(self) -> dict[str, Any]:
        """Return plain data, as in ``results.json``."""
        return self.model_dump(mode="json", by_alias=True)
