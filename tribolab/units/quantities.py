"""List of all quantities: name, symbol, SI unit and long name."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribolab.core.errors import TribolabError, UnitError, nearest, shown
from tribolab.units.conversion import conversion, to_si
from tribolab.units.reciprocals import Counted, reciprocal


class Quantity(NamedTuple):
    """Name, symbol (as in papers), SI unit (as in netCDF attributes) and long name of a quantity.

    Quantities per time or length need `bare`: the meaning of a unit like "1/min"; "ask" if cycles
    and radians are both usual (`units.reciprocals`).
    """

    name: str
    symbol: str
    unit: str
    long_name: str
    bare: Counted | None = None


_ROWS = [
    # signals of a run
    ("time", "t", "s", "time from the first sample"),
    ("friction_force", "F_x", "N", "friction force"),
    ("normal_force", "F_N", "N", "normal force"),
    ("inertial_force", "F_a", "N", "inertial force subtracted from the friction force"),
    ("sliding_velocity", "v", "m/s", "sliding velocity, signed"),
    ("position", "x", "m", "position along the sliding direction"),
    ("normal_stress", "\\sigma_0", "Pa", "nominal normal stress"),
    ("shear_stress", "\\sigma_f", "Pa", "shear stress"),
    ("temperature", "T", "K", "temperature"),
    ("contact_area", "A", "m2", "measured contact area"),
    ("ambient_pressure", "p_a", "Pa", "ambient pressure"),
    ("set_speed", "v_set", "m/s", "set-point of the sliding speed"),
    ("set_normal_force", "F_set", "N", "set-point of the normal force"),
    ("rolling_speed", "u", "m/s", "rolling (entrainment) speed"),
    ("rotation_speed", "\\omega", "rad/s", "rotation speed", "cycles"),
    ("slide_roll_ratio", "SRR", "1", "slide-roll ratio"),
    ("film_thickness", "h", "m", "film thickness"),
    ("height_displacement", "z", "m", "displacement normal to the contact"),
    ("electrical_contact_resistance", "ECR", "1", "electrical contact resistance, relative"),
    ("contact_resistance", "R_c", "ohm", "electrical contact resistance"),
    ("voltage", "U", "V", "raw sensor voltage"),
    ("viscosity", "\\eta", "Pa s", "viscosity"),
    ("shear_rate", "\\dot\\gamma", "1/s", "shear rate", "nothing"),
    ("step", "", "1", "step number of the instrument"),
    ("cycle", "", "1", "number of the cycle", "cycles"),
    # segments
    ("segment", "", "1", "number of the segment"),
    ("start", "t_0", "s", "start of the segment"),
    ("stop", "t_1", "s", "end of the segment"),
    ("trimmed_start", "t_0'", "s", "start of the trimmed segment"),
    ("trimmed_stop", "t_1'", "s", "end of the trimmed segment"),
    ("omitted_start", "", "s", "start of an omitted interval"),
    ("omitted_stop", "", "s", "end of an omitted interval"),
    ("sliding_speed", "v", "m/s", "sliding speed"),
    ("forward_speed", "v_f", "m/s", "sliding speed of the forward stroke"),
    ("backward_speed", "v_b", "m/s", "sliding speed of the backward stroke"),
    ("direction", "", "1", "sliding direction"),
    ("sliding_distance", "s", "m", "sliding distance"),
    ("samples", "n", "1", "number of samples"),
    # friction
    ("friction_coefficient", "\\mu", "1", "friction coefficient"),
    (
        "friction_coefficient_level",
        "\\mu",
        "1",
        "friction coefficient without the unfinished period of an oscillation",
    ),
    (
        "friction_coefficient_beyond",
        "\\mu",
        "1",
        "friction coefficient as an estimate for the surface beyond the measured path",
    ),
    (
        "friction_coefficient_shared",
        "\\mu",
        "1",
        "part of the friction coefficient that all segments of a run share",
    ),
    ("effective_samples", "n_eff", "1", "effective number of independent samples"),
    ("autocorrelation_time", "\\tau_int", "s", "integrated autocorrelation time"),
    ("trend", "d\\mu/dt", "1/s", "linear trend of the friction coefficient", "nothing"),
    ("force_trend", "dF/dt", "N/s", "linear trend of the friction force"),
    ("trend_change", "\\Delta\\mu", "1", "change along the linear trend over the trimmed segment"),
    ("trend_p_value", "p", "1", "probability of such a trend in a steady signal"),
    ("steady", "", "1", "whether friction is steady: 1 yes, 0 no, 2 undecided"),
    ("friction_force_offset", "F_0", "N", "offset of the friction force that was removed"),
    ("normal_force_offset", "F_N0", "N", "offset of the normal force that was removed"),
    ("tilt_found", "\\alpha", "rad", "tilt of the force cell, found from both directions"),
    ("uncertainty_part", "", "1", "contribution to the uncertainty of the friction coefficient"),
    ("uncertainty_part_dof", "\\nu", "1", "degrees of freedom of a contribution"),
    ("fluid_part", "", "1", "contribution of an uncertain input to the liquid's friction"),
    ("solid_part", "", "1/Pa", "contribution of an uncertain input to the contact area"),
    ("solid_part_other", "", "1/Pa", "the same with the other theory of the contact area"),
    ("model_part", "", "1", "contribution to the uncertainty of the computed friction"),
    ("friction_coefficient_offset", "\\mu_0", "1", "offset of the friction coefficient, removed"),
    # static friction
    ("start_of_sliding", "", "1", "number of the segment that starts"),
    ("static_friction_coefficient", "\\mu_s", "1", "static friction coefficient"),
    ("breakaway_force", "F_s", "N", "friction force at which sliding starts"),
    ("static_excess", "", "1", "static divided by kinetic friction, minus 1"),
    ("peak", "", "1", "whether the start exceeds the friction of the sliding that follows"),
    ("breakaway_time", "t_s", "s", "time of the peak friction at a start"),
    ("waiting_time", "t_w", "s", "time of rest under load before a start"),
    # cycles of a reciprocating contact
    (
        "friction_coefficient_energy",
        "\\mu_E",
        "1",
        "friction coefficient from the loop energy",
    ),
    ("mean_friction_coefficient", "\\mu", "1", "friction coefficient, mean over the cycles"),
    ("entrainment_speed", "U", "m/s", "entrainment speed, the mean of both bodies"),
    ("steady_friction_coefficient", "\\mu", "1", "friction coefficient after running-in"),
    ("running_in_distance", "s_0", "m", "sliding distance of running-in"),
    ("running_in_time", "t_0", "s", "duration of running-in"),
    ("work_per_cycle", "W", "J", "friction work of a cycle"),
    ("wear_depth", "z", "m", "displacement normal to the contact since the beginning"),
    ("stroke_length", "L", "m", "length of a stroke"),
    ("omitted_reason", "", "1", "reason for the omission"),
    ("zero_from", "", "1", "source of the zero of the friction signal"),
    ("half_loop", "", "N", "half the difference of the friction force between the strokes"),
    ("pair", "", "1", "number of the pair of strokes"),
    ("rejected", "", "1", "1 if the segment was rejected manually"),
    ("decision", "", "1", "manual decision on the segment"),
    ("runs", "", "1", "number of runs"),
    ("segments", "", "1", "number of segments"),
    ("load", "F_N/L", "N/m", "normal force per unit length"),
    # surfaces
    ("x", "x", "m", "coordinate along the profile"),
    ("y", "y", "m", "coordinate across the profile"),
    ("height", "h", "m", "surface height"),
    ("wavenumber", "q", "1/m", "wavenumber", "radians"),
    ("psd_1d", "C_{1D}", "m3", "one-dimensional power spectrum"),
    ("psd_2d", "C", "m4", "two-dimensional power spectrum"),
    ("scans", "", "1", "number of scans"),
    ("rms_roughness", "h_rms", "m", "root-mean-square roughness"),
    ("rms_slope", "\\xi", "1", "root-mean-square slope"),
    ("rms_curvature", "\\kappa", "1/m", "root-mean-square curvature", "nothing"),
    # surfaces: results of measured spectra
    ("scan", "", "1", "number of the scan"),
    ("dropout", "", "1", "1 where the height was filled"),
    ("gap_error", "", "1", "relative standard error due to missing heights"),
    ("Ra_sem", "", "m", "standard error of the mean of Ra over the scans"),
    ("Rq_sem", "", "m", "standard error of the mean of Rq over the scans"),
    ("Rz_sem", "", "m", "standard error of the mean of Rz over the scans"),
    ("Rsk_sem", "", "1", "standard error of the mean of Rsk over the scans"),
    ("Rku_sem", "", "1", "standard error of the mean of Rku over the scans"),
    ("Rdq_sem", "", "1", "standard error of the mean of Rdq over the scans"),
    ("Ra_gap_error", "", "m", "standard error of Ra due to missing heights"),
    ("Rq_gap_error", "", "m", "standard error of Rq due to missing heights"),
    ("Rz_gap_error", "", "m", "standard error of Rz due to missing heights"),
    ("Rsk_gap_error", "", "1", "standard error of Rsk due to missing heights"),
    ("Rku_gap_error", "", "1", "standard error of Rku due to missing heights"),
    ("Rdq_gap_error", "", "1", "standard error of Rdq due to missing heights"),
    ("form_tilt", "", "1", "tilt that was removed"),
    ("form_curvature", "", "1/m", "curvature that was removed, positive where hollow", "nothing"),
    ("independent_values", "", "1", "effective number of independent values"),
    ("mean_square_height", "<h^2>", "m2", "mean square height in the bin"),
    ("trusted", "", "1", "1 where the spectrum can be trusted, else 0"),
    ("origin", "", "1", "where the value comes from"),
    ("Ra", "Ra", "m", "arithmetic mean deviation of the profile"),
    ("Rq", "Rq", "m", "root-mean-square deviation of the profile"),
    ("Pq", "Pq", "m", "root-mean-square deviation of the profile, no cut-off applied"),
    ("Sq", "Sq", "m", "root-mean-square height of the map, no cut-off applied"),
    ("Sa", "Sa", "m", "arithmetic mean height of the map, no cut-off applied"),
    ("Rz", "Rz", "m", "greatest height of the profile, mean over sampling lengths"),
    ("Rsk", "Rsk", "1", "skewness of the profile"),
    ("Rku", "Rku", "1", "kurtosis of the profile"),
    ("Rdq", "Rdq", "1", "root-mean-square slope of the profile"),
    # contact, adhesion
    ("pressure", "p", "Pa", "nominal contact pressure"),
    ("radial_distance", "r", "m", "distance from the centre of a circular contact"),
    ("contact_area_ratio", "A/A_0", "1", "relative contact area"),
    ("separation", "\\bar u", "m", "mean interfacial separation"),
    ("work_of_adhesion", "\\gamma", "J/m2", "work of adhesion"),
    ("effective_work_of_adhesion", "\\gamma_eff", "J/m2", "effective work of adhesion"),
    ("magnification", "\\zeta", "1", "magnification"),
    # adhesion
    (
        "macroscopic_work_of_adhesion",
        "\\gamma_eff(1)",
        "J/m2",
        "work of adhesion at magnification 1",
    ),
    ("apparent_contact_area_ratio", "P", "1", "relative contact area seen at a magnification"),
    ("contact_area_ratio_no_adhesion", "A/A_0", "1", "relative contact area without adhesion"),
    ("area_enhancement", "A/A(\\gamma=0)", "1", "contact area relative to that without adhesion"),
    ("pull_off", "", "1", "1 where there is a pull-off force, else 0"),
    ("root_search_steps", "", "1", "steps of the root search"),
    ("balance_residual", "", "1", "relative misfit of the adhesive balance"),
    # contact: gaps and line contacts
    ("gap", "u", "m", "local interfacial gap"),
    ("gap_density", "P(u)", "1/m", "probability density of the gap", "nothing"),
    ("gap_weight", "P(u) du", "1", "quadrature weight of the gap"),
    ("gap_scale", "", "1", "factor that makes the mean gap the mean separation"),
    ("max_pressure", "p_max", "Pa", "maximum contact pressure"),
    ("contact_width", "2a", "m", "width of the nominal contact"),
    # surfaces of a campaign
    ("angular_frequency", "\\omega", "rad/s", "angular frequency", "ask"),
    ("storage_modulus", "E'", "Pa", "storage modulus"),
    ("loss_modulus", "E''", "Pa", "loss modulus"),
    ("central_separation", "u_0", "m", "mean separation at the middle of the contact"),
    # lubrication: factors, profiles, curves
    ("relative_separation", "u/h_rms", "1", "mean separation over rms roughness"),
    ("pressure_flow_factor", "\\phi_p", "1", "pressure flow factor"),
    ("shear_flow_factor", "\\phi_s", "1", "shear flow factor"),
    ("shear_stress_factor", "\\phi_f", "1", "friction factor of the mean shear"),
    ("shear_stress_correction", "\\phi_fs", "1", "friction factor of roughness-born pressure"),
    ("pressure_stress_factor", "\\phi_fp", "1", "friction factor of the pressure gradient"),
    ("contact_pressure", "p_cont", "Pa", "pressure carried by the solid contact"),
    ("fluid_pressure", "p_fluid", "Pa", "pressure carried by the fluid"),
    ("friction_coefficient_couette", "\\mu_C", "1", "friction by shear of the fluid"),
    ("friction_coefficient_pressure", "\\mu_p", "1", "friction by the fluid's pressure gradient"),
    ("friction_coefficient_solid", "\\mu_s", "1", "friction by shear in the solid contact"),
    ("friction_per_shear_stress", "a", "1/Pa", "real contact area per normal force"),
    ("friction_per_shear_stress_other", "a", "1/Pa", "the same with another theory of the area"),
    ("minimum_separation", "u_min", "m", "smallest mean separation"),
    ("solid_load_share", "", "1", "share of the load carried by the solid contact"),
    ("residual", "", "1", "largest error of pressure over the largest pressure"),
    ("load_balance", "", "1", "relative error of the load"),
    ("flux_variation", "", "1", "relative spread of the flux over the full film"),
    ("iterations", "", "1", "steps of Newton's method"),
    ("flux", "J", "m2/s", "volume of fluid that passes per time and length"),
    ("cavity_start", "x_c", "m", "where the film ruptures"),
    # comparison
    ("friction_coefficient_residual", "\\Delta\\mu", "1", "measured minus computed friction"),
    ("used", "", "1", "1 where the point was fitted, else 0"),
    # stick-slip
    ("frequency", "f", "Hz", "frequency", "cycles"),
    ("inverse_wavelength", "1/\\lambda", "1/m", "inverse wavelength", "cycles"),
    ("dominant_frequency", "f_0", "Hz", "frequency of the oscillation, by its spectrum", "cycles"),
    ("dominant_wavelength", "\\lambda_0", "m", "wavelength of the oscillation, by its spectrum"),
    ("false_alarm_probability", "p", "1", "probability that noise shows such a peak"),
    ("peak_prominence", "", "1", "power of the peak over its background"),
    ("oscillation_share", "", "1", "part of the faster variance that is the oscillation"),
    ("harmonic_content", "", "1", "amplitude of the harmonics over that of the first"),
    ("scaling_exponent", "", "1", "exponent of frequency over speed; 1 is a fixed wavelength"),
    ("scaling_error", "", "1", "standard error of the exponent of frequency over speed"),
    (
        "resonance_frequency",
        "",
        "Hz",
        "resonance frequency of the rig, independent of the speed",
        "cycles",
    ),
    ("fall_share", "", "1", "part of a cycle in which friction falls"),
    ("asymmetry_p_value", "p", "1", "probability that rises and falls last equally long"),
    ("derivative_skewness", "", "1", "skewness of the derivative of friction"),
    ("period_scatter", "", "1", "relative standard deviation of the recurrence times"),
    ("periods", "", "1", "number of periods in a segment"),
    ("oscillating_time_share", "", "1", "part of the time that oscillates"),
    ("regularity", "", "1", "how regular the oscillation is"),
    ("line_frequency", "f", "Hz", "frequency of a significant oscillation", "cycles"),
    ("line_wavelength", "\\lambda", "m", "sliding distance of a significant oscillation"),
    ("line_false_alarm_probability", "p", "1", "probability that noise shows such a line"),
    ("line_swing", "", "1", "swing of the friction coefficient at a line"),
    ("force_line_swing", "", "N", "swing of the friction force at a line"),
    ("drop_scatter", "", "1", "relative standard deviation of the drops"),
    ("segments_oscillating", "", "1", "number of segments with stick-slip"),
    ("waveform", "", "1", "class of the waveform"),
    ("waveform_class", "", "1", "class of the waveform"),
    ("instrument", "", "1", "what is the instrument's"),
    ("method", "", "1", "method of the spectrum"),
    ("remark", "", "1", "why a value is missing or special"),
    ("events", "", "1", "number of whole cycles of stick and slip"),
    ("stick_duration", "t_stick", "s", "duration of a stick"),
    ("slip_duration", "t_slip", "s", "duration of a slip"),
    ("recurrence_time", "T", "s", "time from drop to drop"),
    ("recurrence_distance", "\\lambda", "m", "mean sliding distance from drop to drop"),
    ("loading_stiffness", "k", "N/m", "friction force over distance during a stick"),
    ("critical_stiffness_low", "k_c", "N/m", "lowest critical stiffness that the cycles allow"),
    ("critical_stiffness_high", "k_c", "N/m", "highest critical stiffness that the cycles allow"),
    ("mains_frequency", "f", "Hz", "frequency of the strongest line of the mains", "cycles"),
    ("class_probability", "p", "1", "probability of the class of waveform"),
    ("spike_share", "", "1", "part of the samples that are single spikes"),
    ("event_segment", "", "1", "segment of the event"),
    ("event_time", "t", "s", "moment of the peak before a drop"),
    ("event_stick", "t_stick", "s", "duration of the stick before a drop"),
    ("event_slip", "t_slip", "s", "duration of a drop"),
    ("drop", "\\Delta\\mu", "1", "drop of the friction coefficient in a slip"),
    ("oscillation_swing", "", "1", "swing of the friction coefficient by its spectrum"),
    ("background_noise", "", "1", "noise of the friction coefficient below the oscillation"),
    ("sample_noise", "", "1", "noise of the friction coefficient from sample to sample"),
    ("hysteresis", "", "1", "smallest swing of the friction coefficient that counts"),
    ("mains_amplitude", "", "1", "amplitude of the mains in the friction coefficient"),
    ("rig_swing", "", "1", "swing of friction that repeats with each turn of the rig"),
    ("rig_wave", "", "1", "oscillation that repeats with each turn of the rig"),
    (
        "loading_slope",
        "d\\mu/dx",
        "1/m",
        "friction coefficient over distance in a stick",
        "nothing",
    ),
    ("event_drop", "\\Delta\\mu", "1", "drop of the friction coefficient"),
    ("psd", "S", "1/Hz", "power spectrum of the friction coefficient"),
    ("psd_background", "S_0", "1/Hz", "red and white noise beneath the power spectrum"),
    ("psd_significant", "S_p", "1/Hz", "power that noise exceeds once in a thousand spectra"),
    ("distance_psd", "S_x", "m", "power spectrum over the sliding distance"),
    ("force_drop", "\\Delta F", "N", "drop of the friction force in a slip"),
    ("force_oscillation_swing", "", "N", "swing of the friction force by its spectrum"),
    ("force_background_noise", "", "N", "noise of the friction force below the oscillation"),
    ("force_sample_noise", "", "N", "noise of the friction force from sample to sample"),
    ("force_hysteresis", "", "N", "smallest swing of the friction force that counts"),
    ("force_mains_amplitude", "", "N", "amplitude of the mains in the friction force"),
    ("force_rig_swing", "", "N", "swing of the friction force that repeats with each turn"),
    ("force_loading_slope", "dF/dx", "N/m", "friction force over distance in a stick"),
    ("force_event_drop", "\\Delta F", "N", "drop of the friction force"),
    ("force_psd", "S", "N2/Hz", "power spectrum of the friction force"),
    ("force_psd_background", "S_0", "N2/Hz", "noise beneath the power spectrum"),
    ("force_psd_significant", "S_p", "N2/Hz", "power that noise exceeds once in a thousand"),
    ("force_distance_psd", "S_x", "N2 m", "power spectrum over the sliding distance"),
    # models of a campaign
    ("friction_coefficient_model", "\\mu", "1", "computed friction coefficient"),
    ("measured_speed", "v", "m/s", "mean sliding speed of the segments of a curve"),
    ("run_level", "", "1", "friction of a run relative to that of its repeats"),
    (
        "friction_without_factors",
        "\\mu",
        "1",
        "friction coefficient without friction factors",
    ),
    # comparison: uncertainty of the model
    ("friction_coefficient_varied", "\\mu", "1", "friction coefficient of a varied model"),
    ("largest_change", "", "1", "largest change of friction divided by the peak of the curve"),
    ("largest_change_speed", "", "m/s", "sliding speed of the largest change"),
    ("largest_relative_change", "", "1", "largest relative change of friction at one speed"),
    ("largest_relative_change_speed", "", "m/s", "sliding speed of the largest relative change"),
    ("shear_stress_change", "", "1", "relative change of the fitted shear stress"),
    # comparison: joint fit of several loads
    ("friction_coefficient_load", "\\mu", "1", "friction coefficient with the offset of its load"),
    ("relative_residual", "", "1", "logarithm of measured over computed friction"),
    ("shared_residual", "", "1", "part of the residual shared by offsets and neighbouring speeds"),
    ("run_number", "", "1", "number of the run, from 0"),
]


def dictionary(rows: Iterable[tuple[Any, ...]]) -> dict[str, Quantity]:
    """Return quantities by name; an error if two have the same name.

    Raises
    ------
    TribolabError
        If a name occurs twice, or a quantity per time or length does not state what it counts.

    Examples
    --------
    >>> dictionary([("gap", "u", "m", "local interfacial gap")])["gap"].unit
    'm'
    """
    known: dict[str, Quantity] = {}
    for row in rows:
        entry = Quantity(*row)
        if entry.name in known:
            raise TribolabError(
                f"the quantity '{entry.name}' stands twice in the dictionary: as "
                f"'{known[entry.name].long_name}' and as '{entry.long_name}'; give one another name"
            )
        if entry.bare is None and reciprocal(entry.unit):
            raise TribolabError(
                f"the quantity '{entry.name}' [{entry.unit}] does not name what it counts: add "
                '"cycles", "radians", "nothing" or "ask"'
            )
        known[entry.name] = entry
    return known


QUANTITIES: dict[str, Quantity] = dictionary(_ROWS)

_DERIVED = {
    "_std": "standard deviation of the {}",
    "_sem": "standard error of the {}",
    "_low": "lower bound of the {}",
    "_high": "upper bound of the {}",
    "_between": "standard deviation between runs of the {}",
    "_within": "standard deviation within runs of the {}",
    "_u": "standard uncertainty of the {}",
    "_U95": "expanded uncertainty (95 %) of the {}",
}
_DOF = "_dof"  # degrees of freedom, dimensionless whatever the unit of the quantity


def quantity(name: str) -> Quantity:
    """Return the quantity of a name; ``..._std``, ``..._sem``, ``..._u`` etc. follow their base.

    Raises
    ------
    TribolabError
        If there is no such quantity; the message names the nearest.

    Examples
    --------
    >>> quantity("normal_force").unit
    'N'
    >>> quantity("friction_coefficient_std").long_name
    'standard deviation of the friction coefficient'
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    for ending, text in _DERIVED.items():
        base = QUANTITIES.get(name.removesuffix(ending))
        if name.endswith(ending) and base:
            return Quantity(name, base.symbol, base.unit, text.format(base.long_name), base.bare)
    if name.endswith(_DOF) and (base := QUANTITIES.get(name.removesuffix(_DOF))):
        return Quantity(name, "\\nu", "1", f"degrees of freedom of the {base.long_name}")
    raise TribolabError(f"no quantity is called '{shown(name)}'{nearest(name, QUANTITIES)}")


def unit_conversion(unit: str, name: str) -> tuple[float, float]:
    """Return scale and offset from `unit` to the SI unit of a quantity.

    Raises
    ------
    UnitError
        If the unit is unknown, of another dimension, or may be read in two ways.

    Examples
    --------
    >>> round(60 * unit_conversion("U/min", "rotation_speed")[0], 6)
    6.283185
    """
    known = quantity(name)
    return conversion(unit, known.unit, known.bare)


def si_values(value: str | ArrayLike, name: str) -> np.ndarray:
    """Return the values of a quantity as SI floats; entries may be text with a unit.

    Raises
    ------
    UnitError
        If a text has no unit or one of another dimension, or an entry is no number.

    Examples
    --------
    >>> si_values(["42 kPa", "0.1 MPa"], "pressure")
    array([ 42000., 100000.])
    """
    unit, bare = quantity(name).unit, quantity(name).bare
    try:
        if np.asarray(value).dtype.kind in "fiub":
            return np.asarray(value, dtype=float)
        # as objects, because an array of text would turn numbers into text without a unit
        entries = np.asarray(value, dtype=object)
        numbers = [
            to_si(str(cell), unit, name=name, bare=bare) if isinstance(cell, str) else float(cell)
            for cell in entries.ravel()
        ]
    except (TypeError, ValueError) as error:
        raise UnitError(
            f"{name}: numbers in {unit}, or text such as '1 {unit}', are wanted; got "
            f"{shown(repr(value), 60)}"
        ) from error
    return np.array(numbers, dtype=float).reshape(entries.shape)
