"""What a table of the steps to come, above the signals, says of each: the programme of a test."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tribolab.core.errors import ReadError, shown
from tribolab.reading.content.model import Content
from tribolab.reading.content.values import converted
from tribolab.reading.dialect.model import Dialect
from tribolab.reading.dialect.value_rule import Value
from tribolab.reading.text.bounded_patterns import guarded


def programme_values(
    contents: list[Content], columns: Mapping[str, np.ndarray], dialect: Dialect
) -> dict[str, np.ndarray]:
    """Return what the programme says of the step of each row, in SI (time); NaN of other steps.

    Parameters
    ----------
    contents
        The files of the run; the programme stands in the text before the first table.
    columns
        Signals of the run, with ``step`` (time).
    dialect
        The instrument's, whose values with ``source = "programme"`` are looked for.

    Raises
    ------
    ReadError
        If such a value is no number, or the programme says two of one step.
    """
    if "step" not in columns:
        return {}
    step = np.asarray(columns["step"], dtype=float)
    result = {}
    for value in dialect.value:
        if value.source != "programme" or value.pattern is None:
            continue
        said: dict[float, float] = {}
        for match in guarded(value.pattern).all(contents[0].pieces[0].before):
            number, of_step = _number_of(match[1], value, contents[0], dialect), match[2]
            if not of_step:
                continue
            in_si = float(converted(of_step, value, contents[0], dialect))
            if said.setdefault(number, in_si) != in_si:
                raise ReadError(
                    f"the programme says two values of {shown(value.name)} of step {number:g}",
                    where=contents[0].path,
                )
        if said:
            steps = np.array(sorted(said))
            place = np.searchsorted(steps, step).clip(0, steps.size - 1)
            numbers = np.array([said[each] for each in steps])
            result[value.name] = np.where(steps[place] == step, numbers[place], np.nan)
    return result


def programmed_steps(before: str, dialect: Dialect) -> int:
    """Count the rows of the programme in the text before the first table; 0 without one.

    Parameters
    ----------
    before
        The text.
    dialect
        As for `programme_values`.
    """
    patterns = [v.pattern for v in dialect.value if v.source == "programme" and v.pattern]
    return max((sum(1 for _ in guarded(p).all(before)) for p in patterns), default=0)


def _number_of(text: str | None, value: Value, content: Content, dialect: Dialect) -> float:
    try:
        return float(text or "")
    except ValueError as error:
        raise ReadError(
            f"'{shown(str(text))}' is no number of a step of the programme; see the pattern of "
            f"{shown(value.name)} in the dialect '{dialect.name}'",
            where=content.path,
        ) from error
