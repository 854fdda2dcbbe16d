"""All that is recorded of curves, surfaces, models and figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

from tribolab.records.annotations import Columns, means
from tribolab.records.parts import CurveOutcome, ModelOutcome, Row, Source, SurfaceOutcome


@dataclass(frozen=True)
class Origin:
    """Files that a product was made from, and their checksums, as its attributes name them."""

    source: str = ""
    source_sha256: str = ""


_POINT = Columns(
    ("sliding_speed_m_s", "friction_coefficient"),
    {
        "friction_coefficient_std": "pooled standard deviation within the segments",
        "friction_coefficient_sem": "standard error of the mean: between runs where `runs` is 2 or "
        "more, else within the run",
        "friction_coefficient_u": "combined standard uncertainty, without Student's factor",
        "friction_coefficient_dof": "its degrees of freedom; null where they are without limit",
        "friction_coefficient_U95": "expanded uncertainty: the friction coefficient lies within "
        "it with 95 %, as far as uncertainty_says does not say what is left out",
    },
    known=("sliding_speed_m_s",),
    open=True,
)
Point = Annotated[Row, _POINT]  # of a measured curve
_PART = Columns(
    {
        "sliding_speed_m_s": "",
        "part": "name of the input, or of the scatter",
        "varies": "with what it takes another value, as stated; empty for the scatter",
        "contribution": "by how much one standard uncertainty of it moves the coefficient, signed",
        "share": "of the variance",
        "dof": "degrees of freedom; null where they are without limit",
    },
    texts=("part", "varies"),
    known=("sliding_speed_m_s",),
    row="one part of the uncertainty of one point",
)
BudgetRow = Annotated[Row, _PART]  # of a measured curve


@dataclass(frozen=True)
class CurveRecord:
    """One measured curve.

    Parameters
    ----------
    outcome
        The little that the rest of a campaign has to know.
    points
        A row per sliding speed.
    levels
        Friction level of each run over that of all [1], None where it is not known; none of a
        curve of one run.
    digest
        Checksum of the curve's values.
    origin
        What it was made from.
    no_slip
        Why there is no stick-slip over speed; "" if there is.
    points_as_found
        What `points` would be without a person's decisions; none where that is the same.
    budget
        A row for each point and each part of its uncertainty.
    uncertainty_says
        What the uncertainty does not hold; "" where it holds all.
    model_inputs
        Standard uncertainties of what a model takes as given, by name, as its runs' instrument
        and campaign state them: relative, of temperature [K], of water content absolute.
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

    @property
    def done(self) -> bool:
        """Whether there is a curve."""
        return self.outcome.done


@dataclass(frozen=True)
class ModelRows:
    """Rows of one model; `fit` is None where no shear stress could be fitted.

    Parameters
    ----------
    fit
        By the columns of the table of shear stresses.
    curve
        A row per sliding speed.
    sensitivity
        A row per variation of what is not known.
    not_varied
        What was held fixed.
    shift
        Relative change of the shear stress, downwards and upwards, that the spectrum's error makes.
    validity
        Why the model is not sure, beyond the limits of the theory.
    """

    fit: Row | None
    curve: tuple[Row, ...]
    sensitivity: tuple[Row, ...] = ()
    not_varied: str = ""
    shift: tuple[float, float] | None = None
    validity: str = ""


@dataclass(frozen=True)
class SurfaceRows:
    """Rows of one surface: of roughness one, of contact one per load, of adhesion per medium too.

    Keys are the tables' columns, with their unit in the name; None where it is not known.
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
    """One surface.

    Parameters
    ----------
    outcome
        The little that the rest of a campaign has to know.
    sources
        Its scans, and the file of the modulus.
    rows
        What is shown of it; None of one that failed.
    digest
        Checksum of the values that models are made from.
    """

    outcome: SurfaceOutcome
    sources: tuple[Source, ...] = ()
    rows: SurfaceRows | None = None
    digest: str = ""

    @property
    def done(self) -> bool:
        """Whether there are results, and not those of before."""
        return self.outcome.done and not self.outcome.kept


@dataclass(frozen=True)
class ModelRecord:
    """One model, and what is shown of it; None of one that failed."""

    outcome: ModelOutcome
    rows: ModelRows | None = None

    @property
    def done(self) -> bool:
        """Whether there are results, and not those of before."""
        return self.outcome.done and not self.outcome.kept


@dataclass(frozen=True)
class FigureRecord:
    """One figure in the results folder."""

    file: Annotated[str, means("SVG, relative to the results folder")]
    data: Annotated[
        str,
        means("CSV with the numbers that it shows, relative to the results folder; empty if none"),
    ]
    caption: Annotated[str, means("what stands below it")]
    alt: Annotated[str, means("what the figure shows, in words and numbers")]
    kind: Annotated[str, means("what the page groups it by")] = ""
