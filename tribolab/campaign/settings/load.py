"""Reading and checking of a campaign file."""

from __future__ import annotations

from pathlib import Path

from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.moved_keys import move_keys
from tribolab.campaign.settings.naming.files_named import with_named_parts
from tribolab.campaign.settings.naming.names import of_names
from tribolab.campaign.settings.plan import PlannedRun, plan_runs
from tribolab.campaign.settings.toml_file import open_settings, settings_path


def load_campaign(path: str | Path) -> Campaign:
    r"""Read and check a campaign file.

    Parameters
    ----------
    path
        The TOML file, or the folder in which it is called ``campaign.toml``.

    Returns
    -------
    Campaign
        With quantities as floats in SI units.

    Raises
    ------
    ConfigError
        If anything in it is wrong: the message has the file, the line, the key and the cure.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     (Path(folder) / "raw").mkdir()
    ...     _ = (Path(folder) / "raw" / "one.csv").write_text("")
    ...     file = Path(folder) / "campaign.toml"
    ...     _ = file.write_text(
    ...         '[campaign]\nname = "one"\n[medium.glycerol]\nviscosity = "1.4 Pa s"\n'
    ...         '[[run]]\nfiles = "*.csv"\nmedium = "glycerol"\n'
    ...     )
    ...     load_campaign(file).medium["glycerol"].viscosity
    1.4
    """
    return load_and_plan(path)[0]


def load_and_plan(path: str | Path) -> tuple[Campaign, tuple[PlannedRun, ...]]:
    """Read and check a campaign file; return the campaign and its planned runs."""
    missing = "'tribolab demo' makes a campaign to start from"
    file = open_settings(
        settings_path(path, "campaign.toml"), Campaign, "campaign", missing, move_keys
    )
    file.content.set_file(file.path)
    # check names first: files cannot be read with an unknown instrument
    if wrong := of_names(file.content):
        raise file.error(wrong)
    campaign = with_named_parts(file.content)
    runs, wrong = plan_runs(campaign)
    if wrong:
        raise file.error(wrong)
    return campaign, runs
