"""Tables of the campaign file that say how runs and scans are analysed and judged."""

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
    """How segments of constant speed are found."""

    trim: ShareOfEnds = 0.10
    """Share of a segment that is left out at each end."""
    position_range: (
        tuple[Annotated[float, Si("m", "5 mm")], Annotated[float, Si("m", "32 mm")]] | None
    ) = None
    """Only this part of the track is used."""
    stroke_middle: MiddleShare | None = None
    """Of a slider that moves to and fro without a constant speed: the share of each stroke's length
    about its middle that is used, e.g. "40 %"; by default half where the instrument states stroke
    and frequency, or the position tells that each stroke is like the last."""
    discard: Discard | None = None
    """What is left out at the beginning of each run: a sliding distance, a time, or cycles."""
    steady: Literal["auto"] | None = None
    """"auto": of each run the part after running-in counts, as `running_in.csv` has it."""
    resolution: Annotated[float, Field(gt=0, lt=1)] | None = None
    """Relative difference of speed that separates two neighbouring plateaus."""
    drift: Annotated[float, Field(gt=0)] | None = None
    """Relative change of speed within one plateau above which it is a ramp."""
    min_samples: Annotated[int, Field(ge=2)] | None = None
    """Fewest samples in a segment."""
    min_duration: Annotated[float, PositiveSi("s", "0.5 s")] | None = None
    """Shorter segments are left out."""
    max_gap: Annotated[float, PositiveSi("s", "2 s")] | None = None
    """Longest pause between two samples within a segment; by default a twentieth of it."""
    speed_tolerance: Annotated[float, Field(gt=0, lt=1)] = 0.1
    """Largest relative difference of the speeds that make one point of a curve. Speeds are grouped
    by the gaps between them; set speeds, where they are known, decide."""
    rest_speed: Annotated[float, PositiveSi("m/s", "0.1 um/s")] | None = None
    """Speed below which the slider is at rest; by default 1e-5 of the highest."""


class Friction(Table):
    """How the friction coefficient is computed."""

    offset: Literal["auto", "half loop", "zero load", "none"] = "auto"
    """Which offset of the friction force is removed."""
    pair_tolerance: Annotated[float, Field(gt=0, lt=2)] = 0.25
    """Up to which difference of speed, over their mean, two strokes have the same friction."""


class Roughness(Table):
    """How the power spectrum is made from the scans."""

    form: Literal["auto", "none", "mean", "tilt", "circle", "polynomial"] = "auto"
    """What is taken away from the scans first; by default a circle from profiles, a polynomial of
    the second degree from maps."""
    lambda_c: Annotated[float, PositiveSi("m", "0.8 mm")] | None = None
    """Cut-off of Ra, Rq and the like; by default none where the instrument filtered, else 0.8 mm,
    or a fifth of a shorter scan."""
    q_low: Annotated[float, PositiveSi("1/m", "423 1/m")] | None = None
    """Smallest wavenumber; by default pi over the Hertz width at the lowest load."""
    q_high: Annotated[float, PositiveSi("1/m", "3.14e9 1/m")] | Literal["measured"] | None = None
    """Largest wavenumber; by default pi / 1 nm. "measured": nothing is extrapolated to shorter
    waves than each surface's scans show."""
    fit_decade: (
        tuple[
            Annotated[float, PositiveSi("1/m", "1e5 1/m")],
            Annotated[float, PositiveSi("1/m", "1e6 1/m")],
        ]
        | None
    ) = None
    """Wavenumbers between which the power law is fitted that goes on to the largest."""
    tip_radius: Annotated[float, PositiveSi("m", "2 um")] | None = None
    """Radius of the stylus, if the files do not say it."""


class Qc(Table):
    """When a finding makes the whole run count as failed."""

    fail_on: Literal["suspect", "fail", "never"] = "fail"
    """The mildest finding that gives exit code 1."""
    skip: tuple[SomeText, ...] = ()
    """Checks on runs and on scans that are left out."""
    limits: dict[SomeText, dict[SomeText, float | SomeText]] = {}
    """Limits of checks by name, e.g. limits.spikes.noise = 10; numbers in SI or with a unit."""

    @property
    def _by_default(self) -> bool:
        return not (self.limits or self.skip)  # then the checks, half a second, need no import

    def run_options(self) -> Arguments:
        """Return limits and names to skip, as far as they are of checks on runs."""
        if self._by_default:
            return {"limits": {}, "skip": ()}
        # late: starting stays quick
        from tribolab.qc.run.checks import RUN_CHECKS

        return self._of(RUN_CHECKS)

    def scan_options(self) -> Arguments:
        """Return limits and names to skip, as far as they are of checks on scans."""
        if self._by_default:
            return {"limits": {}, "skip": ()}
        # late: starting stays quick
        from tribolab.qc.scan.checks import SCAN_CHECKS

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
        # late: starting stays quick
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
