"""Tables of the campaign file with options for the analysis and checks of runs and scans."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from tribolab.campaign.settings.fields import (
    Discard,
    MiddleShare,
    PositiveSi,
    ShareOfEnds,
    Si,
    SomeText,
)
from tribolab.campaign.settings.table import Table
from tribolab.core.errors import ConfigError, TribolabError, nearest, shown
from tribolab.core.untyped import Arguments


class Segments(Table):
    """Detection of segments of constant speed."""

    trim: ShareOfEnds = 0.10
    """Fraction of a segment that is trimmed at each end."""
    position_range: (
        tuple[Annotated[float, Si("m", "5 mm")], Annotated[float, Si("m", "32 mm")]] | None
    ) = None
    """Part of the track to use."""
    stroke_middle: MiddleShare | None = None
    """Reciprocating motion without constant speed: central fraction of each stroke's length to use,
    e.g. "40 %". Default: half, if the instrument states stroke and frequency or if the position
    shows that all strokes are equal."""
    discard: Discard | None = None
    """Initial part of each run to leave out: a sliding distance, a time, or cycles."""
    steady: Literal["auto"] | None = None
    """Set "auto" to use only the part after running-in (see `running_in.csv`)."""
    speed_tolerance: Annotated[float, Field(gt=0, lt=1)] = 0.1
    """Largest relative speed difference within one point of a curve. Speeds are grouped by
    set-point, if known; otherwise by the gaps between them."""


class Friction(Table):
    """Computation of the friction coefficient."""

    offset: Literal["auto", "half loop", "zero load", "none"] = "auto"
    """Method for the zero of the friction force."""
    pair_tolerance: Annotated[float, Field(gt=0, lt=2)] = 0.25
    """Largest relative speed difference between the two strokes of a half loop."""


class Roughness(Table):
    """Power spectrum and roughness from the scans."""

    form: Literal["auto", "none", "mean", "tilt", "circle", "polynomial"] = "auto"
    """Form to remove from the scans. Default: a circle from profiles, a second-degree polynomial
    from maps."""
    lambda_c: Annotated[float, PositiveSi("m", "0.8 mm")] | None = None
    """Cut-off wavelength of Ra, Rq and related parameters. Default: none if the instrument
    filtered, otherwise 0.8 mm, or a fifth of a short scan."""
    q_low: Annotated[float, PositiveSi("1/m", "423 1/m")] | None = None
    """Smallest wavenumber; default: pi divided by the Hertz width at the lowest load."""
    q_high: Annotated[float, PositiveSi("1/m", "3.14e9 1/m")] | Literal["measured"] | None = None
    """Largest wavenumber; default: pi / 1 nm. "measured": no extrapolation to wavelengths shorter
    than those of the scans."""
    fit_decade: (
        tuple[
            Annotated[float, PositiveSi("1/m", "1e5 1/m")],
            Annotated[float, PositiveSi("1/m", "1e6 1/m")],
        ]
        | None
    ) = None
    """Wavenumber range for the fit of the power law used for extrapolation."""
    tip_radius: Annotated[float, PositiveSi("m", "2 um")] | None = None
    """Radius of the stylus, if the files do not state it."""


class Qc(Table):
    """Data-quality checks: limits, checks to skip, and the exit code."""

    fail_on: Literal["suspect", "fail", "never"] = "fail"
    """Lowest severity of a finding that gives exit code 1."""
    skip: tuple[SomeText, ...] = ()
    """Checks of runs and scans to skip."""
    limits: dict[SomeText, dict[SomeText, float | SomeText]] = {}
    """Limits of checks, e.g. limits.spikes.noise = 10: numbers in SI, or text with a unit;
    limits.segments also has those of the detection of segments."""

    @property
    def _by_default(self) -> bool:
        return not (self.limits or self.skip)  # importing the checks takes half a second

    def run_options(self) -> Arguments:
        """Return the limits of the checks on runs, and the names of those to skip."""
        if self._by_default:
            return {"limits": {}, "skip": ()}
        from tribolab.qc.run.checks import RUN_CHECKS  # imported late for a quick start

        return self._of(RUN_CHECKS)

    def scan_options(self) -> Arguments:
        """Return the limits of the checks on scans, and the names of those to skip."""
        if self._by_default:
            return {"limits": {}, "skip": ()}
        from tribolab.qc.scan.checks import SCAN_CHECKS  # imported late for a quick start

        return self._of(SCAN_CHECKS)

    def _of(self, checks: Mapping[str, Any]) -> Arguments:
        return {
            "limits": {name: of for name, of in self.limits.items() if name in checks},
            "skip": tuple(name for name in self.skip if name in checks),
        }

    @model_validator(mode="after")
    def _names_are_known(self) -> Self:
        if self._by_default:
            return self
        # imported late for a quick start
        from tribolab.qc.register import resolve_limits
        from tribolab.qc.run.checks import RUN_CHECKS
        from tribolab.qc.scan.checks import SCAN_CHECKS

        known = RUN_CHECKS | SCAN_CHECKS
        try:
            resolve_limits(known, self.limits)
            for name in self.skip:
                if name not in known:
                    raise ConfigError(f"no check is called '{shown(name)}'{nearest(name, known)}")
        except TribolabError as error:
            raise ValueError(str(error)) from error
        return self
