"""What the tests of drafted dialects share."""

from tribolab.draft.dialect.draft import draft_dialect, save_draft
from tribolab.draft.read import read
from tribolab.draft.scans import read_scans
from tribolab.io.dialects.find import load_dialect


def drafted(path, tmp_path):
    """The dataset that the drafted TOML reads, and the draft."""
    draft = draft_dialect(path)
    toml = save_draft(draft, tmp_path / f"{draft.name}.toml")
    load_dialect(toml)
    if draft.kind == "scan":
        return read_scans(path, instrument=toml), draft
    return read(path, instrument=toml, pair=False), draft
