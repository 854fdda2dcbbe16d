"""Settings that the text or the name of a file states, as numbers with units or as words."""

from __future__ import annotations

import re

from tribolab.reading.interpret.amounts import Amount, Amounts, amounts_of_name, speed_of_name
from tribolab.reading.interpret.settings import add_unique, amounts_of, texts_of
from tribolab.reading.unknown.layout.text_layout import Layout

_MAX_REPEATED = 12  # settings of a run; more would make a long dialect
_MAX_OF_SCAN = 200  # settings of a profilometer; the few that are needed may come last


def numeric_settings(layout: Layout, *, bare: bool = False) -> Amounts:
    """Return the amounts that the text and the name of a file state, a dozen at most.

    With `bare`, for a table of heights, more are returned, and a header is not required.
    """
    found = {amount.name: amount for amount in amounts_of_name(layout.file.path.name)}
    above = _text_above(layout, bare=bare)
    for amount in amounts_of(above, (_MAX_OF_SCAN if bare else _MAX_REPEATED) - len(found)):
        add_unique(found, amount)
    if (speed := speed_of_name(layout.file.path.name)) is not None:
        found.setdefault("set_speed", speed)
    return Amounts(_of_steps(amount, layout) for amount in found.values())


def text_settings(layout: Layout, *, bare: bool = False) -> tuple[tuple[str, str], ...]:
    """Return the settings in words above the table: "Drive: crank" as ("Drive", "crank")."""
    return texts_of(_text_above(layout, bare=bare))


def lines_without_unit(layout: Layout, *, bare: bool = False) -> list[str]:
    """Return the lines that state a length, a load or a stroke frequency without a unit."""
    of_run = ("track_radius", "track_diameter", "arm", "stroke", "frequency", "load")
    wanted = ("pitch", "profile_length") if bare else of_run
    return [amount.text for amount in numeric_settings(layout, bare=bare).of(*wanted, unit="")]


def _text_above(layout: Layout, *, bare: bool) -> tuple[str, ...]:
    return tuple(layout.text_above(bare=bare or layout.width == 1))


def _of_steps(amount: Amount, layout: Layout) -> Amount:
    """Return an amount with source "step" if the text before later tables states other values."""
    if not layout.repeats or amount.source != "preamble":
        return amount
    edges = [0, *(edge for block in layout.blocks for edge in (block.start, block.stop))]
    texts = ["\n".join(layout.lines[a:b]) for a, b in zip(edges[::2], edges[1::2], strict=False)]
    said = {match[1] for t in texts for match in re.finditer(amount.pattern, t, re.MULTILINE)}
    return amount._replace(source="step") if len(said) > 1 else amount
