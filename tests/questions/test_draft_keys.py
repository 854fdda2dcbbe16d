"""Names, units and settings that files hold under keys of several languages; tables of points."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.segments.find import find_segments
from tribolab.records.runs.notices import notices_of

TIME = np.round(0.05 * np.arange(800), 2)
FRICTION = 4.0 + 0.02 * np.sin(TIME)
SPEED = 2 * np.pi * 0.03  # m/s, of one turn a second at 30 mm


def checked(run):
    np.testing.assert_allclose(run.friction_force, FRICTION, atol=1e-9)
    np.testing.assert_allclose(np.abs(run.sliding_velocity), SPEED, rtol=1e-6)
    np.testing.assert_allclose(run.normal_force, 20.0, rtol=1e-9)


@pytest.mark.parametrize(
    ("name", "unit", "value", "radius", "load"),
    [
        ("namn", "enhet", "värde", "spårradie", "normalkraft"),
        ("naam", "eenheid", "waarde", "spoorstraal", "normaalkracht"),
        ("nombre", "unidad", "valor", "radio de pista", "carga normal"),
        ("name", "einheit", "wert", "Spurradius", "Normalkraft"),
    ],
)
def test_json_says_names_and_units_in_its_own_language(
    tmp_path: Path, name: str, unit: str, value: str, radius: str, load: str
) -> None:
    channels = (("Time", "s", TIME), ("Rotation", "rpm", np.full(800, 60.0)))
    channels += (("Friction force", "N", FRICTION),)
    said = {
        "settings": {radius: {value: 30, unit: "mm"}, load: {value: 20, unit: "N"}},
        "data": [{name: n, unit: u, "data": v.tolist()} for n, u, v in channels],
    }
    (tmp_path / "a.json").write_text(json.dumps(said, ensure_ascii=False), "utf-8")
    checked(tl.read(tmp_path / "a.json"))


@pytest.mark.parametrize("key", ["eenheid", "enhet", "unidad", "单位"])
def test_units_of_datasets_and_columns_stand_under_keys_of_other_languages(
    tmp_path: Path, key: str
) -> None:
    columns = {"tijd": (TIME, "s"), "toerental": (np.full(800, 60.0), "omw/min")}
    columns |= {"wrijvingskracht": (FRICTION, "N"), "normaalkracht": (np.full(800, 20.0), "N")}
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.attrs["spoorstraal_mm"] = 30.0
        for name, (values, unit) in columns.items():
            file[f"meting/{name}"] = values
            file[f"meting/{name}"].attrs[key] = unit
    checked(tl.read(tmp_path / "a.h5"))
    fields = [pa.field(n, pa.float64(), metadata={key: unit}) for n, (_, unit) in columns.items()]
    schema = pa.schema(fields, metadata={"spoorstraal_mm": "30"})
    table = pa.table([values for values, _ in columns.values()], schema=schema)
    pq.write_table(table, tmp_path / "a.parquet")
    checked(tl.read(tmp_path / "a.parquet"))


def points(folder: Path, steps: tuple[float, ...]) -> Path:
    """Write points over the mean speed of two bodies, a table for each step."""
    mean = np.geomspace(3000, 10, 30).round(1)
    mu = 0.04 + 0.06 / (1 + (mean / 200) ** 1.2)
    head = "Ponto;Tempo (s);Velocidade média (mm/s);SRR (%);Carga (N);Força de tração (N)"
    parts, number = [], 0
    for factor in steps:
        rows = []
        for speed, at in zip(mean, mu, strict=True):
            number += 1
            rows.append(f"{number};{15 * number};{speed};50;36.0;{36 * factor * at:.5f}")
        parts.append("\n".join([f"Temperatura (°C);{60 * factor:.0f}", head, *rows]))
    (folder / "curve.csv").write_text("\n\n".join(parts) + "\n", "utf-8")
    return folder / "curve.csv"


@pytest.mark.parametrize(("steps", "told"), [((1.0, 1.3, 1.6), 1), ((1.0, 1.01, 0.99), 0)])
def test_points_over_the_mean_speed_are_results_and_steps_that_differ_are_told(
    tmp_path: Path, steps: tuple[float, ...], told: int
) -> None:
    run = tl.read(points(tmp_path, steps))
    assert run.attrs["rows_are"] == "points"
    segments = find_segments(run)
    friction = friction_coefficient(run, segments)
    assert friction.sizes["segment"] == 90
    np.testing.assert_allclose(friction.sliding_speed[:3], [1.5, 1.232, 1.0125], rtol=0.01)
    said = [
        n
        for n in notices_of("curve", run, segments, friction)
        if ("differs between steps") in n.message
    ]
    assert [notice.severity for notice in said] == ["suspect"] * told


@pytest.mark.parametrize(
    ("drive", "asked"),
    [
        ("Ensayo alternativo (movimiento senoidal)", False),
        ("Essai alternatif, mouvement sinusoïdal", False),
        ("Ensayo alternativo", True),
    ],
)
def test_words_of_a_sine_tell_how_strokes_are_driven(
    tmp_path: Path, drive: str, asked: bool
) -> None:
    time = 0.004 * np.arange(5000)
    force = 3 * np.tanh(30 * np.cos(4 * np.pi * time))
    rows = "\n".join(f"{t:.3f};{f:.4f}" for t, f in zip(time, force, strict=True))
    head = f"{drive}\nCarrera;12,0 mm\nFrecuencia;2,0 Hz\nCarga normal;15 N\n"
    file = tmp_path / "pin.csv"
    file.write_text(f"{head}Time [s];Friction force [N]\n{rows}\n", "utf-8")
    if asked:
        with pytest.raises(ReadError, match="a crank drives it"):
            tl.read(file)
        return
    run = tl.read(file)
    assert float(run.sliding_velocity.max()) == pytest.approx(np.pi * 2 * 12e-3, rel=1e-3)


@pytest.mark.parametrize("key", ["Ingestelde normaalkracht", "Normaalkracht ingesteld"])
def test_a_load_that_was_set_is_kept_beside_the_measured_one(tmp_path: Path, key: str) -> None:
    rows = "\n".join(
        f"{t:.2f};{f:.4f};20.{n % 3}" for n, (t, f) in enumerate(zip(TIME, FRICTION, strict=True))
    )
    head = f"{key}: 20,0 N\nGlijsnelheid: 20 mm/s\nTime [s];Friction force [N];Normal force [N]"
    (tmp_path / "a.csv").write_text(f"{head}\n{rows}\n", "utf-8")
    run = tl.read(tmp_path / "a.csv")
    assert run.attrs["set_normal_force_N"] == 20.0
    assert float(run.normal_force.mean()) == pytest.approx(20.1, abs=0.01)


def test_the_pull_on_a_sled_is_its_friction_in_italian(tmp_path: Path) -> None:
    rows = "\n".join(f"{t:.2f},{10 * t:.3f},{f:.4f}" for t, f in zip(TIME, FRICTION, strict=True))
    head = "forza_normale_N: 20\ntempo_s,spostamento_mm,forza_tiro_N"
    (tmp_path / "sled.csv").write_text(f"{head}\n{rows}\n", "utf-8")
    run = tl.read(tmp_path / "sled.csv")
    np.testing.assert_allclose(run.friction_force, FRICTION, atol=1e-4)


@pytest.mark.parametrize("force", ["24,5", "30,0"])
def test_of_a_weight_and_a_force_nobody_knows_which_is_the_load(tmp_path: Path, force: str) -> None:
    rows = "\n".join(f"{t:.2f};{f:.4f}" for t, f in zip(TIME, FRICTION, strict=True))
    head = f"Massa slede (kg);2,50\nNormaalkracht (N);{force}\nGlijsnelheid;20 mm/s"
    (tmp_path / "sled.csv").write_text(f"{head}\nTime [s];Friction force [N]\n{rows}\n", "utf-8")
    assert "normal_force" not in tl.read(tmp_path / "sled.csv")
