"""Forces that stand in volts beside what a volt is worth: reckoned with what each file says."""

import numpy as np
import pytest

from tribolab.errors import TribolabError
from tribolab.reading.read import read
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft

TIME = np.arange(300) / 10
SPEED = np.repeat([0.0, 1.0, 3.0], 100)  # mm/s
VOLTS = np.where(SPEED > 0, 2.0, 0.0) + 0.01 * np.sin(TIME)  # mV
LOAD = 20 + 0.1 * np.cos(TIME)


def written(folder, head, names, *columns, decimal=".", name="run.csv"):
    rows = "\n".join(";".join(f"{x:.4f}" for x in row) for row in zip(*columns, strict=True))
    path = folder / name
    text = f"{head}\n\n{names}\n{rows}\n".replace(".", decimal)
    path.write_text(text, "utf-8")
    return path


@pytest.mark.parametrize(
    ("said", "newtons"),
    [
        ("Kalibrierfaktor Reibkraft [N/mV];2.350", 2.35),
        ("Friction calibration;2.35 N/mV", 2.35),
        ("Calibration factor = 2350 N/V", 2.35),
        ("Sensitivity (mV/N);0.42", 1 / 0.42),
        ("Sensibilité: 0.42 mV/N", 1 / 0.42),
    ],
)
def test_a_stated_factor_makes_a_force_of_volts_and_another_file_has_its_own(
    tmp_path, said, newtons
):
    names = "Time [s];Sliding speed [mm/s];Friction force bridge [mV];Normal force [N]"
    path = written(tmp_path, said, names, TIME, SPEED, VOLTS, LOAD)
    run = read(path)
    np.testing.assert_allclose(run.friction_force, newtons * np.round(VOLTS, 4), rtol=1e-9)
    assert run.attrs["instrument"] == "drafted from the file"
    kept = save_draft(draft_dialect(path), tmp_path / "own.toml")
    number = next(word for word in ("2350", "2.35", "0.42") if word in said)
    other = said.replace(number, str(2 * float(number)))
    again = read(written(tmp_path, other, names, TIME, SPEED, VOLTS, LOAD, name="b.csv"), kept)
    twice = 2.0 if "/N" not in said else 0.5
    np.testing.assert_allclose(again.friction_force, twice * run.friction_force, rtol=1e-9)


def test_of_two_bridges_each_has_the_factor_that_names_it(tmp_path):
    head = "Faktor Normalkraft [N/V];100\nFaktor Reibkraft [N/mV];2.5"
    names = "Zeit [s];Geschwindigkeit [mm/s];Reibkraft [mV];Normalkraft [V]"
    path = written(tmp_path, head, names, TIME, SPEED, VOLTS, LOAD / 100, decimal=",")
    run = read(path)
    np.testing.assert_allclose(run.friction_force, 2.5 * np.round(VOLTS, 4), rtol=1e-9)
    np.testing.assert_allclose(run.normal_force, 100 * np.round(LOAD / 100, 4), rtol=1e-9)


@pytest.mark.parametrize(
    ("head", "names"),
    [
        ("Station: 4", "Friction force [mV];Normal force [N]"),  # nothing says what a volt is
        ("Factor: 2 N/mV\nFactor after: 3 N/mV", "Friction force [mV];Normal force [N]"),
        ("Load factor: 2 N/mV", "Friction force [mV];Normal force [N]"),
    ],
)
def test_what_is_not_sure_is_asked_for(tmp_path, head, names):
    path = written(
        tmp_path, head, f"Time [s];Sliding speed [mm/s];{names}", TIME, SPEED, VOLTS, LOAD
    )
    with pytest.raises(TribolabError, match=r"friction|Friction"):
        read(path)


@pytest.mark.parametrize(
    ("head", "raw", "newtons", "zero"),
    [
        ("Load: 20 N\n1 N = 4213 sayım", "hx711_ham", 1 / 4213, 0),
        (
            "Belastung: 20 N\nKalibrierung: 4213 Digits = 1 N\nNullpunkt: 84120",
            "Reibkraft_roh",
            1 / 4213,
            84120,
        ),
        (
            "Load [N];20\ncalibration factor: 430.5 counts/g\nTare (counts): 8201",
            "adc_raw",
            9.80665e-3 / 430.5,
            8201,
        ),
        ("Carga: 20 N\nzero: 512 bits\n1 N ≙ 87,5 bits", "valor bruto", 1 / 87.5, 512),
    ],
)
def test_counts_of_a_converter_become_the_friction_force(tmp_path, head, raw, newtons, zero):
    counts = np.round(5.0 * np.where(SPEED > 0, 1, 0) / newtons + np.cos(7 * TIME) + zero)
    rows = zip(TIME, SPEED, counts, strict=True)
    table = "\n".join(f"{t:.1f};{v:.1f};{n:.0f}" for t, v, n in rows)
    path = tmp_path / "run.csv"
    path.write_text(f"{head}\nTime [s];Sliding speed [mm/s];{raw}\n{table}\n", "utf-8")
    run = read(path)
    np.testing.assert_allclose(run.friction_force, newtons * (counts - zero), atol=1e-9)
    np.testing.assert_allclose(run.normal_force, 20)
    if zero:
        assert run.attrs["zeros_stated"] == {"friction_force": "friction_zero"}


@pytest.mark.parametrize(
    ("head", "raw"),
    [
        ("Load: 20 N\n1 N = 0.102 kg", "adc_raw"),  # nothing of counts
        ("Load: 20 N\n1 N = 4213 counts", "marker"),  # not named for a converter
        ("Load: 20 N\n1 N = 4213 counts\n1 N = 400 steps", "adc_raw"),  # which of both?
        ("Load: 20 N\n1 mm = 4213 counts", "adc_raw"),  # no force
    ],
)
def test_whole_numbers_without_a_sure_worth_are_no_force(tmp_path, head, raw):
    counts = np.round(2e4 * np.where(SPEED > 0, 1, 0) + 50 * np.cos(7 * TIME))
    rows = zip(TIME, SPEED, counts, strict=True)
    table = "\n".join(f"{t:.1f};{v:.1f};{n:.0f}" for t, v, n in rows)
    (tmp_path / "run.csv").write_text(f"{head}\nTime [s];Sliding speed [mm/s];{raw}\n{table}\n")
    with pytest.raises(TribolabError, match="friction"):
        read(tmp_path / "run.csv")
