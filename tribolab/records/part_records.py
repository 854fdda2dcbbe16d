"""Records of curves, surfaces, models and figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

from tribolab.records.annotations import Columns, means
from tribolab.records.parts import CurveOutcome, ModelOutcome, Row, Source, SurfaceOutcome


@dataclass(frozen=True)
class Origin:
    """Source files of a result with their checksums, as stored in its attributes."""

    source: str = ""
    source_sha256: str = ""


_POINT = Columns(
    ("sliding_speed_m_s", "friction_coefficient"),
    {
        "friction_coefficient_std": "pooled standard deviation within the segments",
        "friction_coefficient_sem": "standard error of the mean: between runs if `runs` is 2 or "
        "more, else within the run",
        "friction_coefficient_u": "combined standard uncertainty, without Student's factor",
        "friction_coefficient_dof": "degrees of freedom; null if infinite",
        "friction_coefficient_U95": "expanded uncertainty (95 % coverage), without contributions "
        "named in uncertainty_says",
    },
    known=("sliding_speed_m_s",),
    open=True,
)
Point = Annotated[Row, _POINT]  # of a measured curve
_TRACTION = Columns(
    {
        "rolling_speed_m_s": "entrainment speed, the mean of both bodies",
        "slide_roll_ratio": "",
        "friction_coefficient": "",
    },
    known=("rolling_speed_m_s", "slide_roll_ratio"),
    open=True,
)
TractionPoint = Annotated[Row, _TRACTION]  # of a traction curve
_PART = Columns(
    {
        "sliding_speed_m_s": "",
        "part": "name of the input, or of the scatter",
        "varies": "what changes its value, as stated; empty for the scatter",
        "contribution": "signed change of the coefficient per standard uncertainty of the input",
        "share": "of the variance",
        "dof": "degrees of freedom; null if infinite",
    },
    texts=("part", "varies"),
    known=("sliding_speed_m_s",),
    row="one contribution to the uncertainty of one point",
)
BudgetRow = Annotated[Row, _PART]  # of a measured curve


@dataclass(frozen=True)
class CurveRecord:
    """Record of one measured curve.

    Parameters
    ----------
    outcome
        Summary for the later stages of a campaign.
    points
        A row per sliding speed.
    levels
        Friction level of each run over that of all [1], None if unknown; empty for a single run.
    digest
        Checksum of the curve's values.
    origin
        Source files.
    no_slip
        Reason why stick-slip over speed is missing; "" if present.
    points_as_found
        `points` without a person's decisions; empty if equal.
    budget
        A row for each point and each part of its uncertainty.
    uncertainty_says
        Omissions of the uncertainty; "" if it is complete.
    model_inputs
        Stated standard uncertainties of the model's inputs, by name: relative, except temperature
        [K] and water content (absolute).
    traction
        For a machine with two rotating bodies, a row for each slide-roll ratio at each entrainment
        speed with several ratios.
    temperature_K, temperature_spread_K
        Mean and standard deviation of the temperature during sliding; None if not recorded.
    contact_area_m2
        Measured contact area; None if unknown.
    """

    outcome: CurveOutcome
    points: tuple[Point, ...] = ()
    levels: tuple[float | None, ...] = ()
    digest: str = ""
    origin: Origin = Origin()
    no_slip: str = ""
    points_as_found: tuple[Point, ...] = ()
    budget: tuple[BudgetRow, ...] = ()
    uncertainty_says: str = ""
    model_inputs: Mapping[str, float] = field(default_factory=dict)
    traction: tuple[TractionPoint, ...] = ()
    temperature_K: float | None = None
    temperature_spread_K: float = 0.0
    contact_area_m2: float | None = None

    @property
    def done(self) -> bool:
        """Whether there is a curve."""
        return self.outcome.done


@dataclass(frozen=True)
class ModelRows:
    """Rows of one model; `fit` is None if no shear stress could be fitted.

    Parameters
    ----------
    fit
        Fit by the columns of the table of shear stresses.
    curve
        A row per sliding speed.
    sensitivity
        A row per variation of an uncertain input.
    not_varied
        Inputs kept fixed.
    not_in_model
        Effects that are left out, each with its size, if it can be estimated, and the reason.
    shift
        Relative change of the shear stress due to the spectrum's error, downwards and upwards.
    validity
        Limits of the theory that the model exceeds.
    traction
        A row for each slide-roll ratio that was measured, with the computed friction.
    """

    fit: Row | None
    curve: tuple[Row, ...]
    sensitivity: tuple[Row, ...] = ()
    not_varied: str = ""
    not_in_model: tuple[Row, ...] = ()
    shift: tuple[float, float] | None = None
    validity: str = ""
    traction: tuple[TractionPoint, ...] = ()


@dataclass(frozen=True)
class SurfaceRows:
    """Rows of one surface: roughness, contact per load, and adhesion per load and medium.

    Keys are the tables' columns, with their unit in the name; None if unknown.
    """

    name: str
    roughness: Row
    contact: tuple[Row, ...]
    adhesion: tuple[Row, ...]
    modulus: str
    quality: str = ""
    validity: str = ""
    area: str = ""


@dataclass(frozen=True)
class SurfaceRecord:
    """Record of one surface.

    Parameters
    ----------
    outcome
        Summary for the later stages of a campaign.
    sources
        Its scans, and the file of the modulus.
    rows
        Rows for display; None if it failed.
    digest
        Checksum of the values that models are made from.
    """

    outcome: SurfaceOutcome
    sources: tuple[Source, ...] = ()
    rows: SurfaceRows | None = None
    digest: str = ""

    @property
    def done(self) -> bool:
        """Whether there are new results."""
        return self.outcome.done and not self.outcome.kept


@dataclass(frozen=True)
class ModelRecord:
    """Record of one model; its rows are None if it failed."""

    outcome: ModelOutcome
    rows: ModelRows | None = None

    @property
    def done(self) -> bool:
        """Whether there are new results."""
        return self.outcome.done and not self.outcome.kept


@dataclass(frozen=True)
class FigureRecord:
    """Record of one figure in the results folder."""

    file: Annotated[str, means("SVG, relative to the results folder")]
    data: Annotated[
        str,
        means("CSV with the numbers that it shows, relative to the results folder; empty if none"),
    ]
    caption: Annotated[str, means("caption below the figure")]
    alt: Annotated[str, means("what the figure shows, in words and numbers")]
    kind: Annotated[str, means("group on the page")] = ""
