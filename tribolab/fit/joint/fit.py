"""Joint fit of the friction at all loads, from measured curves, contact and spectra."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from tribolab.contact.geometry import Contact
from tribolab.core.untyped import Arguments
from tribolab.fit.joint.inputs import (
    DryFriction,
    computed_curves,
    curves_of_surface,
    loads_of,
    surfaces_of,
)
from tribolab.fit.joint.load_curve import LoadCurve
from tribolab.fit.joint.loads import fit_loads
from tribolab.fit.joint.priors import JointPriors
from tribolab.fit.joint.result import JointFit
from tribolab.units.conversion import positive, to_si


def fit_shear_stress_jointly(
    measured: xr.Dataset,
    contact: Contact,
    psd: xr.Dataset,
    viscosity: str | float,
    load: str | float | xr.DataArray,
    *,
    priors: JointPriors | None = None,
    speed_range: tuple[str | float, str | float] | None = None,
    common_error: float = 0.0,
    speed_error: float = 0.0,
    area_enhancement: float | xr.DataArray = 1.0,
    dry: DryFriction | None = None,
    curves: xr.Dataset | None = None,
    **model: Any,
) -> JointFit:
    """Fit shear stress, its exponents of speed and load, and viscosity to all loads together.

    Parameters
    ----------
    measured
        ``friction_coefficient`` with ``_sem`` or else ``_std`` over (sliding_speed), a load dim
        such as ``normal_force``, (surface) for several surfaces and (run) for runs that were not
        combined. Points with friction not above zero are left out.
    contact, psd
        As for `stribeck_curve`; spectra of several surfaces have the dim ``surface``.
    viscosity
        Stated viscosity [Pa s]: the median of its prior.
    load
        F_N/L [N/m]; several loads as an array with their dim.
    priors
        Priors of the parameters.
    speed_range
        Lowest and highest speed [m/s] to take; None for all.
    common_error
        Relative standard error [1] of the shear stress common to all loads, e.g. from the spectrum.
    speed_error
        Relative standard error [1] of the sliding speeds common to all points.
    area_enhancement
        Ratio [1] of the real contact area with adhesion to that without, for all curves or by load
        or surface. The shear stress then refers to the adhesive contact area.
    dry
        Friction measured without the liquid.
    curves
        The computed curves, if available: `stribeck_curve` of the same system over a sufficient
        range of speeds, and over the loads (and surfaces).
    **model
        Further arguments of `stribeck_curve`, such as ``rough_body``.

    Returns
    -------
    JointFit

    Raises
    ------
    AnalysisError
        If nothing can be fitted: too few points, none with an error, or dims that do not match.

    Notes
    -----
    ``ln mu_li = ln[f_l(eta v_i) + sigma_0 (v_i/v0)^n (F_l/F0)^m k_l(eta v_i)] + level + r + e``: f
    and k are the fluid's friction and the real contact area over the load, computed once [1]_, v0 =
    10 um/s, F0 the geometric mean of the loads. "level" is an error common to all points of a load
    (or run), r an error correlated between neighbouring speeds, e that of each point. The priors
    (`JointPriors`) are normal for ln sigma_0, n, m and ln eta, and Rayleigh for the sizes of level
    and r. The posterior is a mixture of normals, see `posterior_of`.

    References
    ----------
    .. [1] R. Xu, C. Spies, M. Scaraggi, B. N. J. Persson, "Adhesion-controlled sliding and the
       Stribeck curve in hydrophobic soft contacts" (2026), Eqs. (3)-(10).

    Examples
    --------
    >>> import numpy as np, xarray as xr
    >>> from tribolab.lubrication.stribeck import stribeck_curve
    >>> q, c = np.array([423.0, 9e4, 3e9]), np.array([1.63e-22, 1.63e-22, 4e-42])
    >>> psd = xr.Dataset({"psd_2d": ("wavenumber", c)}, {"wavenumber": q})
    >>> from tribolab.contact.geometry import LineContact
    >>> contact = LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    >>> load = xr.DataArray([310.0, 910.0], {"normal_force": [31.0, 91.0]})
    >>> speed = np.geomspace(1e-6, 1e-2, 7)
    >>> mu = [stribeck_curve(contact, psd, 1.7, w, "0.84 MPa", speed, cells=60) for w in (310, 910)]
    >>> measured = xr.concat(mu, load.normal_force)[["friction_coefficient"]]
    >>> measured["friction_coefficient_sem"] = 0.01 * measured.friction_coefficient
    >>> fit = fit_shear_stress_jointly(measured, contact, psd, "1.4 Pa s", load, cells=60)
    >>> f"{fit.marginal('viscosity').value:.2f} Pa s"
    '1.70 Pa s'
    """
    priors = priors or JointPriors()
    eta = positive(viscosity, "Pa s", "viscosity")
    ends = (
        (0.0, np.inf)
        if speed_range is None
        else tuple(to_si(end, "m/s", name="speed_range") for end in speed_range)
    )
    loads = loads_of(measured, load)
    given: Arguments = {"contact": contact, "viscosity": eta, "priors": priors, "model": model}
    parts: list[LoadCurve] = []
    for surface, spectrum in surfaces_of(measured, psd):
        computed = (
            curves if curves is not None else computed_curves(spectrum, loads, measured, **given)
        )
        if "surface" in computed.dims:
            computed = computed.sel(surface=surface)
        parts += curves_of_surface(surface, measured, loads, computed, area_enhancement, dry)
    return fit_loads(
        parts,
        eta,
        priors,
        common_error=float(common_error),
        speed_error=float(speed_error),
        area_ratio_error=0.0 if dry is None else dry.area_ratio_error,
        speed_range=(ends[0], ends[1]),
    )
