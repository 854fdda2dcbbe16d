"""Formulas for derived columns: ``+ - * / ( )`` of numbers and names, never evaluated as code.

Names are those of columns and values, and ``pi``; a number with a unit is in quotes. Every part has
a dimension, and sums of different dimensions are refused.
"""

from __future__ import annotations

import ast
import functools
import re
import warnings
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tribolab.core.aliases import Array
from tribolab.core.errors import UnitError, nearest, shown
from tribolab.units.conversion import base_unit, registry, to_si

_MAX_FORMULA = 300  # characters
_QUANTITY = re.compile(r"\s*[+-]?[\d.]+(?:[eE][+-]?\d+)?\s*(?P<unit>.*?)\s*$")

Dimension = tuple[tuple[str, float], ...]  # base dimensions and their powers, in order of name


class Operand(NamedTuple):
    """Number or array in SI base units, with its dimension."""

    value: Array | float
    dimension: Dimension


@functools.lru_cache(maxsize=256)
def dimension_of(unit: str) -> Dimension:
    """Return the dimension of a unit.

    Examples
    --------
    >>> dimension_of("N/m") == dimension_of("kg/s2"), dimension_of("rad/s") == dimension_of("Hz")
    (True, True)
    """
    if unit in ("", "1"):
        return ()
    powers = registry().Quantity(1.0, base_unit(unit)).dimensionality
    return tuple(sorted((str(name), float(str(power))) for name, power in powers.items() if power))


def in_base_units(value: Array | float, si_unit: str) -> Operand:
    """Return a number or an array in an SI unit as an operand."""
    return Operand(value, dimension_of(si_unit))


@functools.lru_cache(maxsize=128)
def parse_formula(text: str) -> ast.expr:
    """Return the syntax tree of a formula, after checking its grammar and units.

    Parameters
    ----------
    text
        For example ``"torque / (radius + '25 mm')"``.

    Raises
    ------
    UnitError
        If it violates the grammar, or contains an unknown unit.

    Examples
    --------
    >>> sorted(names_in(parse_formula("rotation_speed * (radius - '2 mm') / 2")))
    ['radius', 'rotation_speed']
    """
    if len(text) > _MAX_FORMULA:
        raise UnitError(f"formula '{shown(text)}' is longer than {_MAX_FORMULA} letters")
    text = text.strip()
    try:
        with warnings.catch_warnings():  # Python only warns of text such as "1if"
            warnings.simplefilter("ignore")
            tree = ast.parse(text, mode="eval")
    except (SyntaxError, ValueError, MemoryError, RecursionError) as error:
        raise _wrong(text, str(error)) from error
    _check(tree.body, text)
    return tree.body


def names_in(formula: ast.expr) -> set[str]:
    """Return the names that a formula needs, except ``pi``."""
    return {part.id for part in ast.walk(formula) if isinstance(part, ast.Name)} - {"pi"}


def evaluate(text: str, known: Mapping[str, Operand], si_unit: str) -> Array | float:
    """Return the value of a formula in an SI unit.

    Parameters
    ----------
    text
        The formula.
    known
        Values of its names: arrays (time) or single numbers.
    si_unit
        SI unit of the result.

    Returns
    -------
    numpy.ndarray or float
        Result in `si_unit`; infinite or NaN after division by zero.

    Raises
    ------
    UnitError
        If a name is unknown, a sum has parts of different dimensions, or the dimension of the
        result differs from `si_unit`.

    Examples
    --------
    >>> known = {"rotation_speed": in_base_units(np.array([1.0, 2.0]), "rad/s")}
    >>> evaluate("rotation_speed * '25 mm'", known, "m/s").tolist()
    [0.025, 0.05]
    >>> evaluate("rotation_speed + '25 mm'", known, "m/s")
    Traceback (most recent call last):
    tribolab.core.errors.UnitError: formula 'rotation_speed + '25 mm'': 1/s and m cannot be added
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        result = _value(parse_formula(text), known, text)
    if result.dimension != dimension_of(si_unit):
        raise UnitError(
            f"formula '{shown(text)}' gives {_written(result.dimension)}, and not {si_unit}"
        )
    return result.value


def _value(tree: ast.expr, known: Mapping[str, Operand], text: str) -> Operand:
    match tree:
        case ast.Name(id="pi"):
            return Operand(np.pi, ())
        case ast.Name(id=name):
            if name not in known:
                hint = nearest(name, known)
                raise UnitError(f"formula '{shown(text)}': there is no '{shown(name)}'{hint}")
            return known[name]
        case ast.Constant(value=str() as said):
            return _quantity(said, text)
        case ast.Constant(value=number):
            return Operand(float(number), ())  # type: ignore[arg-type]  # as checked
        case ast.UnaryOp(operand=inner):
            operand = _value(inner, known, text)
            return operand._replace(value=-operand.value)
    assert isinstance(tree, ast.BinOp)  # `_check` allows nothing else
    left, right = (_value(side, known, text) for side in (tree.left, tree.right))
    if isinstance(tree.op, ast.Add | ast.Sub):
        if left.dimension != right.dimension:
            raise UnitError(
                f"formula '{shown(text)}': {_written(left.dimension)} and "
                f"{_written(right.dimension)} cannot be added"
            )
        added = isinstance(tree.op, ast.Add)
        return left._replace(value=left.value + right.value if added else left.value - right.value)
    times = isinstance(tree.op, ast.Mult)
    value = left.value * right.value if times else np.divide(left.value, right.value)
    return Operand(value, _multiplied(left.dimension, right.dimension, 1.0 if times else -1.0))


def _multiplied(left: Dimension, right: Dimension, power: float) -> Dimension:
    powers = dict(left)
    for name, own in right:
        powers[name] = powers.get(name, 0.0) + power * own
    return tuple(sorted((name, own) for name, own in powers.items() if abs(own) > 1e-9))


_BASE = {"[length]": "m", "[mass]": "kg", "[time]": "s", "[temperature]": "K", "[current]": "A"}


def _written(dimension: Dimension) -> str:
    """Return a dimension in terms of SI base units."""

    def product(parts: list[tuple[str, float]]) -> str:
        return " ".join(f"{_BASE.get(n, n)}{'' if p == 1 else f'{p:g}'}" for n, p in parts)

    above = [(name, power) for name, power in dimension if power > 0]
    below = [(name, -power) for name, power in dimension if power < 0]
    return (product(above) or "1") + (f"/{product(below)}" if below else "") if dimension else "1"


def _check(tree: ast.expr, text: str) -> None:
    """Raise for any Python syntax that is not part of a formula."""
    match tree:
        case ast.BinOp(op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div()):
            _check(tree.left, text)
            _check(tree.right, text)
        case ast.UnaryOp(op=ast.USub()):
            _check(tree.operand, text)
        case ast.Constant(value=str() as said) if _written_as(tree, text) == f"'{said}'":
            _quantity(said, text)
        case ast.Name():
            pass
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            pass
        case _:
            raise _wrong(text, f"'{shown(_written_as(tree, text), 20)}' is not allowed")


def _written_as(tree: ast.expr, text: str) -> str:
    return ast.get_source_segment(text, tree) or ""


def _wrong(text: str, why: str) -> UnitError:
    return UnitError(
        f"formula '{shown(text)}' has to be names and numbers with + - * / ( ): {shown(why, 60)}; "
        "put a number with a unit in quotes, e.g. \"rotation_speed * '25 mm'\""
    )


@functools.lru_cache(maxsize=128)
def _quantity(text: str, formula: str) -> Operand:
    match = _QUANTITY.match(text)
    if match is None:
        raise UnitError(f"formula '{shown(formula)}': '{shown(text)}' has no number")
    unit = match["unit"]
    try:
        si_unit = _si_unit(unit)
        return Operand(to_si(text, si_unit, "a quantity"), dimension_of(si_unit))
    except UnitError as error:
        raise UnitError(f"formula '{shown(formula)}': {error}") from error


def _si_unit(unit: str) -> str:
    """Return a unit expressed in SI base units, spelled so that `to_si` accepts it."""
    return base_unit(unit).replace("**", "^") if unit not in ("", "1") else "1"
