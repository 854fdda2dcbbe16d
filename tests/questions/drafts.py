"""What the tests of drafted dialects share."""

from tribolab.reading.dialect.find import load_dialect
from tribolab.reading.run_files import read
from tribolab.reading.scan_files import read_scans
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft


def drafted(path, tmp_path):
    """The dataset that the drafted TOML reads, and the draft."""
    draft = draft_dialect(path)
    toml = save_draft(draft, tmp_path / f"{draft.name}.toml")
    load_dialect(toml)
    if draft.kind == "scan":
        return read_scans(path, instrument=toml), draft
    return read(path, instrument=toml, pair=False), draft
