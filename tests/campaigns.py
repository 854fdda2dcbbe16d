"""A small simulated campaign that several test files work on."""

import hashlib
import re
import shutil
from pathlib import Path

from tribolab.campaign.store.new_catalogue import Store
from tribolab.campaign.surfaces.stage import Surfaces, SurfaceTask, process_surface
from tribolab.rig import simulate_campaign

RUNS = ("sb-r_glycerol_31N_01", "sb-r_glycerol_31N_02", "sb-r_dry_31N_01", "sb-r_dry_31N_02")


def simulated(
    folder: Path,
    repeats: int = 2,
    scans: bool = False,
    models: bool = False,
    faults: tuple[str, ...] = (),
) -> Path:
    """Runs in glycerol and dry, in repeats, at three speeds; returns campaign.toml.

    The campaign file names the scans only if asked to: tests of runs need no contact mechanics.
    The same holds for models; their own uncertainty is left out in any case.
    """
    small = {"small": True, "surfaces": ("Sb-R",), "n_repeats": repeats, "faults": faults}
    file = simulate_campaign(folder / "campaign", **small)
    text = file.read_text("utf-8")
    if not scans:
        text = re.sub(r"(?m)^scans = .*\n", "", text)
    assert "[model]" not in text
    setting = 'uncertainty = "none"' if models else "compute = false"
    file.write_text(f"{text}\n[model]\n{setting}\n", "utf-8")
    return file


def surfaces_alone(campaign: Path, normal_forces: tuple[str, ...] = ("31 N",)) -> Path:
    """Take the runs out of a campaign file, and state the loads that they told."""
    head, _, _ = campaign.read_text("utf-8").partition("[[run]]")
    loads = f"\n[model]\nnormal_forces = {list(normal_forces)}\n"
    campaign.write_text(head + loads, "utf-8")
    return campaign


def made_and_taken_over(folder: Path, surface, change=None):
    """Process a surface, and look for it in its catalogue: both records, None if it is not known.

    `change` may spoil the results or the scans; it gives the surface that is looked for.
    """
    (folder / "data").mkdir(exist_ok=True)
    store, task = Store(folder), SurfaceTask(surface, folder)
    first = Surfaces(None, (), store).keep(task, 0, process_surface(task))
    store.close()
    later = folder / "later"
    later.mkdir(exist_ok=True)
    asked = surface if change is None else change()
    store = Store(later, folder)
    again = Surfaces(None, (), store).known(SurfaceTask(asked, later), 0)
    store.close()
    return first, again


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
