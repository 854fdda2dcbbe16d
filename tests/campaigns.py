"""A small simulated campaign that several test files work on."""

import hashlib
import re
import shutil
from pathlib import Path

from tribolab.rig import simulate_campaign

RUNS = ("sb-r_glycerol_31N_01", "sb-r_glycerol_31N_02", "sb-r_dry_31N_01", "sb-r_dry_31N_02")


def simulated(folder: Path, repeats: int = 2, scans: bool = False, models: bool = False) -> Path:
    """Runs in glycerol and dry, in repeats, at three speeds; returns campaign.toml.

    The campaign file names the scans only if asked to: tests of runs need no contact mechanics.
    The same holds for models; their own uncertainty is left out in any case.
    """
    file = simulate_campaign(folder / "campaign", small=True, surfaces=("Sb-R",), n_repeats=repeats)
    text = file.read_text("utf-8")
    if not scans:
        text = re.sub(r"(?m)^scans = .*\n", "", text)
    assert "[model]" not in text
    setting = 'uncertainty = "none"' if models else "compute = false"
    file.write_text(f"{text}\n[model]\n{setting}\n", "utf-8")
    return file


def copied(campaign: Path, folder: Path) -> Path:
    """Copy a campaign so that a test may spoil it; returns its campaign.toml."""
    return shutil.copytree(campaign.parent, folder / "campaign") / campaign.name


def fingerprint(folder: Path) -> dict[str, tuple[str, int]]:
    """Content and time of change of every file below a folder."""
    return {
        str(path.relative_to(folder)): (
            hashlib.sha256(path.read_bytes()).hexdigest(),
            path.stat().st_mtime_ns,
        )
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }
