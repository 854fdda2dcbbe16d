"""Zeros of the friction force lent by runs to others of the same instrument."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tribolab.core.attributes import SegmentAttributes
from tribolab.friction.decisions.rejected import kept
from tribolab.records.parts import RunZero

if TYPE_CHECKING:
    import xarray as xr

_OWN = "own_zero_N"  # attribute of a friction result: its zero, if certain
# attribute of a result without its own zero: zeros of other runs, may be empty
_LENT = "zeros_of_other_runs_N"
_MIN_ZEROS = 2  # smallest number of other zeros to estimate their scatter
_DIGITS = 6


def attributes(friction: xr.Dataset, lent: Iterable[float]) -> dict[str, str | float]:
    """Return the attributes of a friction result from which `zero_of` reads the zero."""
    about = SegmentAttributes.from_attrs(friction.attrs)
    method, sure = about.offset, all(d["status"] == "pass" for d in about.zero_doubts)
    friction = kept(friction)
    if method in ("half loop", "zero load") and sure and "friction_force_offset" in friction:
        zeros = friction["friction_force_offset"].values
        if np.isfinite(zeros).any():
            return {_OWN: float(np.nanmedian(zeros))}
    if "friction_force_offset" in friction and method.startswith(("none: no pair", "other runs")):
        return {_LENT: zeros_text(lent)}
    return {}


def zero_of(attrs: Mapping[str, Any], run: Mapping[str, Any], stated: str | None) -> RunZero:
    """Return the zero of a run from the attributes of its friction result.

    Parameters
    ----------
    attrs
        Attributes of the friction result.
    run
        Attributes of the run: the instrument of the file, and its layout if that was drafted from
        the file.
    stated
        Dialect named in the campaign: two files of one name may be two instruments.
    """
    recorded = f"{run.get('instrument', '')} {run.get('drafted_layout', '')}".strip()
    instrument = stated if stated and stated.endswith((".toml", ".py")) else recorded
    own = attrs.get(_OWN)
    lent = attrs.get(_LENT)
    return RunZero(instrument, None if own is None else float(own), lent)


def zeros_text(zeros: Iterable[float]) -> str:
    """Return zeros as a text, rounded, for comparison."""
    return "; ".join(f"{zero:.{_DIGITS}g}" for zero in zeros)


def lent_zeros(zeros: Mapping[str, RunZero | None]) -> dict[str, tuple[float, ...]]:
    """Return the runs to be repeated, with the zeros of others.

    Parameters
    ----------
    zeros
        Zero by name of the run, in the order of the campaign; None for a failed run.

    Examples
    --------
    >>> one, two = RunZero("rig", 0.5, None), RunZero("rig", 0.7, None)
    >>> lent_zeros({"a": one, "b": two, "c": RunZero("rig", None, ""), "d": RunZero("x", None, "")})
    {'c': (0.5, 0.7)}
    >>> unknown = RunZero("", None, "")
    >>> nameless = {name: zero._replace(instrument="") for name, zero in (("a", one), ("b", two))}
    >>> lent_zeros({**nameless, "c": unknown})
    {}
    """
    again = {}
    for name, zero in zeros.items():
        if zero is None or zero.lent is None:
            continue
        others = tuple(
            other.own
            for other in zeros.values()
            # a file without a dialect may be of any instrument
            if other and other.own is not None and zero.instrument == other.instrument != ""
        )
        others = others if len(others) >= _MIN_ZEROS else ()
        if zeros_text(others) != zero.lent:
            again[name] = others
    return again
