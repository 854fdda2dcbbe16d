"""Table of all objections of the checks on several runs or scans."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tribolab.core.errors import AnalysisError, shown
from tribolab.qc.findings import Findings

if TYPE_CHECKING:
    import pandas as pd

_COLUMNS = ["check", "status", "variable", "message", "cure"]
_OBJECTING = ("suspect", "fail", "error")


def objections(
    findings: Findings | Sequence[Findings], **labels: Sequence[str | float]
) -> pd.DataFrame:
    """Return a table with one row for each objection.

    Parameters
    ----------
    findings
        From `check`, `check_scans` or `check_scan_set`, for one or several runs or scans.
    **labels
        One label for each set of findings, e.g. ``fault=["spikes", "gaps"]``; by default their
        ``name``.

    Returns
    -------
    pandas.DataFrame
        The labels, ``check``, ``status``, ``variable``, ``message`` and ``cure``; checks without
        objection have no row.

    Raises
    ------
    AnalysisError
        If the number of labels differs from that of the findings.

    Examples
    --------
    >>> import tribolab as tl
    >>> run = tl.rig.simulate_trace(noise=0.02)
    >>> table = objections(tl.check([run, run]), rig=["old", "new"])
    >>> table.columns.tolist()[:3], set(table.rig) <= {"old", "new"}
    (['rig', 'check', 'status'], True)
    """
    # imported late: pandas loads slowly
    import pandas as pd

    every = [findings] if isinstance(findings, Findings) else list(findings)
    names = {name: list(given) for name, given in labels.items()} or {
        "name": [each.name for each in every]
    }
    for name, given in names.items():
        if len(given) != len(every):
            raise AnalysisError(
                f"{shown(name)}: {len(given)} labels are given for {len(every)} that were checked; "
                "give one for each"
            )
    tables = [
        each.table[_COLUMNS].assign(**{name: given[k] for name, given in names.items()})
        for k, each in enumerate(every)
    ]
    columns = [*names, *_COLUMNS]
    whole = pd.concat(tables, ignore_index=True) if tables else pd.DataFrame(columns=columns)
    return whole.loc[whole["status"].isin(_OBJECTING), columns].reset_index(drop=True)
