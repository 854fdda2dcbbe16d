"""Decorators that make functions of one run or dataset accept lists or further dimensions."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Hashable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ParamSpec, Protocol, TypeVar, overload

import numpy as np

from tribolab.core.errors import AnalysisError, Cure
from tribolab.core.untyped import Arguments
from tribolab.core.validity import together

if TYPE_CHECKING:
    import xarray as xr

P = ParamSpec("P")
R = TypeVar("R")
R_co = TypeVar("R_co", covariant=True)


class OfRuns(Protocol[P, R]):
    """Type of a function of one run that returns a list of results for a list of runs."""

    @overload
    def __call__(self, runs: list[xr.Dataset], /, *args: Any, **kwargs: Any) -> list[R]: ...

    @overload
    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R: ...


def of_runs(function: Callable[P, R], public_name: str = "") -> OfRuns[P, R]:
    """Extend a function of one run to lists of runs, for which it returns a list of results.

    Other arguments that are lists of datasets are paired with the runs; the rest apply to all.

    Examples
    --------
    >>> @of_runs
    ... def length(run, unit="s"):
    ...     return f"{float(run.time[-1])} {unit}"
    >>> import xarray as xr
    >>> runs = [xr.Dataset(coords={"time": [0.0, end]}) for end in (1, 2)]
    >>> length(runs[0]), length(runs, unit="sec")
    ('1.0 s', ['1.0 sec', '2.0 sec'])
    >>> length("run.csv")
    Traceback (most recent call last):
    tribolab.core.errors.AnalysisError: length was given the text 'run.csv' as run; read the file \
first: tl.read('run.csv')
    """
    name = public_name or function.__name__
    of_a_run = next(iter(inspect.signature(function).parameters)) == "run"

    @functools.wraps(function)
    def with_lists(*args: Any, **kwargs: Any) -> Any:
        for run in args[:1] if of_a_run else ():
            for each in run if isinstance(run, list) else [run]:
                _require_run(name, each)
        if not args or not isinstance(args[0], list):
            return function(*args, **kwargs)
        count = len(args[0])
        given: dict[Any, Any] = {**dict(enumerate(args)), **kwargs}
        own = {key: value for key, value in given.items() if _of_datasets(value)}
        for key, value in own.items():
            if len(value) != count:
                raise AnalysisError(
                    f"{name}: {count} runs are given, and {len(value)} datasets as "
                    f"{_name(function, key)}; give one for each run"
                )
        return [
            _call_with_entry(function, given, own, len(args), number) for number in range(count)
        ]

    return with_lists


def _require_run(function: str, given: Any) -> None:
    """Raise an error if the argument for the run is not a run."""
    if isinstance(given, str | Path):
        raise AnalysisError(
            f"{function} was given the text '{given}' as run",
            cure=Cure(notebook=f"read the file first: tl.read('{given}')"),
        )
    sizes = getattr(given, "sizes", None)
    if type(given).__name__ != "Dataset" or sizes is None:
        raise AnalysisError(
            f"{function} was given an object of type {type(given).__name__} as run",
            cure=Cure(notebook="give what tl.read returns, an xarray.Dataset over time"),
        )
    if "time" not in sizes and "segment" in sizes:
        raise AnalysisError(
            f"{function} was given segments as run",
            cure=Cure(notebook=f"give the run first: tl.{function}(run, segments)"),
        )


class OfLists(Protocol[P, R_co]):
    """Type of a function that returns a list of results if arguments are lists."""

    @overload
    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R_co: ...

    @overload
    def __call__(self, *args: Any, **kwargs: Any) -> list[R_co]: ...


def of_lists(*names: str, paired: str = "") -> Callable[[Callable[P, R]], OfLists[P, R]]:
    """Return a decorator that lets arguments of a function be lists; it then returns a list.

    Parameters
    ----------
    *names
        Arguments that may be lists; single values apply to all.
    paired
        Another argument: its list is split among the calls if one of `names` is a list, and else
        passed as a whole.

    Examples
    --------
    >>> @of_lists("load", "speed")
    ... def named(load, speed, unit="N"):
    ...     return f"{load} {unit}, {speed}"
    >>> named(31, speed=["slow", "fast"])
    ['31 N, slow', '31 N, fast']
    """

    def decorate(function: Callable[P, R]) -> OfLists[P, R]:
        places = list(inspect.signature(function).parameters)

        @functools.wraps(function)
        def with_lists(*args: Any, **kwargs: Any) -> Any:
            given = dict(zip(places, args, strict=False)) | kwargs
            own = {name: given[name] for name in names if isinstance(given.get(name), list)}
            if not own:
                return function(*args, **kwargs)
            if isinstance(given.get(paired), list):
                own[paired] = given[paired]
            counts = {name: len(value) for name, value in own.items()}
            if len({*counts.values()}) > 1:
                sizes = ", ".join(f"{count} for {name}" for name, count in counts.items())
                raise AnalysisError(f"{function.__name__}: lists of one length are wanted: {sizes}")
            count = next(iter(counts.values()))
            return [_call_with_entry(function, given, own, 0, number) for number in range(count)]

        return with_lists

    return decorate


def _call_with_entry(
    function: Callable[..., R],
    given: Mapping[Any, Any],
    own: Mapping[Any, Sequence[Any]],
    placed: int,
    number: int,
) -> R:
    """Return the result of a function for the entries at index `number` of all lists."""
    mine = {key: own[key][number] if key in own else value for key, value in given.items()}
    places = [mine.pop(place) for place in range(placed)]
    return function(*places, **mine)


def _of_datasets(value: Any) -> bool:
    # compared by name, so that xarray need not be loaded
    return isinstance(value, list) and all(type(item).__name__ == "Dataset" for item in value)


def _name(function: Callable[..., Any], key: int | str) -> str:
    return key if isinstance(key, str) else f"'{list(inspect.signature(function).parameters)[key]}'"


def over_dims(**own: tuple[str, ...]) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator that lets arguments have further dimensions, which the result then has.

    Parameters
    ----------
    **own
        The arguments that may have further dims, with the dims that the function itself handles.

    Notes
    -----
    The function is called once for each position along the further dims. Wavenumbers without a
    value are left out, so that spectra on different wavenumbers can share one dataset. The validity
    attributes of the results are combined.

    Examples
    --------
    >>> import xarray as xr
    >>> @over_dims(psd=("wavenumber",))
    ... def highest(psd):
    ...     return psd.psd_2d.max()
    >>> psd = xr.Dataset({"psd_2d": (("surface", "wavenumber"), [[1.0, 2.0], [5.0, 4.0]])})
    >>> highest(psd).values, highest(psd.isel(surface=0)).item()
    (array([2., 5.]), 2.0)
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        places = list(inspect.signature(function).parameters)

        @functools.wraps(function)
        def with_dims(*args: P.args, **kwargs: P.kwargs) -> R:
            given = dict(zip(places, args, strict=False)) | kwargs
            further = [
                dim
                for name, known in own.items()
                for dim in _dims(given.get(name))
                if dim not in known
            ]
            if not further:
                return function(*args, **kwargs)
            return _apply_along(with_dims, given, further[0])

        return with_dims

    return decorate


def _dims(value: Any) -> tuple[Hashable, ...]:
    """Return the dimensions of an argument, or of the spectrum if it is a dataset with one."""
    holder = value["psd_2d"] if "psd_2d" in getattr(value, "data_vars", ()) else value
    return tuple(getattr(holder, "dims", ()))


def _apply_along(function: Callable[..., Any], given: Arguments, dim: Hashable) -> Any:
    """Return the results of a function at each position along a dimension, in one object."""
    # imported late: xarray loads slowly
    import xarray as xr

    having = {name: value for name, value in given.items() if dim in getattr(value, "dims", ())}
    first = next(iter(having.values()))
    results = []
    for place in range(first.sizes[dim]):
        cut = {
            name: _drop_missing(value.isel({dim: place}, drop=True))
            for name, value in having.items()
        }
        result = function(**(given | cut))
        known = isinstance(result, xr.Dataset | xr.DataArray)
        results.append(result if known else _array(result, function.__name__))
    index = first[dim] if dim in first.coords else xr.DataArray(range(len(results)), dims=[dim])
    joined = xr.concat(
        results, index, data_vars="all", coords="different", compat="equals", join="outer",
        combine_attrs="drop_conflicts",
    )  # fmt: skip
    if any("validity" in result.attrs for result in results):
        joined.attrs |= together(result.attrs for result in results)
    return joined


def stated_value(value: str | float | xr.DataArray) -> str | float:
    """Return an array without dimensions as a number; other values are returned unchanged."""
    return float(value.item()) if hasattr(value, "item") else value


def _drop_missing(value: Any) -> Any:
    """Return the data of one condition without missing wavenumbers or segments."""
    if not hasattr(value, "data_vars"):
        return value
    for dim in {"wavenumber", "segment"} & {*value.dims}:
        value = value.dropna(dim, how="all")
    return value


def _array(result: Any, who: str) -> Any:
    # imported late: xarray loads slowly
    import xarray as xr

    if np.ndim(result):
        raise AnalysisError(
            f"{who}: where further dims come in, arrays must name theirs",
            cure=Cure(notebook='give e.g. xr.DataArray(pressure, dims="pressure")'),
        )
    return xr.DataArray(result)
