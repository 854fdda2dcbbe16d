"""Types of report.json, from which it and its schema are made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from tribolab.campaign.modes import SPEED_COLUMNS
from tribolab.core.untyped import Json
from tribolab.core.wording import LOAD_MEASURED, LOAD_STATED, LOAD_VARIES
from tribolab.qc.register import STATUSES
from tribolab.records.annotations import Columns, Natural, means, one_of
from tribolab.records.judgement import Limits
from tribolab.records.models.joint_record import JointRecord
from tribolab.records.models.mode_record import EvidenceRow
from tribolab.records.models.model_rows import FITTED, LEFT_OUT
from tribolab.records.part_records import BudgetRow, FigureRecord, Point, TractionPoint
from tribolab.records.parts import Row
from tribolab.records.runs.run_record import RunFacts
from tribolab.records.surfaces.surface_rows import ADHESION, CONTACT, ROUGHNESS
from tribolab.records.wording import UNITS
from tribolab.regime.model import LOCAL, NO_STICK_SLIP, SUSPECTED, UNEXPLAINED, UNKNOWN
from tribolab.report.document.models import MODEL_COLUMNS, SENSITIVE
from tribolab.report.tables import SEVERITIES

REPORT_SCHEMA_FILE = "report.schema.json"
_DESCRIPTION = (
    "report.json: the content of report.html. Numbers are in SI units, stated in the names; "
    "missing numbers are null."
)
_FIT_TEXTS = (
    *("area", "adhesion", "other_area", "interval_says", "judgement", "spectrum_error_from"),
    "ratio_to",
)
_CHECK = ("scan", "check", "status", "variable", "message", "value", "unit", "where")
_VALIDITY = "exceeded limits of the theory, and what to do; empty if none"
_QUALITY = "worst result of the checks on the scans that were used; empty without scans"
_ROUGHNESS = (
    "a row of tables/roughness.csv: ISO parameters are means over the scans, *_sem their "
    "standard errors from the scatter between scans (for a single profile: between sampling "
    "lengths), *_gap_error the error due to missing heights; Sq and Sa (ISO 25178) of maps "
    "without cut-off, null for profiles; rms_* are moments of the extrapolated spectrum of "
    "an isotropic surface"
)
_CONTACT = (
    "a row of tables/contact.csv: without adhesion, at one load, or at one pressure if no "
    "load is known"
)
_ADHESION = "a row of tables/adhesion.csv: in one medium, at one load"

Seconds = Annotated[float, Field(ge=0)]
Status = Annotated[str, one_of("done", "failed", "skipped")]
Load = Annotated[float | None, means("normal force: set-point, or measured if none is stated")]
LoadFrom = Annotated[
    str,
    one_of(
        *("", LOAD_STATED, LOAD_MEASURED, LOAD_VARIES),
        meaning="source of the nominal normal force; 'varies' if a run has several loads",
    ),
]
RoughnessRow = Annotated[Row, Columns(ROUGHNESS, texts=("form_removed",), row=_ROUGHNESS)]
ContactRow = Annotated[Row, Columns(CONTACT, row=_CONTACT)]
AdhesionRow = Annotated[Row, Columns(ADHESION, texts=("medium",), row=_ADHESION)]
ScanCheckRow = Annotated[
    Row, Columns(_CHECK, texts={*_CHECK} - {"value"}, values={"status": STATUSES})
]
FitRow = Annotated[
    Row, Columns(FITTED | MODEL_COLUMNS, texts=_FIT_TEXTS, counts=("degrees_of_freedom",))
]
SensitivityRow = Annotated[Row, Columns(SENSITIVE, texts=("variation", "low", "high", "reason"))]
LeftOutRow = Annotated[Row, Columns(LEFT_OUT, texts=tuple(LEFT_OUT))]
SpeedRow = Annotated[
    Row,
    Columns(
        ("sliding_speed_m_s",),
        SPEED_COLUMNS,
        known=("sliding_speed_m_s",),
        texts=("regime", "model_regime", "waveform", "regularity"),
    ),
]


@dataclass(frozen=True, kw_only=True)
class ReportedPart:
    """Common fields of every run, surface and model."""

    name: str
    status: Status
    reason: Annotated[str, means("reason of the failure, or empty")]
    error: Annotated[str, means("class of the error, or empty")]
    data_file: str
    reused: bool
    kept: str
    seconds: Seconds


@dataclass(frozen=True, kw_only=True)
class _RunHead(ReportedPart):
    """Header fields of a run's outcome."""

    surface: str
    medium: str
    nominal_normal_force_N: Load
    load_from: LoadFrom
    files: tuple[str, ...]
    segments_found: Natural
    segments_rejected: Annotated[Natural, means("number of segments rejected manually")]
    quality_as_found: Annotated[
        str, means("quality before manual decisions; empty without decisions")
    ]


@dataclass(frozen=True, kw_only=True)
class ReportedRun(RunFacts, _RunHead):
    """A run with its results (none if it failed)."""

    status: Annotated[str, one_of("done", "failed")]


@dataclass(frozen=True)
class ReportedCurve:
    """A measured curve: all runs of one surface, medium and load."""

    name: str
    surface: str
    medium: str
    nominal_normal_force_N: Load
    runs: tuple[str, ...]
    points: tuple[Point, ...]
    points_as_found: Annotated[
        tuple[Point, ...], means("points without manual decisions; empty if unchanged")
    ]
    budget: Annotated[
        tuple[BudgetRow, ...], means("contributions to the uncertainty of the points")
    ]
    uncertainty_says: Annotated[
        str, means("contributions missing in the uncertainty of the points; empty if complete")
    ]
    load_from: LoadFrom
    traction: Annotated[
        tuple[TractionPoint, ...],
        means("friction over the slide-roll ratio, of a machine whose bodies both turn"),
    ]


@dataclass(frozen=True, kw_only=True)
class ReportedSurface(ReportedPart):
    """A surface: its rows of the tables of roughness, contact and adhesion."""

    quality: Annotated[str, one_of("", *STATUSES, meaning=_QUALITY)]
    checks: Annotated[tuple[ScanCheckRow, ...], means("result of each check on each scan")]
    files: tuple[str, ...]
    roughness: RoughnessRow | None
    contact: tuple[ContactRow, ...]
    adhesion: tuple[AdhesionRow, ...]
    modulus: Annotated[str, means("source of the modulus of the rubber")]
    validity: Annotated[str, means(_VALIDITY)]
    area: Annotated[str, means("theory of the contact area, or empty")]


@dataclass(frozen=True, kw_only=True)
class ReportedModel(ReportedPart):
    """The mixed-lubrication model of a measured curve in a liquid."""

    curve: Annotated[str, means("measured curve to which it belongs")]
    surface: str
    medium: str
    normal_force_N: float | None
    fit: FitRow | None
    sensitivity: tuple[SensitivityRow, ...]
    not_varied: str
    not_in_model: tuple[LeftOutRow, ...]
    validity: Annotated[str, means(_VALIDITY)]


@dataclass(frozen=True)
class ReportedMode:
    """Sliding mode of a measured curve: verdict, evidence, and the measurement to decide it."""

    curve: str
    condition: str
    surface: str
    medium: str
    nominal_normal_force_N: Load
    verdict: Annotated[str, one_of(NO_STICK_SLIP, LOCAL, SUSPECTED, UNEXPLAINED, UNKNOWN)]
    text: str
    paragraph: str
    evidence: Annotated[
        tuple[EvidenceRow, ...], means("for and against an adhesion-controlled mode")
    ]
    decide: tuple[str, ...]
    numbers: dict[str, float | None]
    segments: Natural
    segments_oscillating: Natural
    scaling: str
    scaling_exponent: float | None
    scaling_error: float | None
    speeds: tuple[SpeedRow, ...]


@dataclass(frozen=True)
class CampaignFile:
    """The campaign file as analysed."""

    name: str
    file: str
    sha256: Annotated[str, Field(pattern="^([0-9a-f]{64})?$")]
    text: str


@dataclass(frozen=True)
class Extent:
    """Minimum and maximum."""

    min: float
    max: float


@dataclass(frozen=True)
class CampaignVerdict:
    """Result of the campaign in one sentence, and its numbers."""

    status: Annotated[str, one_of("complete", "incomplete", "nothing")]
    text: str
    runs: Natural
    done: Natural
    failed: Natural
    rejected: Natural
    suspect: Annotated[Natural, means("runs that are used although a check is suspect")]
    uncertain: Annotated[
        Natural, means("conditions whose repeats scatter so much that their mean is uncertain")
    ]
    without_value: Annotated[Natural, means("sound runs without a friction coefficient")]
    rejected_by_hand: Annotated[Natural, means("runs rejected manually")]
    accepted_by_hand: Annotated[Natural, means("runs accepted manually despite their checks")]
    kept: Natural
    reused: Natural
    segments: Natural
    segments_rejected: Annotated[Natural, means("number of segments rejected manually")]
    ranges: dict[Annotated[str, one_of(*UNITS)], Extent]


@dataclass(frozen=True)
class ReportedFinding:
    """A finding: severity, runs, place and text."""

    severity: Annotated[str, one_of(*SEVERITIES)]
    run: str
    where: str
    message: str


@dataclass(frozen=True)
class SourceFile:
    """A file that was read."""

    file: str
    sha256: Annotated[str, means("empty if the file could not be read")]
    bytes: Natural


@dataclass(frozen=True, kw_only=True)
class ReportHead:
    """Everything in report.json except the runs, which are written one by one."""

    schema_version: Literal["2.0"] = "2.0"
    made_at: Annotated[str, Field(pattern=r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")]
    campaign: CampaignFile
    verdict: CampaignVerdict
    thresholds: Annotated[
        dict[str, Limits],
        means("limits above which the table of runs marks a number as suspect or beyond the limit"),
    ]
    findings: tuple[ReportedFinding, ...]
    sources: tuple[SourceFile, ...]
    versions: dict[str, str]
    curves: tuple[ReportedCurve, ...]
    surfaces: tuple[ReportedSurface, ...]
    sliding_mode: tuple[ReportedMode, ...]
    models: tuple[ReportedModel, ...]
    joint_fits: Annotated[tuple[JointRecord, ...], means("joint fits of all loads of a surface")]
    figures: tuple[FigureRecord, ...]
    surface_figures: tuple[FigureRecord, ...]
    model_figures: tuple[FigureRecord, ...]
    sliding_figures: tuple[FigureRecord, ...]


@dataclass(frozen=True, kw_only=True)
class Report(ReportHead):
    """Complete content of report.json."""

    runs: tuple[ReportedRun, ...]


class _Closed(GenerateJsonSchema):
    """Schema generator without titles, in which objects have exactly the listed fields."""

    def dataclass_schema(self, schema: core_schema.DataclassSchema) -> JsonSchemaValue:
        made = super().dataclass_schema(schema)
        first, _, _ = made.get("description", "").partition("\n")
        return {**made, "description": first, "additionalProperties": False}

    def field_is_required(self, field: Any, total: bool) -> bool:
        return True

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


def report_schema() -> Json:
    """Return the JSON Schema (2020-12) of report.json."""
    made = TypeAdapter(Report).json_schema(mode="serialization", schema_generator=_Closed)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **made,
        "title": "tribolab report",
        "description": _DESCRIPTION,
    }
