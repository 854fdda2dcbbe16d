"""Computed values for the paper's numbers on flow, mixed lubrication and shear stress."""

from __future__ import annotations

from collections.abc import Callable

from tribolab.studies import xu2026
from tribolab.studies.published import Published, find_published
from tribolab.studies.theory import Theory
from tribolab.studies.verdict import Computed, Measured, Own

_ROUGH, _LESS_ROUGH = "Sb-R", "Sb-S"
_DRY_SHARE = 0.99  # share of the dry friction above which lubrication is boundary lubrication
_GONE = 1e-4  # phi_p below which there is practically no flow


def _percolation(row: Published, theory: Theory) -> Computed:
    gone, visible, closed = (theory.flow_stops(level) for level in (_GONE, 1e-3, 0.0))
    note = (
        f"where the pressure flow factor phi_p falls below {_GONE:g} (inferred: no threshold is "
        f"printed): {_span(gone)} on the three surfaces; below 1e-3 at {_span(visible)}, zero at "
        f"{_span(closed)}"
    )
    return Computed(sum(gone) / len(gone), 0.25, note, low=min(gone), high=max(gone))


def _boundary_onset(row: Published, theory: Theory) -> Computed:
    onset, wider = (theory.boundary_onset(row, share) for share in (_DRY_SHARE, 0.95))
    note = (
        f"friction is {100 * _DRY_SHARE:.0f} % of that of the dry contact; 95 % at {wider:.2g} "
        "m/s, above the printed bound: the paper does not say which share it means; stand-in "
        "spectrum"
    )
    return Computed(onset, max(0.0, wider / row.si - 1), note, low=onset, high=wider)


def _fitted(row: Published, theory: Theory) -> Measured:
    return Measured(
        "fitted by the authors to their own curve, whose points are not public; an input here"
    )


def _measured(row: Published, theory: Theory) -> Measured:
    return Measured("from the authors' own friction measurements, which are not public")


def _corrected(row: Published, theory: Theory) -> Computed:
    fitted = find_published(xu2026.published, "shear_stress", row.surface, row.condition)
    growth = theory.enhancement(row.surface, "glycerol")[0]
    note = f"the printed {fitted.text} {fitted.unit} over the area's growth, {growth:.3g}"
    given = "it is printed numbers over an area that the stand-in's exponent H was chosen for"
    return Computed(fitted.si / growth, 0.03, note, given=given)


def _corrected_ratio(row: Published, theory: Theory) -> Computed:
    growths = (theory.enhancement(name, "glycerol") for name in (_LESS_ROUGH, _ROUGH))
    every = [
        _stress(_ROUGH, load).si / _stress(_LESS_ROUGH, load).si * less / more
        for load, less, more in zip(_loads(), *growths, strict=True)
    ]
    note = "printed shear stresses, computed areas, from the lowest load to the highest: "
    note += ", ".join(f"{value:.3g}" for value in every)
    return Computed(sum(every) / len(every), 0.03, note, low=min(every), high=max(every))


COMPUTE_LUBRICATION: dict[str, Callable[[Published, Theory], Computed | Measured]] = {
    "percolation_separation": _percolation,
    "boundary_onset_speed": _boundary_onset,
    "shear_stress": _fitted,
    "effective_shear_stress_ratio": _measured,
    "corrected_shear_stress": _corrected,
    "corrected_shear_stress_ratio": _corrected_ratio,
}


def _own_stress(row: Published) -> Own | None:
    """Return the shear stress of Sb-R that follows from that of Sb-S and the printed ratio."""
    if row.surface != _ROUGH:
        return None
    ratio = find_published(xu2026.published, "corrected_shear_stress_ratio", "Sb-R / Sb-S")
    other = _stress(_LESS_ROUGH, row.condition)
    low, high = _growth_ratio()
    printed = _rounding_range(ratio)
    (less, more), (own_low, own_high) = _rounding_range(other), _rounding_range(row)
    words = (
        f"with the paper's own areas and {other.text} {other.unit} for {_LESS_ROUGH} the corrected "
        f"ratio is {own_low / more / high:.3g} to {own_high / less / low:.3g}, not {ratio.text}"
    )
    return Own(printed[0] * low * less, printed[1] * high * more, words)


def _own_ratio(row: Published) -> Own:
    """Return the ratio of the paper's own numbers, at the load where it differs most from print."""
    low, high = _growth_ratio()
    every = []
    for load in _loads():
        (rough, rougher), (less, more) = (
            _rounding_range(_stress(name, load)) for name in (_ROUGH, _LESS_ROUGH)
        )
        ends = rough / more / high, rougher / less / low
        words = f"the paper's own numbers give {ends[0]:.3g} to {ends[1]:.3g} at {load}"
        every.append(Own(*ends, words))
    return max(every, key=lambda own: abs((own.low + own.high) / 2 - row.si))


OWN_LUBRICATION: dict[str, Callable[[Published], Own | None]] = {
    "shear_stress": _own_stress,
    "corrected_shear_stress_ratio": _own_ratio,
}


def _stress(surface: str, load: str) -> Published:
    return find_published(xu2026.published, "shear_stress", surface, load)


def _loads() -> list[str]:
    return [
        row.condition
        for row in xu2026.published
        if row.quantity == "shear_stress" and row.surface == _ROUGH
    ]


def _growth_ratio() -> tuple[float, float]:
    """Return the range of the ratio of area increases by adhesion, of Sb-R to Sb-S."""
    areas = {
        (surface, which): _rounding_range(
            find_published(xu2026.published, "contact_area_ratio", surface, f"0.1 MPa; {which}")
        )
        for surface in (_ROUGH, _LESS_ROUGH)
        for which in ("adhesion in glycerol", "no adhesion")
    }
    low, high = 1.0, 1.0
    for (surface, which), (least, most) in areas.items():
        above = (surface == _ROUGH) == (which == "adhesion in glycerol")
        low *= least if above else 1 / most
        high *= most if above else 1 / least
    return low, high


def _rounding_range(row: Published) -> tuple[float, float]:
    """Return the range [SI] of the values whose rounding gives the printed number."""
    low, high = row.ends
    return low - row.last_digit / 2, high + row.last_digit / 2


def _span(values: list[float]) -> str:
    return f"{min(values):.2g} to {max(values):.2g} h_rms"
