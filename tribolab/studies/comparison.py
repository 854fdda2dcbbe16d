"""Comparison of the numbers printed in the paper with computed ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import pandas as pd

from tribolab.core.errors import AnalysisError, nearest
from tribolab.studies import comparison_contact, comparison_lubrication, xu2026
from tribolab.studies.published import Published
from tribolab.studies.theory import Theory
from tribolab.studies.verdict import BOUNDS, Computed, Measured, Own, verdict_on

_COLUMNS = [
    "quantity",
    "surface",
    "condition",
    "published",
    "computed",
    "relative_difference",
    "tolerance",
    "status",
    "note",
]

_COMPUTE: dict[str, Callable[[Published, Theory], Computed | Measured]] = {
    **comparison_contact.COMPUTE_CONTACT,
    **comparison_lubrication.COMPUTE_LUBRICATION,
}
_OWN: dict[str, Callable[[Published], Own | None]] = {
    **comparison_contact.OWN_CONTACT,
    **comparison_lubrication.OWN_LUBRICATION,
}


def compare_with_paper(rows: Sequence[Published] = xu2026.published) -> pd.DataFrame:
    """Return the published numbers of the paper, compared with computed ones.

    Parameters
    ----------
    rows
        Published numbers.

    Returns
    -------
    pandas.DataFrame
        A row for each published number: quantity, surface, condition, published (text with unit),
        computed (in the same unit), relative_difference, tolerance, status (reproduced | by
        construction | within a wide tolerance | differs | published value inconsistent |
        measured, not computed) and a note. Quantities that cannot be computed have no computed
        value, difference and tolerance; bounds have no relative difference.

    Raises
    ------
    AnalysisError
        If a quantity is unknown.

    Notes
    -----
    Contact is computed at the exact mean Hertz pressure of each load (the paper rounds it), with
    the stand-in spectra of `tribolab.studies.xu2026`.

    Examples
    --------
    >>> rows = [row for row in xu2026.published if row.quantity == "nominal_pressure"]
    >>> compare_with_paper(rows).loc[0, ["published", "computed", "status"]].tolist()
    ['0.042 MPa', '0.0417 MPa', 'reproduced']
    """
    theory = Theory()
    compared = []
    for row in rows:
        if row.quantity not in _COMPUTE:
            hint = nearest(row.quantity, _COMPUTE)
            raise AnalysisError(f"published {row.quantity}: no way to compute it is known{hint}")
        computed = _COMPUTE[row.quantity](row, theory)
        own = _OWN[row.quantity](row) if row.quantity in _OWN else None
        verdict = verdict_on(row, computed, own)
        compared.append(
            {
                "quantity": row.quantity,
                "surface": row.surface,
                "condition": row.condition,
                **_numbers(row, computed),
                "status": verdict.status,
                "note": verdict.note,
            }
        )
    return pd.DataFrame(compared, columns=_COLUMNS)


def _numbers(row: Published, computed: Computed | Measured) -> dict[str, str | float]:
    """Return the published and computed number in the printed unit, and their difference."""
    percent = 0.01 if "%" in row.text else 1.0
    unit = "" if row.unit == "1" else f" {row.unit}"
    if isinstance(computed, Measured):
        value, difference, tolerance = "", math.nan, math.nan
    else:
        value = (
            f"{computed.value / row.factor / percent:.4g}" + (" %" if percent < 1 else "") + unit
        )
        difference = computed.value / row.si - 1 if row.si else math.nan
        tolerance = computed.tolerance
        # bounds are met or not, so they have no relative difference
        if row.relation.startswith(BOUNDS):
            difference = math.nan
    return {
        "published": row.text + unit,
        "computed": value,
        "relative_difference": difference,
        "tolerance": tolerance,
    }
