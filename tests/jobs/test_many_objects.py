"""Files of more objects than a measurement has cost one message each, at once."""

import time
import zlib

import h5py
import pytest
from hostile.bombs import BOMBS

import tribolab as tl
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.store import catalogue
from tribolab.core.errors import ConfigError, ReadError
from tribolab.records.runs.run_record import RunRecord


@pytest.mark.parametrize("deep", [False, True])
def test_thousands_of_groups_or_levels_are_refused(deep, tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        group = file
        for number in range(300 if deep else 6000):
            made = group.create_group(f"g{number}")
            group = made if deep else file
    with pytest.raises(ReadError, match=r"a\.h5: more than 5000 groups and datasets"):
        tl.read(tmp_path / "a.h5")


def test_ten_thousands_of_attributes_are_refused(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w", libver="latest") as file:
        for number in range(20_001):
            file.attrs[f"a{number}"] = number
    with pytest.raises(ReadError, match=r"20000 attributes"):
        tl.read(tmp_path / "a.h5")


QUICK = "a.mat c.mat d.csv.gz a.parquet b.parquet a.npz a.x3p a.json a.xls".split()


@pytest.mark.slow
@pytest.mark.parametrize("bomb", [name for name in BOMBS if name.split(":")[0] in QUICK])
def test_a_bomb_costs_one_message_and_5_s(bomb, tmp_path):
    path = tmp_path / bomb.split(":")[0]
    BOMBS[bomb](path)
    began = time.process_time()
    for reader in (tl.read, tl.read_scans):
        with pytest.raises(ReadError, match=path.name):
            reader(path)
    assert time.process_time() - began < 10


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("".join(f"k{n} = 1\n" for n in range(60_000)), "more than 50000 keys"),
        ("# a\n" * 3_000_000, "12 MB are more than the 8 MB"),
        ('title = "\\u001b[31mred"\n', r"title = '\?\[31mred' contains a control character"),
    ],
)
def test_a_campaign_of_too_much_or_of_control_characters_is_refused(more, words, tmp_path):
    path = tmp_path / "campaign.toml"
    path.write_text(f'[campaign]\nname = "x"\n{more}[[run]]\nfiles = "a.csv"\n')
    with pytest.raises(ConfigError, match=words):
        load_campaign(path)


def test_a_bomb_in_the_catalogue_is_not_known(monkeypatch):
    monkeypatch.setattr(catalogue, "MAX_RECORD", 1 << 24)
    packed = zlib.compress(b'"' + bytes(1 << 25) + b'"')
    assert len(catalogue._inflated(packed)) < 1 << 25
    assert list(catalogue._entries([("a", "f", packed)], RunRecord)) == []


def test_a_campaign_of_150_000_runs_is_refused_at_once(tmp_path):
    path = tmp_path / "campaign.toml"
    path.write_text('[campaign]\nname = "x"\n' + '[[run]]\nfiles = "a.csv"\n' * 150_000)
    began = time.process_time()
    with pytest.raises(ConfigError, match=r"150000 tables such as \[\[run\]\]"):
        load_campaign(path)
    assert time.process_time() - began < 5
