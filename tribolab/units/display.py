"""Units in the notebook display of tribolab's datasets."""

from __future__ import annotations

import html
import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import xarray as xr

_VARIABLE = re.compile(
    r"(<div class='xr-var-name'><span[^>]*>(.*?)</span></div><div class='xr-var-dims'>.*?</div>"
    r"<div class='xr-var-dtype'>)"
)
_NAME = re.compile(r"(<div class='xr-(?:array|obj)-name'>)(.*?)(</div>)")
_HOMES = (("xarray.core.dataset", "Dataset"), ("xarray.core.dataarray", "DataArray"))


def show_units() -> None:
    """Show units next to the variables of tribolab's datasets in the running notebook.

    Called by `import tribolab`; no effect outside a notebook. Other datasets keep the display of
    xarray.
    """
    # imported late: IPython loads slowly
    from IPython.core.getipython import get_ipython

    shell = get_ipython()
    formatters = getattr(getattr(shell, "display_formatter", None), "formatters", {})
    if "text/html" in formatters:
        for home, name in _HOMES:  # registered by name, so that xarray need not be loaded
            formatters["text/html"].for_type_by_name(home, name, add_units)


def add_units(data: xr.Dataset | xr.DataArray) -> str:
    """Return xarray's HTML of a dataset; each variable shows its unit in tribolab's datasets.

    Our datasets are recognised by a variable with our unit and long name.

    Examples
    --------
    >>> import xarray as xr
    >>> from tribolab.units.stamping import stamp
    >>> run = stamp(xr.Dataset({"friction_force": ("time", [1.0])}))
    >>> "N, float64" in run._repr_html_(), "N, float64" in add_units(run)
    (False, True)
    >>> other = xr.Dataset({"friction_force": ("time", [1.0], {"units": "N"})})
    >>> "N, float64" in add_units(other)
    False
    """
    text = data._repr_html_()
    if not _is_ours(data):
        return text
    own = getattr(data, "data_vars", {})

    def rewrite(match: re.Match[str]) -> str:
        name = html.unescape(match[2])
        holder: Any = data.coords if name in data.coords else own
        unit = holder[name].attrs.get("units") if name in holder else None
        return f"{match[1]}{html.escape(str(unit))}, " if unit else match[1]

    text = _VARIABLE.sub(rewrite, text)
    unit = "" if hasattr(data, "data_vars") else data.attrs.get("units", "")
    if unit:
        text = _NAME.sub(rf"\g<1>\g<2> [{html.escape(str(unit))}]\g<3>", text, count=1)
    return text


def _is_ours(data: xr.Dataset | xr.DataArray) -> bool:
    # imported late for a fast start
    from tribolab.units.quantities import QUANTITIES

    own: Any = data.data_vars if hasattr(data, "data_vars") else {data.name: data}
    for name, holder in {**data.coords, **own}.items():
        known = QUANTITIES.get(str(name))
        if known and (holder.attrs.get("units"), holder.attrs.get("long_name")) == (
            known.unit,
            known.long_name,
        ):
            return True
    return False
