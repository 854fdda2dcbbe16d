"""Derived quantities of a run: formulas with columns, and with values outside the table."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.arrays.chunks import lowered
from tribolab.arrays.medians import median
from tribolab.core.errors import Cure, ReadError, UnitError
from tribolab.core.untyped import Json
from tribolab.reading.dialect.column_rule import Value
from tribolab.reading.dialect.formula import (
    Operand,
    evaluate,
    in_base_units,
    names_in,
    parse_formula,
)
from tribolab.reading.dialect.model import Derived, Dialect
from tribolab.reading.raw.missing_marks import measurable
from tribolab.units.quantities import QUANTITIES, quantity

_LIGHT, _UNLOADED = 0.4, 0.1  # of the usual normal stress: limits of light and of zero load
_MIN_SAMPLES_OF_ZERO = 20  # samples needed for a zero
# shares of the usual speed: motion above it, and largest deviation of one speed
_MOVES, _ONE_SPEED = 0.5, 0.1
_NO_CONTACT = 0.02  # share of the greatest normal stress below which there is no contact


def add_derived(
    columns: dict[str, np.ndarray],
    symbols: Mapping[str, str],
    attrs: Json,
    rows: int,
    where: str,
    dialect: Dialect,
) -> None:
    """Add quantities computed by formulas, and remove columns needed only for them.

    Parameters
    ----------
    columns
        Arrays in SI by quantity or symbol (time); changed in place.
    symbols
        SI units of the symbols.
    attrs
        Attributes of the run, including values outside the table; the formulas are added as
        ``derived``.
    rows
        Number of rows.
    where
        The run, for messages.
    dialect
        The instrument's dialect.

    Raises
    ------
    ReadError
        If an input of a formula is missing, or units do not match. The message lists all missing
        inputs.
    """
    # units are needed for formulas only; their library loads slowly
    known = _operands(columns, symbols, attrs, dialect) if dialect.derived else {}
    missing, formulas = [], {}
    for rule in dialect.derived:
        if rule.quantity in columns:
            continue
        lost = sorted({*names_in(parse_formula(rule.formula)), *rule.beside} - set(known))
        if lost and rule.optional:
            continue
        if lost:
            missing.append(f"{rule.quantity} = {rule.formula} needs {', '.join(lost)}")
            continue
        unit = quantity(rule.quantity).unit
        values = _evaluated(rule, known, unit, where)
        columns[rule.quantity] = measurable(np.broadcast_to(values, rows).astype(float))
        known[rule.quantity] = in_base_units(columns[rule.quantity], unit)
        formulas[rule.quantity] = rule.formula
    if missing:
        raise ReadError(
            f"what a formula needs is not there: {'; '.join(missing)} (instrument "
            f"'{dialect.name}')",
            where=where,
            cure=Cure(*["mend [[column]], [[value]] or [[derived]] in the dialect"] * 3),
        )
    if zeros := _stated_zeros(formulas, dialect):
        attrs["zeros_stated"] = zeros
    _add_ratio_of_stresses(columns, formulas, attrs)
    _add_stated_rotation(columns, attrs, dialect)
    for name in symbols:
        columns.pop(name, None)
    if formulas:
        attrs["derived"] = formulas


def _add_stated_rotation(columns: dict[str, np.ndarray], attrs: Json, dialect: Dialect) -> None:
    """Add the rotation speed stated in the header as a column, if the run has one speed."""
    turns = [v for v in dialect.value if v.unit is not None and v.si_unit == "rad/s"]
    stated = [number for value in turns if (number := _number(value, attrs))]
    velocity = np.abs(columns.get("sliding_velocity", np.zeros(0)))
    moving = velocity[velocity > _MOVES * np.nanmax(velocity, initial=0.0)]
    if "rotation_speed" in columns or len(stated) != 1 or not moving.size:
        return
    share = velocity / median(moving)
    if np.mean(np.abs(share - 1) < _ONE_SPEED) > 0.9 * moving.size / velocity.size:
        columns["rotation_speed"] = stated[0] * np.where(share > _MOVES, 1.0, share)


def _add_ratio_of_stresses(
    columns: dict[str, np.ndarray], formulas: dict[str, str], attrs: Json
) -> None:
    """Add the friction coefficient of a run with shear and normal stress; subtract their zeros."""
    slides = {"sliding_velocity", "position", "rotation_speed", "set_speed"} & set(columns)
    known = {"friction_force", "friction_coefficient"} & set(columns)
    if known or not slides or not {"shear_stress", "normal_stress"} <= set(columns):
        return
    free = _without_contact(columns["normal_stress"])
    for name in ("shear_stress", "normal_stress"):
        if free.any():
            zero = float(np.nanmean(columns[name][free]))
            columns[name] = lowered(columns[name], zero)
            attrs[f"{name}_zero_Pa"] = zero
    normal = columns["normal_stress"]
    pressed = normal > _NO_CONTACT * np.nanmax(np.abs(normal), initial=0.0)
    ratio = np.full(normal.size, np.nan)
    np.divide(columns["shear_stress"], normal, out=ratio, where=pressed)
    columns["friction_coefficient"] = ratio
    formulas["friction_coefficient"] = "shear_stress / normal_stress"


def _without_contact(normal: np.ndarray) -> np.ndarray:
    """Return a mask of the samples without contact, whose normal stress is constant and small."""
    usual = np.nanpercentile(np.abs(normal), 75)
    light = np.abs(normal) < _LIGHT * usual
    if np.count_nonzero(light) < _MIN_SAMPLES_OF_ZERO:
        return np.zeros(normal.size, dtype=bool)
    level = median(normal[light])
    scatter = median(np.abs(normal[light] - level)) / 0.6745
    free = light & (np.abs(normal - level) <= 5 * max(scatter, 1e-4 * usual))
    return free if np.abs(level) < _UNLOADED * usual else np.zeros(normal.size, dtype=bool)


def _evaluated(
    rule: Derived, known: Mapping[str, Operand], unit: str, where: str
) -> np.ndarray | float:
    try:
        return evaluate(rule.formula, known, unit)
    except UnitError as error:
        raise ReadError(f"{rule.quantity}: {error}", where=where) from error


def _stated_zeros(formulas: Mapping[str, str], dialect: Dialect) -> Json:
    """Return the names of stated zeros that the formula of the friction force contains."""
    zeros = {value.name for value in dialect.value if value.name.endswith("_zero")}
    return {
        name: ", ".join(sorted(zeros & names_in(parse_formula(formula))))
        for name, formula in formulas.items()
        if name == "friction_force" and zeros & names_in(parse_formula(formula))
    }


def _operands(
    columns: Mapping[str, np.ndarray], symbols: Mapping[str, str], attrs: Json, dialect: Dialect
) -> dict[str, Operand]:
    known = {}
    for name, values in columns.items():
        if name in symbols or name in QUANTITIES:
            unit = symbols[name] if name in symbols else quantity(name).unit
            known[name] = in_base_units(values, unit)
    for value in dialect.value:
        number = _number(value, attrs)
        if number is not None:
            known[value.name] = in_base_units(number, value.si_unit)
    return known


def _number(value: Value, attrs: Json) -> float | None:
    """Return a value outside the table; None if it is not available or no number."""
    number = attrs.get(value.attribute) if value.unit is not None else None
    return float(number) if isinstance(number, float | int) else None
