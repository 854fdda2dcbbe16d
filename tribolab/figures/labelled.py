"""Arguments of figures with several results: a mapping, a list, or a dataset with more dims."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from tribolab.core.errors import AnalysisError, shown

RunLabel = str | float
OneOrSeveral = Mapping[str, xr.Dataset] | xr.Dataset | Sequence[xr.Dataset]


def by_label(
    results: OneOrSeveral, labels: Mapping[str, Sequence[RunLabel]], known: str
) -> dict[str, xr.Dataset]:
    """Return results given as a mapping, a list or a dataset as a dictionary by label.

    Parameters
    ----------
    results
        Results by label; or one result, perhaps with further dims; or a list of results.
    labels
        For a list: label of each result, by kind of label; by default they are numbered.
    known
        The dim of a single result.

    Raises
    ------
    AnalysisError
        If a list does not have one label per result.

    Examples
    --------
    >>> data = xr.Dataset({"waveform": (("run", "segment"), [["saw"], ["sine"]])}, {"run": [1, 2]})
    >>> list(by_label(data, {}, "segment")), list(by_label([data], {"medium": ["dry"]}, "segment"))
    (['1', '2'], ['dry'])
    """
    if isinstance(results, xr.Dataset):
        return parts(results, known)
    if not isinstance(results, Sequence):
        return dict(results)
    for name, given in labels.items():
        if isinstance(given, str) or len(given) != len(results):
            raise AnalysisError(
                f"{shown(name)}: one label for each of {len(results)} results is wanted"
            )
    rows = list(zip(*labels.values(), strict=True)) or [(k + 1,) for k in range(len(results))]
    names = [", ".join(map(str, row)) for row in rows]
    if len({*names}) < len(names):
        raise AnalysisError("labels: two results have the same; give others, or one more kind")
    return dict(zip(names, results, strict=True))


def parts(results: xr.Dataset, known: str) -> dict[str, xr.Dataset]:
    """Split a dataset along all dims except `known`, and return its parts by label.

    Parameters
    ----------
    results
        Dataset with ``waveform`` (`known`, further dims); without further dims it is the only part.
    known
        The dim of a single result.
    """
    dims = [dim for dim in results["waveform"].dims if dim != known]
    named = {}
    for place in np.ndindex(*(results.sizes[dim] for dim in dims)):
        part = results.isel(dict(zip(dims, place, strict=True)))
        words = [str(part[dim].item() if dim in part.coords else k + 1)
                 for dim, k in zip(dims, place, strict=True)]  # fmt: skip
        named[", ".join(words)] = part
    return named


# datasets by name of the surface, or one dataset for all surfaces
SurfaceOrSeveral = Mapping[str, xr.Dataset] | xr.Dataset


def by_surface(data: SurfaceOrSeveral) -> dict[str, xr.Dataset]:
    """Return the data of each surface by its name; a dataset with the dim ``surface`` is split.

    Each surface keeps its own wavenumbers.
    """
    if not isinstance(data, xr.Dataset):
        return dict(data)
    if "surface" not in data.dims:
        return {str(data.attrs.get("surface", "")): data}
    separate = {str(name): data.sel(surface=name, drop=True) for name in data["surface"].to_numpy()}
    if "wavenumber" not in data.dims:
        return separate
    return {name: part.dropna("wavenumber", how="all") for name, part in separate.items()}


def by_load(data: xr.Dataset) -> list[tuple[float | None, xr.Dataset]]:
    """Return each load's normal force [N] (None if unknown) and the results at this load."""
    if "load" not in data.dims:
        return [(None, data)]
    separate = [data.isel(load=k) for k in range(data.sizes["load"])]
    forces = [p["normal_force"].item() if "normal_force" in p else None for p in separate]
    return [
        (None if force is None else round(float(force), 6), part)
        for force, part in zip(forces, separate, strict=True)
    ]
