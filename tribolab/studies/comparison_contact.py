"""Computed values for the paper's numbers on surfaces, contact and adhesion."""

from __future__ import annotations

from collections.abc import Callable

from tribolab.studies import xu2026
from tribolab.studies.published import Published, find_published
from tribolab.studies.theory import Theory
from tribolab.studies.verdict import Computed, Own


def _nominal_pressure(row: Published, theory: Theory) -> Computed:
    note = "mean pressure F/(2aL) of the Hertz contact, half-width a"
    return Computed(theory.pressure(row), 0.005, note, exact=True)


def _hertz_max_pressure(row: Published, theory: Theory) -> Computed:
    return Computed(theory.hertz_max_pressure(row), 0.005, exact=True)


def _hertz_width(row: Published, theory: Theory) -> Computed:
    return Computed(2 * theory.hertz_half_width(row), 0.005, exact=True)


def _half_width(row: Published, theory: Theory) -> Computed:
    return Computed(theory.hertz_half_width(row), 0.005, "Eq. (16)", exact=True)


def _adhesive_half_width(row: Published, theory: Theory) -> Computed:
    return Computed(theory.jkr_half_width(row), 0.005, "Eq. (15)", exact=True)


def _rms_roughness(row: Published, theory: Theory) -> Computed:
    return Computed(theory.roughness(row.surface), 0.005, given=_SPECTRUM_HAS_IT)


def _rms_slope(row: Published, theory: Theory) -> Computed:
    return Computed(theory.slope(row.surface), 0.005, given=_SPECTRUM_HAS_IT)


# reasons why numbers agree by construction; on the spectra see `tribolab.studies.xu2026`
_SPECTRUM_HAS_IT = "the stand-in spectrum was made to have it"
_EXPONENT = "the stand-in's exponent H was chosen for the areas with adhesion"
_PRESSURE = "its pressure is not printed, and 0.1 MPa was chosen for the areas without adhesion"
_LEVEL = "the paper does not say where the contact ends, and the level was chosen for its widths"


def _area(row: Published, theory: Theory) -> Computed:
    note = f"at {theory.pressure(row) / 1e6:.4g} MPa, stand-in spectrum"
    guessed = [] if theory.has_load(row) else [_PRESSURE]
    if medium := theory.medium(row):
        given = "; ".join([_EXPONENT, *guessed])
        return Computed(theory.adhesive_area(row, medium), 0.03, note, given=given)
    return Computed(theory.area(row), 0.01, note, given="; ".join(guessed))


def _work(row: Published, theory: Theory) -> Computed:
    low, high = theory.work_bounds(row.condition)
    note = f"{1e3 * low:.3g} to {1e3 * high:.3g} mJ/m2 inside the bounds of the surface energies"
    return Computed(theory.work(row.condition), 0.01, note)


def _macroscopic(row: Published, theory: Theory) -> Computed:
    works = {medium: theory.macroscopic_work(row.surface, medium) for medium in theory.media}
    note = ", ".join(f"{medium} {1e3 * value:.3g} mJ/m2" for medium, value in works.items())
    value = min(works.values()) if row.relation == ">" else max(works.values())
    return Computed(value, 0.0, f"as the load vanishes: {note}")


def _enhancement(row: Published, theory: Theory) -> Computed:
    medium = "dry" if row.condition.startswith("dry") else "glycerol"
    if "loads" not in row.condition:
        return Computed(theory.enhancement(row.surface, medium)[0], 0.03, given=_EXPONENT)
    every = theory.enhancement(row.surface, medium)
    note = f"{max(every):.3g} at the lowest load to {min(every):.3g} at the highest"
    mean = sum(every) / len(every)
    return Computed(mean, 0.03, note, low=min(every), high=max(every), given=_EXPONENT)


def _viscoelastic(row: Published, theory: Theory) -> Computed:
    by_surface = theory.viscoelastic_friction()
    note = ", ".join(f"{name} {value:.2g}" for name, value in by_surface.items())
    # found by cutting off the spectrum: 86 % of the largest value is due to q > 1e7 1/m
    note = (
        f"stand-in modulus, up to 1 cm/s: {note}; in complete contact waves shorter than a "
        "micrometre count in full, so the loss modulus at 1e5 to 1e8 rad/s decides, of which the "
        "paper shows only a picture"
    )
    return Computed(max(by_surface.values()), 1.0, note)


def _line_pressure(row: Published, theory: Theory) -> Computed:
    return Computed(theory.line(row)[0], 0.015, "dry rough line contact, stand-in spectrum")


def _line_width(row: Published, theory: Theory) -> Computed:
    note = "between the points where pressure is 1e-3 of its maximum"
    return Computed(theory.line(row)[1], 0.025, note, given=_LEVEL)


def _alpha(row: Published, theory: Theory) -> Computed:
    every = [theory.separation_decay(name) for name in xu2026.surfaces]
    note = (
        f"at large separations pressure falls by a factor e over the length u0, and alpha = "
        f"h_rms/u0 is {min(every):.3g} to {max(every):.3g} on the three surfaces"
    )
    return Computed(sum(every) / len(every), 0.05, note)


def _excess(row: Published, theory: Theory) -> Computed:
    dry, wet = (theory.adhesive_area(row, medium) for medium in ("dry", "glycerol"))
    return Computed(dry / wet - 1, 0.1, "computed: the dry over the wet area, less 1")


COMPUTE_CONTACT: dict[str, Callable[[Published, Theory], Computed]] = {
    "nominal_pressure": _nominal_pressure,
    "hertz_max_pressure": _hertz_max_pressure,
    "hertz_contact_width": _hertz_width,
    "half_width_no_adhesion": _half_width,
    "half_width_with_adhesion": _adhesive_half_width,
    "rms_roughness": _rms_roughness,
    "rms_slope": _rms_slope,
    "contact_area_ratio": _area,
    "work_of_adhesion": _work,
    "macroscopic_work_of_adhesion": _macroscopic,
    "area_enhancement": _enhancement,
    "viscoelastic_friction": _viscoelastic,
    "contact_max_pressure": _line_pressure,
    "contact_width": _line_width,
    "separation_decay_alpha": _alpha,
    "dry_over_glycerol_area": _excess,
}


def _own_excess(row: Published) -> Own:
    low, high, words = _area_ratio(row.surface, "adhesion dry", "adhesion in glycerol")
    return Own(
        low - 1, high - 1, f"{words}, so {100 * (low - 1):.1f} to {100 * (high - 1):.1f} % more"
    )


def _own_enhancement(row: Published) -> Own | None:
    if "loads" in row.condition:
        return None
    with_adhesion = "adhesion dry" if row.condition.startswith("dry") else "adhesion in glycerol"
    return Own(*_area_ratio(row.surface, with_adhesion, "no adhesion"))


def _own_half_width(row: Published) -> Own:
    width = find_published(xu2026.published, "hertz_contact_width", "smooth limit", "310 N/m")
    low, high = (width.si + sign * width.last_digit for sign in (-1, 1))
    half = f"{width.si / 2 / row.factor:.3g} {row.unit}"
    return Own(
        low / 2, high / 2, f"half of the paper's own width {width.text} {width.unit} is {half}"
    )


def _area_ratio(surface: str, above: str, below: str) -> tuple[float, float, str]:
    """Return the range of the ratio of two published areas due to their rounding, and a text."""
    p = "0.042 MPa; "
    first, second = (
        find_published(xu2026.published, "contact_area_ratio", surface, p + which)
        for which in (above, below)
    )
    low = (first.si - first.last_digit) / (second.si + second.last_digit)
    high = (first.si + first.last_digit) / (second.si - second.last_digit)
    words = f"the paper's own areas give {first.text}/{second.text} = {first.si / second.si:.3g}"
    return low, high, words


OWN_CONTACT: dict[str, Callable[[Published], Own | None]] = {
    "dry_over_glycerol_area": _own_excess,
    "area_enhancement": _own_enhancement,
    "half_width_no_adhesion": _own_half_width,
}
