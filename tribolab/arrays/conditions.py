"""Results for several conditions (surfaces, media or loads) with their labels."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Generic, Self, TypeVar

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError

Selected = TypeVar("Selected")
ConditionLabels = dict[Hashable, Any]


@dataclass(frozen=True, eq=False)
class Conditions(Generic[Selected]):
    """Results of one kind, one for each condition.

    Parameters
    ----------
    results
        Result of each condition; None if not measured.

    Examples
    --------
    >>> results = Conditions.of({"surface": ["a", "b"]}, lambda labels: labels["surface"] * 2)
    >>> results.sel(surface="b"), [labels for labels, result in results]
    ('bb', [{'surface': 'a'}, {'surface': 'b'}])
    """

    results: xr.DataArray

    @classmethod
    def of(
        cls, coords: Mapping[Hashable, Any], compute: Callable[[ConditionLabels], Selected | None]
    ) -> Self:
        """Return the results of a function for all conditions.

        Parameters
        ----------
        coords
            The labels along each dim.
        compute
            Function from labels to a result; None if not measured.
        """
        results = np.empty([len(values) for values in coords.values()], dtype=object)
        for place in np.ndindex(results.shape):
            labels = {dim: coords[dim][k] for dim, k in zip(coords, place, strict=True)}
            results[place] = compute(labels)
        return cls(xr.DataArray(results, coords, tuple(coords)))

    def sel(self, **labels: object) -> Selected | Self:
        """Return the result of one or several conditions, as `xarray.DataArray.sel` does.

        Raises
        ------
        AnalysisError
            If this condition was not measured.
        """
        chosen = self.results.sel(labels, drop=True)
        if chosen.dims:
            return type(self)(chosen)
        result: Selected | None = chosen.item()
        if result is None:
            raise AnalysisError(f"nothing was measured at {labels_text(labels)}")
        return result

    def __iter__(self) -> Iterator[tuple[ConditionLabels, Selected]]:
        """Yield labels and result of each condition that was measured."""
        for place in np.ndindex(self.results.shape):
            part = self.results[place]
            if part.item() is not None:
                yield {dim: part[dim].item() for dim in self.results.dims}, part.item()


def labels_text(labels: Mapping[Any, object]) -> str:
    """Return labels as text, with the names of their dimensions.

    Examples
    --------
    >>> labels_text({"surface": "Sb-R", "normal_force": 31.0})
    'surface Sb-R, normal_force 31.0'
    """
    return ", ".join(f"{dim} {label}" for dim, label in labels.items())


def labels_along(holder: xr.DataArray, dim: Hashable) -> np.ndarray:
    """Return the labels along a dimension; without labels, numbers from 0."""
    return holder[dim].to_numpy() if dim in holder.coords else np.arange(holder.sizes[dim])
