"""tribolab: a workbench for friction experiments on soft, rough contacts.

Raw files in; friction coefficients with honest error bars and a report out. Every step
is a plain function on xarray datasets, in SI units::

    import tribolab as tl

    run = tl.read("raw/sb-r_glycerol_31N_01_force.csv")
    segments = tl.find_segments(run, trim=0.10)
    mu = tl.friction_coefficient(run, segments)
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

# Public name -> the module it lives in; "" for a module itself. Loaded when first used, so that
# `import tribolab` costs nothing.
_PUBLIC = {
    "read": "tribolab.io.runs",
    "read_netcdf": "tribolab.io.netcdf",
    "write_netcdf": "tribolab.io.netcdf",
    "find_segments": "tribolab.friction.segments",
    "friction_coefficient": "tribolab.friction.coefficient",
    "half_loops": "tribolab.friction.coefficient",
    "measured_stribeck_curve": "tribolab.friction.stribeck",
    "load_campaign": "tribolab.campaign.config",
    "run_campaign": "tribolab.report.run",
    "TribolabError": "tribolab.errors",
    "plot": "",
    "rig": "",
    "studies": "",
}

__all__ = [
    "__version__",
    "read",
    "read_netcdf",
    "write_netcdf",
    "find_segments",
    "friction_coefficient",
    "half_loops",
    "measured_stribeck_curve",
    "load_campaign",
    "run_campaign",
    "TribolabError",
    "plot",
    "rig",
    "studies",
]

if TYPE_CHECKING:
    from tribolab import plot, rig, studies
    from tribolab.campaign.config import load_campaign
    from tribolab.errors import TribolabError
    from tribolab.friction.coefficient import friction_coefficient, half_loops
    from tribolab.friction.segments import find_segments
    from tribolab.friction.stribeck import measured_stribeck_curve
    from tribolab.io.netcdf import read_netcdf, write_netcdf
    from tribolab.io.runs import read
    from tribolab.report.run import run_campaign


def __getattr__(name: str) -> Any:
    if name not in _PUBLIC:
        raise AttributeError(f"module 'tribolab' has no attribute '{name}'")
    home = _PUBLIC[name]
    value = (
        getattr(importlib.import_module(home), name)
        if home
        else importlib.import_module(f"tribolab.{name}")
    )
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
