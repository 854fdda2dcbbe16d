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

import sys
import warnings
from typing import TYPE_CHECKING, Any

from tribolab.core.moved import accept_old_paths
from tribolab.core.public_names import loaded_on_use
from tribolab.version import __version__ as __version__

if TYPE_CHECKING:
    from tribolab import (
        archive as archive,
        campaign as campaign,
        comparison as comparison,
        contact as contact,
        fit as fit,
        friction as friction,
        lubrication as lubrication,
        metrology as metrology,
        plot as plot,
        qc as qc,
        reading as reading,
        regime as regime,
        rig as rig,
        rubber as rubber,
        studies as studies,
        surface as surface,
    )
    from tribolab.app.run import run_campaign as run_campaign
    from tribolab.comparison.comparison import compare as compare
    from tribolab.contact.geometry import LineContact as LineContact, PointContact as PointContact
    from tribolab.core.errors import TribolabError as TribolabError
    from tribolab.fit.shear_stress import fit_shear_stress as fit_shear_stress
    from tribolab.friction.coefficient.coefficient import (
        friction_coefficient as friction_coefficient,
    )
    from tribolab.friction.coefficient.static import static_friction as static_friction
    from tribolab.friction.decisions.decided_segments import decide as decide
    from tribolab.friction.oscillation.slip_segments import stick_slip as stick_slip
    from tribolab.friction.running_in.history import running_in as running_in
    from tribolab.friction.segments.find import find_segments as find_segments
    from tribolab.friction.stribeck import measured_stribeck_curve as measured_stribeck_curve
    from tribolab.lubrication.parameters import Liquid as Liquid
    from tribolab.lubrication.stribeck import stribeck_curve as stribeck_curve
    from tribolab.qc.any_data import check as check
    from tribolab.reading.run_files import read as read
    from tribolab.reading.scan_files import read_scans as read_scans
    from tribolab.report.results_folder import read_results as read_results
    from tribolab.surface.roughness import roughness_parameters as roughness_parameters
    from tribolab.units.variable_table import variables as variables

if "IPython" in sys.modules:
    from tribolab.units.display import show_units

    show_units()

accept_old_paths()
_load, __dir__, __all__ = loaded_on_use(__name__, __file__)
__all__ = ["__version__", *__all__]
_GROUPS_OF_FORMER_NAMES = (
    "reading friction surface contact rubber lubrication fit regime metrology qc campaign "
    "comparison archive"
).split()


def __getattr__(name: str) -> Any:
    try:
        return _load(name)
    except AttributeError:
        if name.startswith("_"):
            raise
    # until the next release, names formerly in this package are still found in their groups
    for group in _GROUPS_OF_FORMER_NAMES:
        home = _load(group)
        if name in home.__all__:
            warnings.warn(f"tl.{name} is now tl.{group}.{name}", FutureWarning, stacklevel=2)
            return getattr(home, name)
    raise AttributeError(f"module 'tribolab' has no attribute '{name}'")
