"""Earlier results that are kept because what they were made from cannot be read now.

A file that is empty, locked or away for an hour must not take good results with it. What is kept
says so, and since when; it is dropped when the campaign no longer names its files.
"""

from __future__ import annotations

from pathlib import Path

# The files were read, and the answer is about what is in them: it stands.
VERDICTS = ("AnalysisError",)
GONE = "it is not there"


def kept_text(path: Path, why: str) -> str:
    """Return since when a part is kept, as its data file knows it, and why."""
    from tribolab.io.netcdf import opened

    try:
        with opened(path) as file:
            when = str(getattr(file, "history", "")).split(" ")[0]
    except (OSError, RuntimeError):
        when = ""
    return f"kept from {when or 'before'}: {why}"
