"""Short HTML of a result in a notebook: a heading and a list of entries."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape


def html_list(heading: str, entries: Iterable[tuple[str, object]]) -> str:
    """Return the HTML of a heading and a list of entries, each with its name in bold.

    Examples
    --------
    >>> html_list("2 runs", [("a & b", "pass")])
    '<p><b>2 runs</b></p><ul><li><b>a &amp; b</b> pass</li></ul>'
    """
    rows = "".join(
        f"<li><b>{escape(name)}</b> {escape(str(content))}</li>" for name, content in entries
    )
    return f"<p><b>{escape(heading)}</b></p><ul>{rows}</ul>"
