"""Roughness of surfaces in one line, as on drawings and instruments."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tribolab.core.coverage import NORMAL
from tribolab.core.wording import Count, number
from tribolab.records.parts import Row, number_of
from tribolab.records.wording import error_text

_BEND = 0.1  # share of Pq below which a circle is negligible
_MAX_LISTED = 5  # surfaces that are listed
FORM = "form"  # topic of a finding on form that may be waviness
_FORMS = {"polynomial": "polynomial of degree 2"}


def form_in_words(row: Row, *, radius: bool = True) -> str:
    """Name of the form removed from a surface's scans; "" if unknown.

    Examples
    --------
    >>> form_in_words({"form_removed": "circle", "form_radius_m": 0.0702})
    'circle of R = 0.0702 m taken off'

    A circle with negligible curvature counts as tilt:

    >>> flat = {"form_radius_m": 400.0, "evaluation_length_m": 4e-3, "Pq_m": 1e-6}
    >>> form_in_words({"form_removed": "circle"} | flat)
    'tilt and a faint bend (R = 400 m) taken off'
    >>> form_in_words({"form_removed": "none"}), form_in_words({"form_removed": "tilt"})
    ('no form taken off', 'tilt taken off')
    """
    form = str(row.get("form_removed") or "")
    if form in ("", "none"):
        return "no form taken off" if form else ""
    size = number_of(row, "form_radius_m")
    length, all_waves = (number_of(row, key) for key in ("evaluation_length_m", "Pq_m"))
    if form == "circle" and size and hardly_bends(size, length, all_waves):
        return f"tilt and a faint bend{f' (R = {number(size)} m)' if radius else ''} taken off"
    of = f" of R = {number(size)} m" if radius and size is not None and math.isfinite(size) else ""
    return f"{_FORMS.get(form, form)}{of} taken off"


def hardly_bends(radius: float, length: float | None, roughness: float | None) -> bool:
    """Return whether the sag of a circle [m] over a length [m] is far below Pq [m].

    >>> hardly_bends(400.0, 4e-3, 1e-6), hardly_bends(0.07, 4e-3, 1e-6)
    (True, False)
    """
    if length is None or roughness is None:
        return False
    return length**2 / (8 * abs(radius)) < _BEND * roughness


def roughness_in_words(rows: Iterable[tuple[str, Row]]) -> list[str]:
    """Return text lines of Rq and Ra, or Sq and Sa, for each form and cut-off.

    Parameters
    ----------
    rows
        Name of a surface and its roughness, as in the table of that name.

    Examples
    --------
    >>> roughness_in_words([("fine", {"Rq_m": 1e-7}), ("rough", {"Rq_m": 2e-6, "Ra_m": 1.6e-6})])
    ['Rq (no cut-off): fine 0.1 µm, rough 2 µm (Ra 1.6 µm)']
    >>> roll = {"Rq_m": 1e-7, "Rq_sem_m": 2e-9, "lambda_c_m": 8e-4, "form_removed": "circle"}
    >>> roughness_in_words([("roll", roll | {"sampling_lengths": 4})])
    ['Rq ± U95 (circle taken off, cut-off 0.8 mm, 4 sampling lengths): roll 0.100 ± \
0.006 µm']
    >>> roughness_in_words([("map", {"Sq_m": 1e-6, "Rq_m": 9e-7, "form_removed": "polynomial"})])
    ['Sq (polynomial of degree 2 taken off): map 1 µm']
    """
    by_heading: dict[str, list[str]] = {}
    for name, row in rows:
        if number_of(row, "Sq_m") is not None:  # for a map: over its area, not its rows
            form = form_in_words(row, radius=False)
            heading = f"Sq ({form})" if form else "Sq"
            text = _roughness_text(row, "Sq", "Sa")
        elif number_of(row, "Rq_m") is not None:
            text = _roughness_text(row, "Rq", "Ra")
            heading = f"Rq{' ± U95' if '±' in text else ''} ({_evaluation_text(row)})"
        else:
            continue
        by_heading.setdefault(heading, []).append(f"{name} {text}")
    return [
        f"{what}: {', '.join(names[:_MAX_LISTED])}"
        + (f" and {len(names) - _MAX_LISTED} more" if len(names) > _MAX_LISTED else "")
        for what, names in by_heading.items()
    ]


def roughness_u95(row: Row, name: str) -> float:
    """Return U95 [m] of a roughness parameter; 0 if its error is unknown.

    From Student's t over the scans or, for a single profile, its sampling lengths; the error due to
    missing heights if larger.

    Examples
    --------
    >>> round(roughness_u95({"scans": 3, "Ra_sem_m": 1e-9}, "Ra") * 1e9, 2)
    4.3
    """
    from scipy import special  # imported late for a quick start

    scatter, gaps = (number_of(row, f"{name}_{what}_m") or 0.0 for what in ("sem", "gap_error"))
    scans = number_of(row, "scans") or 1.0
    parts = scans if scans > 1 else number_of(row, "sampling_lengths") or 2.0
    freedom = max(parts - 1.0, 1.0)
    return max(float(special.stdtrit(freedom, 0.975)) * scatter, NORMAL * gaps)


def _evaluation_text(row: Row) -> str:
    """Return the cut-off and form removed from a profile, and its sampling lengths, as text."""
    cut, lengths = number_of(row, "lambda_c_m"), number_of(row, "sampling_lengths")
    parts = [form_in_words(row, radius=False)]
    parts.append("no cut-off" if cut is None else f"cut-off {1e3 * cut:.3g} mm")
    if cut is not None and lengths is not None:
        parts.append(f"{Count(int(lengths)):sampling length|sampling lengths}")
    return ", ".join(filter(None, parts))


def _roughness_text(row: Row, quadratic: str, mean: str) -> str:
    """Return rms roughness with its error, followed by the mean deviation, as text."""
    value, behind = (number_of(row, f"{name}_m") for name in (quadratic, mean))
    error = roughness_u95(row, quadratic)
    scaled = 1e6 * (value or 0.0)
    text = error_text(scaled, 1e6 * error) if error else f"{scaled:.3g}"
    return f"{text} µm" + (f" ({mean} {1e6 * behind:.3g} µm)" if behind is not None else "")
