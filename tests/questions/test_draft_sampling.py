"""The sample rate is found above a table without time, in the words and units of laboratories."""

import numpy as np
import pytest

from tribolab.core.errors import TribolabError
from tribolab.reading.unknown.header.sampling import sample_rate_unit
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft
from tribolab.reading.unknown_run import read_run

LINES = (
    "# Cadence d'acquisition : 1000 pts/s",
    "Sampling rate: 1000 S/s",
    "Sample rate [kS/s]\t1",
    "Acquisition rate = 1 kSa/s",
    "Fréquence d'échantillonnage : 1000 échant./s",
    "Taux d'échantillonnage : 1 kHz",
    "Vitesse d'acquisition : 1000 mesures/s",
    "Messfrequenz: 1000 Werte/s",
    "Aufzeichnungsrate: 1000 Hz",
    "Frecuencia de muestreo: 1000 muestras/s",
    "Tasa de adquisición: 1000 Hz",
    "Frequenza di acquisizione: 1000 campioni/s",
    "Taxa de amostragem: 1000 amostras/s",
    "Bemonsteringsfrequentie: 1000 Hz",
    "Częstotliwość próbkowania: 1000 próbek/s",
    "Vzorkovací frekvence: 1 kHz",
    "Частота опроса: 1000 отсч/с",
    "采集频率: 1000 点/秒",
    "サンプリング周波数: 1000 Hz",
    "Data rate: 60000 samples/min",
    "Samples per second: 1000",
    "Logging rate: 1000 1/s",
    "Sampling interval: 1 ms/pt",
    "Pas de temps : 1 ms",
    "Periodo de muestreo: 0,001 s",
)


def a_file(folder, line):
    time = np.arange(1200) / 1000
    place = 5 * abs((time / 0.4) % 2 - 1)
    force = 2 * np.sign(np.gradient(place)) + 0.01 * np.sin(3700 * time)
    rows = zip(place, force, 10 + 0.01 * np.cos(4100 * time), strict=True)
    text = "\n".join(f"{a:.4f}\t{b:.4f}\t{c:.4f}" for a, b, c in rows)
    file = folder / "strokes.txt"
    head = "Position [mm]\tFriction force [N]\tNormal force [N]"
    file.write_text(f"Tribometer\n{line}\n{head}\n{text}\n", encoding="utf-8")
    return file


@pytest.mark.parametrize("line", LINES)
def test_a_sample_rate_is_found_as_laboratories_write_it(line, tmp_path):
    file = a_file(tmp_path, line)
    dialect = save_draft(draft_dialect(file, "own"), tmp_path / "own.toml")
    for run in (read_run(file), read_run(file, dialect)):
        assert np.diff(run.time.values) == pytest.approx(1e-3)


def test_a_comma_that_may_part_thousands_is_asked_about(tmp_path):
    file = a_file(tmp_path, "Sampling rate: 1,000 Hz")
    with pytest.raises(TribolabError, match="parts thousands"):
        read_run(file)
    dialect = save_draft(draft_dialect(file, "own"), tmp_path / "own.toml")
    assert np.diff(read_run(file, dialect).time.values) == pytest.approx(1e-3)


def test_what_is_no_sample_rate_is_none(tmp_path):
    with pytest.raises(TribolabError):  # no time, and none is made up
        read_run(a_file(tmp_path, "Heating rate: 5 K/min"))
    with pytest.raises(TribolabError):
        read_run(a_file(tmp_path, "Frequency: 2 Hz"))
    assert not any(map(sample_rate_unit, ("mm/s", "1/s", "rev/s", "N/s", "S/m", "kg/s")))
