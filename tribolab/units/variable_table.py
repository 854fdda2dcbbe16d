"""Table of the variables of a dataset, with their meaning and unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribolab.core.attributes import RunAttributes

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr


def variables(data: xr.Dataset | xr.DataArray) -> pd.DataFrame:
    """Return a table of the variables of a dataset: meaning, unit and range.

    Jupyter hides the units of a dataset behind an icon for each variable; here they are listed next
    to the names.

    Parameters
    ----------
    data
        A run, its segments, or any other result.

    Returns
    -------
    pandas.DataFrame
        A row for each variable, coordinates first: ``meaning``, ``unit`` (empty for text), ``dims``
        with their lengths, ``lowest`` and ``highest`` in that unit (for text the first and last
        value), and ``missing``, the number of NaN. For a run also ``column``, the name in the
        file.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace("sawtooth", samples=1000, speed=1e-5)
    >>> variables(run).loc["sliding_velocity", ["meaning", "unit", "dims"]].tolist()
    ['sliding velocity, signed', 'm/s', 'time (1000)']
    """
    # imported late: pandas loads slowly
    import pandas as pd
    import xarray as xr

    alone = isinstance(data, xr.DataArray)
    whole = data.to_dataset(name=data.name or "value") if alone else data
    names = [*whole.coords, *whole.data_vars]
    rows = {str(name): _row(whole[name]) for name in names}
    table = pd.DataFrame.from_dict(rows, orient="index")
    # format each number by itself: pandas would use the same digits for the whole column
    table = table.astype({"lowest": object, "highest": object})
    if called := RunAttributes.from_attrs(whole.attrs).columns_used:
        table["column"] = [called.get(name, "") for name in table.index]
    return table.rename_axis("variable")


def _row(variable: xr.DataArray) -> dict[str, object]:
    values = variable.to_numpy().ravel()
    missing = np.isnan(values) if values.dtype.kind == "f" else np.zeros(values.size, bool)
    known = values[~missing]
    low, high = None, None
    if known.size:
        ordered = known.dtype.kind in "fiub"
        ends = (known.min(), known.max()) if ordered else (known[0], known[-1])
        low, high = (end.item() if isinstance(end, np.generic) else end for end in ends)
    return {
        "meaning": variable.attrs.get("long_name", ""),
        "unit": variable.attrs.get("units", ""),
        "dims": ", ".join(f"{dim} ({size})" for dim, size in variable.sizes.items()),
        "lowest": low,
        "highest": high,
        "missing": int(missing.sum()),
    }
