"""Runs whose segments are an instrument's steps of unknown speed: what is said of them."""

import pytest

from tribolab import cli
from tribolab.campaign import pipeline
from tribolab.campaign.config import load_campaign
from tribolab.campaign.pipeline import process
from tribolab.report import results

TEXT = """
[campaign]
name = "steps"
raw = "{raw}"

{surface}

[[run]]
files = "cetr_umt2_MIT/*.csv"
"""
SURFACE = '[[surface]]\nname = "HEA"\n'


def steps_of_an_instrument(shared_data, folder, surface=True):
    text = TEXT.format(raw=shared_data.as_posix(), surface=SURFACE if surface else "")
    file = folder / "campaign.toml"
    file.write_text(text + ('surface = "HEA"\n' if surface else ""), encoding="utf-8")
    return process(load_campaign(file), folder / "new")


@pytest.fixture(scope="module")
def together(shared_data, tmp_path_factory):
    return steps_of_an_instrument(shared_data, tmp_path_factory.mktemp("together"))


def test_repeats_without_a_speed_make_an_empty_curve_and_no_crash(together):
    (curve,) = together.curves
    assert (curve.status, curve.reason, curve.crash) == ("done", "", "")
    findings = []
    results._curves(together, {}, findings)
    assert [row["message"] for row in findings] == [
        "no measured curve: no segment has both a speed and a friction coefficient"
    ]


def test_a_mistake_of_ours_in_a_curve_is_an_error_and_traced_on_demand(
    shared_data, tmp_path, monkeypatch, capsys
):
    def broken(task):
        raise ZeroDivisionError("float division by zero")

    monkeypatch.setattr(pipeline, "process_curve", broken)
    outcome = steps_of_an_instrument(shared_data, tmp_path)
    findings = []
    results._curves(outcome, {}, findings)
    assert [row["severity"] for row in findings] == ["error"]
    assert cli._show(outcome, debug=False) == 3
    assert "Traceback" not in capsys.readouterr().err
    assert cli._show(outcome, debug=True) == 3
    assert "ZeroDivisionError: float division by zero" in capsys.readouterr().err
