"""Generated page raw_data_schema/LIMITS.md, which lists the limits of all subpackages."""

from __future__ import annotations

import importlib
from pathlib import Path

from tribolab.core.limit import Limit

LIMITS_PAGE = "LIMITS.md"
_PIPE = r"\|"
_HEAD = """# The limits

Every number that decides a result, by subpackage, with its reason and its source: a script and its
seeds, a standard, a paper, or judgement. These limits are constants of the code. A campaign file
can change only the limits of checks, which are in [CHECKS.md](CHECKS.md). This page is generated
from the code.
"""


def limits_page() -> str:
    """Return the text of the page: all `Limit` records of the modules called ``limits``.

    Examples
    --------
    >>> "## friction/segments" in limits_page()
    True
    """
    package = Path(__file__).parents[1]
    lines = [_HEAD]
    for path in sorted(package.rglob("limits.py")):
        room = path.parent.relative_to(package)
        module = importlib.import_module(".".join(("tribolab", *room.parts, "limits")))
        rows = [_row(name, each) for name, each in vars(module).items() if isinstance(each, Limit)]
        if rows:
            lines += [f"## {room.as_posix()}\n", f"{module.__doc__}\n"]
            lines += ["| name | value | unit | what it limits | source |", "| - | - | - | - | - |"]
            lines += [*rows, ""]
    return "\n".join(lines)


def _row(name: str, limit: Limit) -> str:
    cells = (name, f"{limit.value:g}", limit.unit, limit.reason, limit.source)
    return f"| {' | '.join(cell.replace('|', _PIPE) for cell in cells)} |"
