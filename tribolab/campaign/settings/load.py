"""A campaign file is read, and checked against itself and what lies beside it."""

from __future__ import annotations

from pathlib import Path

from tribolab.campaign.settings import problems
from tribolab.campaign.settings.config import Campaign
from tribolab.campaign.settings.names import of_names
from tribolab.campaign.settings.plan import PlannedRun, plan
from tribolab.campaign.settings.toml_file import checked, text_of
from tribolab.errors import ConfigError


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
    """Read and check a campaign file, and return its runs with it; else as `load_campaign`."""
    path = Path(path)
    path = (path / "campaign.toml" if path.is_dir() else path).absolute()
    text = text_of(path, "'tribolab demo' makes a campaign to start from")
    campaign, wrong = checked(path, text, Campaign, "campaign")
    if campaign is not None:
        campaign.lies_at(path)
        # names first: no file is looked at with an instrument that nobody knows
        wrong = of_names(campaign)
        if not wrong:
            runs, wrong = plan(campaign)
        if not wrong:
            return campaign, runs
    raise ConfigError(problems.message(wrong, path, text))
