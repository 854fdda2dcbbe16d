"""tribolab: a workbench for friction experiments on soft, rough contacts.

Raw files in; friction coefficients with honest error bars and a report out. Every step
is a plain function on xarray datasets, in SI units::

    import tribolab as tl

    run = tl.read("raw/sb-r_glycerol_31N_01_force.csv")
    segments = tl.find_segments(run, trim=0.10)
    mu = tl.friction_coefficient(run, segments)

What most analyses need is here; the rest is in groups: `tl.contact`, `tl.surface`, `tl.plot`, ...
"""

from __future__ import annotations

import importlib
import sys
import warnings
from typing import TYPE_CHECKING, Any

from tribolab.core.moved import accept_old_paths
from tribolab.version import __version__

# Public name -> its module. Loaded when first used, so that `import tribolab` costs nothing.
_PUBLIC = {
    "read": "tribolab.reading.run_files",
    "read_scans": "tribolab.reading.scan_files",
    "read_results": "tribolab.report.results_folder",
    "variables": "tribolab.units.variable_table",
    "check": "tribolab.qc.any_data",
    "find_segments": "tribolab.friction.segments.find",
    "decide": "tribolab.friction.decisions.decided_segments",
    "friction_coefficient": "tribolab.friction.coefficient.coefficient",
    "running_in": "tribolab.friction.running_in.history",
    "static_friction": "tribolab.friction.coefficient.static",
    "stick_slip": "tribolab.friction.oscillation.slip_segments",
    "measured_stribeck_curve": "tribolab.friction.stribeck",
    "roughness_parameters": "tribolab.surface.roughness",
    "LineContact": "tribolab.contact.geometry",
    "PointContact": "tribolab.contact.geometry",
    "Liquid": "tribolab.lubrication.parameters",
    "stribeck_curve": "tribolab.lubrication.stribeck",
    "fit_shear_stress": "tribolab.fit.shear_stress",
    "run_campaign": "tribolab.app.run",
    "compare": "tribolab.comparison.comparison",
    "TribolabError": "tribolab.core.errors",
}

_GROUPS = tuple(
    "reading friction surface contact rubber lubrication fit regime metrology qc plot campaign "
    "comparison archive rig studies".split()
)

_GROUPS_OF_FORMER_NAMES = [name for name in _GROUPS if name not in ("plot", "rig", "studies")]

__all__ = [
    "__version__",
    "read",
    "read_scans",
    "read_results",
    "variables",
    "check",
    "find_segments",
    "decide",
    "friction_coefficient",
    "running_in",
    "static_friction",
    "stick_slip",
    "measured_stribeck_curve",
    "roughness_parameters",
    "LineContact",
    "PointContact",
    "Liquid",
    "stribeck_curve",
    "fit_shear_stress",
    "run_campaign",
    "compare",
    "TribolabError",
    "reading",
    "friction",
    "surface",
    "contact",
    "rubber",
    "lubrication",
    "fit",
    "regime",
    "metrology",
    "qc",
    "plot",
    "campaign",
    "comparison",
    "archive",
    "rig",
    "studies",
]

if TYPE_CHECKING:
    from tribolab import (
        archive,
        campaign,
        comparison,
        contact,
        fit,
        friction,
        lubrication,
        metrology,
        plot,
        qc,
        reading,
        regime,
        rig,
        rubber,
        studies,
        surface,
    )
    from tribolab.app.run import run_campaign
    from tribolab.comparison.comparison import compare
    from tribolab.contact.geometry import LineContact, PointContact
    from tribolab.core.errors import TribolabError
    from tribolab.fit.shear_stress import fit_shear_stress
    from tribolab.friction.coefficient.coefficient import friction_coefficient
    from tribolab.friction.coefficient.static import static_friction
    from tribolab.friction.decisions.decided_segments import decide
    from tribolab.friction.oscillation.slip_segments import stick_slip
    from tribolab.friction.running_in.history import running_in
    from tribolab.friction.segments.find import find_segments
    from tribolab.friction.stribeck import measured_stribeck_curve
    from tribolab.lubrication.parameters import Liquid
    from tribolab.lubrication.stribeck import stribeck_curve
    from tribolab.qc.any_data import check
    from tribolab.reading.run_files import read
    from tribolab.reading.scan_files import read_scans
    from tribolab.report.results_folder import read_results
    from tribolab.surface.roughness import roughness_parameters
    from tribolab.units.variable_table import variables

if "IPython" in sys.modules:
    from tribolab.units.display import show_units

    show_units()


accept_old_paths()


def __getattr__(name: str) -> Any:
    if name in _GROUPS:
        return importlib.import_module(f"tribolab.{name}")
    if name in _PUBLIC:
        value = getattr(importlib.import_module(_PUBLIC[name]), name)
        globals()[name] = value
        return value
    # until the next release, names of the groups that once were here
    for group in () if name.startswith("_") else _GROUPS_OF_FORMER_NAMES:
        home = importlib.import_module(f"tribolab.{group}")
        if name in home.__all__:
            warnings.warn(f"tl.{name} is now tl.{group}.{name}", FutureWarning, stacklevel=2)
            return getattr(home, name)
    raise AttributeError(f"module 'tribolab' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted(__all__)
