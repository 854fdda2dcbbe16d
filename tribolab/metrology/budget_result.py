"""Result of an uncertainty budget, with a table for publication."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
import xarray as xr

from tribolab.core.attributes import SegmentAttributes
from tribolab.core.errors import AnalysisError
from tribolab.metrology.budget_parts import coverage_factor, part_name, part_words
from tribolab.reading.dialect.uncertainty import NAMES, Known


@dataclass(frozen=True, eq=False)
class UncertaintyBudget:
    """Uncertainty of friction coefficients, and the contributions to it.

    Parameters
    ----------
    data
        ``friction_coefficient`` with ``_u``, ``_dof`` and ``_U95`` over segments or sliding speeds;
        ``uncertainty_part`` (part, ...): signed change of the coefficient for one standard
        uncertainty of each input.
    known
        Stated uncertainties by name.
    """

    data: xr.Dataset
    known: Mapping[str, Known] = field(repr=False)

    @property
    def dim(self) -> str:
        """Dimension of the values: "segment" or "sliding_speed"."""
        return str(self.data["friction_coefficient"].dims[0])

    @property
    def caveats(self) -> str:
        """What the uncertainty omits, as text; "" if it is complete."""
        return SegmentAttributes.from_attrs(self.data.attrs).uncertainty_says

    def table(self, at: int | None = None) -> pd.DataFrame:
        """Return the budget table of one value, by default of a typical one.

        Parameters
        ----------
        at
            Number of the segment or of the speed, from 0; None for the value whose relative
            uncertainty is the median.

        Returns
        -------
        pandas.DataFrame
            A row for each part, the largest first, and one for the whole: ``part``, ``u`` (of the
            input, in its ``unit``), ``stated`` (its form), ``varies``, ``dof``, ``sensitivity``,
            ``contribution`` [1] and ``share`` [1] of the variance, ``source``. The last row has the
            combined uncertainty and its degrees of freedom; ``U95`` is an attribute.

        Raises
        ------
        AnalysisError
            If there is no such value.
        """
        index = self._index(at)
        parts = self.data["uncertainty_part"].values[:, index]
        dof = self.data["uncertainty_part_dof"].values[:, index]
        total = float(np.sum(parts**2))
        rows = []
        for i in np.argsort(-np.abs(parts), kind="stable"):
            name, size = str(self.data["part"].values[i]), float(parts[i])
            entry = self.known.get(name)
            rows.append(
                {
                    "part": part_words(name),
                    "u": entry.standard if entry else abs(size),
                    "unit": NAMES[part_name(name)][0] if entry else "1",
                    "stated": entry.distribution if entry else "from the data",
                    "varies": entry.varies if entry else "",
                    "dof": float(dof[i]),
                    "sensitivity": size / entry.standard if entry and entry.standard else 1.0,
                    "contribution": abs(size),
                    "share": size**2 / total if total else np.nan,
                    "source": entry.source if entry else "",
                }
            )
        mu, u, nu, wide = (
            float(self.data[f"friction_coefficient{end}"].values[index])
            for end in ("", "_u", "_dof", "_U95")
        )
        whole = {"part": "combined", "u": u, "unit": "1", "stated": "", "varies": "", "dof": nu}
        whole |= {"sensitivity": np.nan, "contribution": u, "share": 1.0, "source": self.caveats}
        table = pd.DataFrame([*rows, whole]).set_index("part")
        table.attrs = {"friction_coefficient": mu, "U95": wide, "k": float(coverage_factor(nu))}
        return table

    def _index(self, at: int | None) -> int:
        """Return the index of a value, by default of that with the median relative uncertainty."""
        mu, u = (self.data[f"friction_coefficient{end}"].values for end in ("", "_u"))
        if at is not None:
            if not -mu.size <= at < mu.size:
                raise AnalysisError(f"at: there are {mu.size} values, from 0; got {at}")
            return at
        with np.errstate(divide="ignore", invalid="ignore"):
            relative = np.abs(u / mu)
        fine = np.flatnonzero(np.isfinite(relative))
        if not fine.size:
            raise AnalysisError("no value has an uncertainty", function="table")
        return int(fine[np.argsort(relative[fine], kind="stable")[(fine.size - 1) // 2]])

    def _repr_html_(self) -> str:
        """Return HTML of a typical value with its uncertainty, what that omits, and the table."""
        table = self.table()
        mu, wide = table.attrs["friction_coefficient"], table.attrs["U95"]
        note = f"<br>{self.caveats}" if self.caveats else ""
        shown = table.to_html(float_format=lambda number: f"{number:.3g}")
        return f"<p><b>µ = {mu:.4g} ± {wide:.2g}</b> (95 %, the typical value){note}</p>{shown}"
