"""Files of more objects than a measurement has cost one message each, at once."""

import time

import h5py
import pytest

import tribolab as tl
from tribolab.campaign.settings.load import load_campaign
from tribolab.errors import ConfigError, ReadError


@pytest.mark.parametrize("deep", [False, True])
def test_ten_thousands_of_groups_or_levels_are_refused(deep, tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        group = file
        for number in range(300 if deep else 12_000):
            made = group.create_group(f"g{number}")
            group = made if deep else file
    with pytest.raises(ReadError, match=r"a\.h5: more than 10000 groups and datasets"):
        tl.read(tmp_path / "a.h5")


def test_a_campaign_of_150_000_runs_is_refused_at_once(tmp_path):
    path = tmp_path / "campaign.toml"
    path.write_text('[campaign]\nname = "x"\n' + '[[run]]\nfiles = "a.csv"\n' * 150_000)
    began = time.process_time()
    with pytest.raises(ConfigError, match=r"150000 tables such as \[\[run\]\]"):
        load_campaign(path)
    assert time.process_time() - began < 5
