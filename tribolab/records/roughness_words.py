"""The roughness of surfaces in a line, as drawings and instruments state it."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tribolab.records.parts import Row, number_of
from tribolab.records.wording import with_error
from tribolab.words import number

_MOST = 5  # surfaces that are named
_FORMS = {"polynomial": "polynomial of degree 2"}


def form_in_words(row: Row, *, radius: bool = True) -> str:
    """Return which form was taken off a surface's scans; "" if that is not known.

    Examples
    --------
    >>> form_in_words({"form_removed": "circle", "form_radius_m": 0.0702})
    'circle of R = 0.0702 m taken off'
    >>> form_in_words({"form_removed": "none"}), form_in_words({"form_removed": "tilt"})
    ('no form taken off', 'tilt taken off')
    """
    form = str(row.get("form_removed") or "")
    if form in ("", "none"):
        return "no form taken off" if form else ""
    size = number_of(row, "form_radius_m")
    of = f" of R = {number(size)} m" if radius and size is not None and math.isfinite(size) else ""
    return f"{_FORMS.get(form, form)}{of} taken off"


def roughness_in_words(rows: Iterable[tuple[str, Row]]) -> list[str]:
    """Return Rq of surfaces, and Sq of maps, a line for each form and cut-off.

    Parameters
    ----------
    rows
        Name of a surface and its roughness, as in the table of that name.

    Examples
    --------
    >>> roughness_in_words([("fine", {"Rq_m": 1e-7}), ("rough", {"Rq_m": 2e-6, "Rq_sem_m": 1e-7})])
    ['Rq (no cut-off): fine 0.1 µm, rough 2.00 ± 0.10 µm']
    >>> roughness_in_words([("roll", {"Rq_m": 1e-7, "lambda_c_m": 8e-4, "form_removed": "circle"})])
    ['Rq (circle taken off, cut-off 0.8 mm): roll 0.1 µm']
    >>> roughness_in_words([("map", {"Sq_m": 1e-6, "Rq_m": 9e-7, "form_removed": "polynomial"})])
    ['Sq (polynomial of degree 2 taken off): map 1 µm']
    """
    told: dict[str, list[str]] = {}
    for name, row in rows:
        if (sq := number_of(row, "Sq_m")) is not None:  # of a map: of its area, not of its rows
            form = form_in_words(row, radius=False)
            told.setdefault(f"Sq ({form})" if form else "Sq", []).append(
                f"{name} {1e6 * sq:.3g} µm"
            )
            continue
        if (rq := number_of(row, "Rq_m")) is None:
            continue
        cut = number_of(row, "lambda_c_m")
        by = "no cut-off" if cut is None else f"cut-off {1e3 * cut:.3g} mm"
        if form := form_in_words(row, radius=False):
            by = f"{form}, {by}"
        error = max(number_of(row, f"Rq_{what}_m") or 0.0 for what in ("sem", "gap_error"))
        said = with_error(1e6 * rq, 1e6 * error) if error else f"{1e6 * rq:.3g}"
        told.setdefault(f"Rq ({by})", []).append(f"{name} {said} µm")
    return [
        f"{what}: {', '.join(names[:_MOST])}"
        + (f" and {len(names) - _MOST} more" if len(names) > _MOST else "")
        for what, names in told.items()
    ]
