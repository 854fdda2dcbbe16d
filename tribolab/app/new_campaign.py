"""Template of a campaign file with comments: `tribolab new`."""

from __future__ import annotations

from pathlib import Path

from tribolab.app.first_campaign import NAME, RESULTS, campaign_text
from tribolab.app.raw_folder import files_in
from tribolab.core.errors import ConfigError

_EMPTY = '[campaign]\nname = "my campaign"\nraw = "raw"\n\n[[run]]\nfiles = "*.csv"\n'
COMMENTED = """
# Remove the # in front of what you state. CAMPAIGN.md lists every key.

# [contact]                      # a cylinder on a soft flat: contact area and model
# radius = "7 cm"
# length = "10 cm"
# youngs_modulus = "1.5 MPa"
# poisson_ratio = 0.5

# [medium.glycerol]              # what is between the surfaces
# viscosity = "1.4 Pa s"
# work_of_adhesion = "40 mJ/m^2"

# [segments]
# trim = "10 %"                  # share of each segment that is left out at each end
# discard = "50 m"               # beginning of each run that is left out: m, s or cycles
# steady = "auto"                # leave out running-in, where it is found

# [uncertainty.tilt]             # calibration; without it all +- are statistical only
# value = "0.5 deg"
# as = "half-width"

# [qc]
# fail_on = "suspect"            # exit code 1 from which finding on
"""


def write_new_campaign(folder: Path) -> Path:
    """Write a commented campaign file for the raw files of a folder, without running it.

    Parameters
    ----------
    folder
        Folder with or without raw files.

    Raises
    ------
    ConfigError
        If a campaign file exists, or the folder does not.
    """
    if not folder.is_dir():
        raise ConfigError(f"{folder}: there is no such folder")
    file = folder / NAME
    files = [path.resolve() for path in files_in(folder)]
    text = campaign_text(files, folder.resolve(), RESULTS) if files else _EMPTY
    try:
        with file.open("x", encoding="utf-8") as new:
            new.write(text + COMMENTED)
    except FileExistsError:
        raise ConfigError(
            f"{file} exists already", cure="edit it, or name another folder"
        ) from None
    except OSError as error:
        raise ConfigError(f"{file}: the campaign file cannot be written: {error}") from error
    return file
