"""Files as other labs may write them, drawn by lot, with what they were made from.

Languages, units, layouts, what is in the header and what stands beside the signals are drawn; the
friction coefficient and the speeds behind them are known.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.signal import lfilter

NAMES = {
    "en": {
        "time": "Time|Elapsed time|t|TIME",
        "force": "Friction force|Tangential force|Fx|Ff|Friction",
        "load": "Normal force|Normal load|Load|Fz",
        "way": "Position|Displacement|x|Sliding distance",
        "speed": "Speed|Velocity|Sliding speed|v",
        "turns": "Rotation speed|Spindle speed|RPM",
        "torque": "Torque|Friction torque",
        "coefficient": "COF|Friction coefficient|mu|µ",
    },
    "de": {
        "time": "Zeit|Versuchszeit",
        "force": "Reibkraft|Reibungskraft",
        "load": "Normalkraft|Anpresskraft|Auflast",
        "way": "Weg|Position|Verschiebung",
        "speed": "Geschwindigkeit|Gleitgeschwindigkeit",
        "turns": "Drehzahl",
        "torque": "Drehmoment|Reibmoment",
        "coefficient": "Reibwert|Reibungszahl",
    },
    "fr": {
        "time": "Temps",
        "force": "Force de frottement|Force tangentielle",
        "load": "Force normale|Charge normale",
        "way": "Déplacement|Position",
        "speed": "Vitesse|Vitesse de glissement",
        "turns": "Vitesse de rotation",
        "torque": "Couple",
        "coefficient": "Coefficient de frottement",
    },
    "es": {
        "time": "Tiempo",
        "force": "Fuerza de fricción|Fuerza tangencial",
        "load": "Fuerza normal|Carga",
        "way": "Posición|Desplazamiento",
        "speed": "Velocidad",
        "turns": "Velocidad de giro",
        "torque": "Par",
        "coefficient": "Coeficiente de fricción",
    },
    "zh": {
        "time": "时间",
        "force": "摩擦力",
        "load": "载荷|法向力",
        "way": "位移|位置",
        "speed": "速度|滑动速度",
        "turns": "转速",
        "torque": "扭矩",
        "coefficient": "摩擦系数",
    },
}
UNITS = {
    "time": {"s": 1, "ms": 1e3, "min": 1 / 60},
    "force": {"N": 1, "mN": 1e3, "gf": 1 / 9.80665e-3},
    "load": {"N": 1, "mN": 1e3, "kgf": 1 / 9.80665},
    "way": {"mm": 1e3, "um": 1e6, "cm": 1e2},
    "speed": {"mm/s": 1e3, "um/s": 1e6, "m/s": 1, "mm/min": 6e4},
    "turns": {"rpm": 30 / np.pi, "1/min": 30 / np.pi, "rad/s": 1},
    "torque": {"N mm": 1e3, "Nm": 1, "mNm": 1e3},
    "coefficient": {"": 1, "-": 1, "%": 100},
}
RADII = {"en": "Track radius: {} mm", "de": "Reibradius: {} mm", "fr": "Rayon de la piste : {} mm"}
RADII |= {"es": "Radio de la pista: {} mm", "zh": "轨道半径: {} mm"}
LOADS = {"en": "Normal load: {} N", "de": "Normalkraft: {} N", "fr": "Charge normale : {} N"}
LOADS |= {"es": "Carga normal: {} N", "zh": "载荷: {} N"}
# what says nothing of friction, load and speed
BESIDE = {
    **{"Temperature [°C]": 23.0, "Humidity [%]": 45.0, "Wear depth [um]": 3.0, "Fy [N]": 0.02},
    **{"Set speed [mm/s]": 5.0, "Motor current [A]": 1.2, "Friction (raw) [V]": 1.0, "Lap": 1.0},
    **{"Z position [mm]": 12.0, "Vibration [m/s2]": 0.5, "Channel 7": 0.1, "Cycle": 2.0},
}
ABOVE = (
    "Ball diameter: 6 mm|Specimen radius: 25 mm|Sample thickness: 3 mm|Cell range: 100 N"
    "|Preload: 1 N|Spring constant: 1.2 N/mm|Disc diameter: 60 mm|Max speed: 20 mm/s|Gain: 1"
    "|Test duration: 60 s|Operator: A. Person|Sliding distance: 10 m|Cut-off: 10 Hz"
).split("|")


class Strange(NamedTuple):
    """A file, and the friction coefficients and speeds [m/s] (step) that it was made from."""

    path: Path
    coefficients: np.ndarray
    speeds: np.ndarray


def strange_file(folder: Path, seed: int) -> Strange:
    """Write a file of a disc or a slider, everything about it drawn by lot."""
    rng = np.random.default_rng(seed)
    lot = _Lot(rng)
    language = lot.of(list(NAMES))
    signals, above, coefficients, speeds = (_disc if seed % 2 else _slider)(lot, language)
    above += lot.some(ABOVE, 4)
    rng.shuffle(above)
    separator, decimal = lot.of([("\t", "."), (";", "."), (";", ","), ("|", "."), (",", ".")])
    head, columns = [], []
    names = list(signals)
    rng.shuffle(names)
    for name in names:
        unit, scale = lot.of(list(UNITS[name].items()))
        if name == "time" and "step" in signals:
            unit, scale = "s", 1  # what starts anew in coarse units may seem to stand still
        head.append(lot.labelled(lot.of(NAMES[language][name].split("|")), unit))
        columns.append(scale * signals[name])
    size = columns[0].size
    for label in lot.some(list(BESIDE), 3):
        head.append(label)
        noise = (label not in ("Cycle", "Lap")) * 0.01 * rng.standard_normal(size)
        columns.append(BESIDE[label] * (1 + noise))
    digits = [_digits(column) for column in columns]
    rows = (
        separator.join(f"{cell:.{d}f}" for cell, d in zip(row, digits, strict=True))
        for row in zip(*columns, strict=True)
    )
    text = "\n".join([*above, separator.join(head), *(row.replace(".", decimal) for row in rows)])
    path = folder / f"strange_{seed}.txt"
    path.write_text(text + "\n", encoding="utf-8")
    return Strange(path, np.array(coefficients), np.array(speeds))


class _Lot:
    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng

    def of(self, things):
        return things[int(self.rng.integers(len(things)))]

    def some(self, things, most):
        number = int(self.rng.integers(most))
        return [str(thing) for thing in self.rng.choice(things, number, replace=False)]

    def labelled(self, name: str, unit: str) -> str:
        return self.of([f"{name} [{unit}]", f"{name} ({unit})"]) if unit else name

    def noise(self, size: int) -> np.ndarray:
        return lfilter([1], [1, -0.6], 0.004 * self.rng.standard_normal(size))


def _disc(lot: _Lot, language: str):
    """Three speeds, one after the other."""
    radius, load, rate = lot.of([8e-3, 12.5e-3, 0.02]), lot.of([2.0, 10.0, 50.0]), lot.of([10, 20])
    rpm = sorted(lot.rng.choice([1, 3, 10, 30, 100, 300], 3, replace=False).tolist())
    highest = lot.rng.uniform(0.1, 0.9)
    coefficients = [highest * share for share in (1.0, 0.8, 0.6)]
    time = np.arange(75 * rate) / rate
    step = np.minimum((time // 25).astype(int), 2)
    omega = np.array(rpm)[step] * np.pi / 30
    normal = load * (1 + 0.001 * lot.rng.standard_normal(time.size))
    force = np.array(coefficients)[step] * (1 + lot.noise(time.size)) * normal
    signals = {"time": time, "turns": omega * (1 + 0.001 * lot.rng.standard_normal(time.size))}
    above = [RADII[language].format(f"{1e3 * radius:g}")]
    kind = lot.of(["force", "torque", "coefficient"])
    signals[kind] = {"force": force, "torque": force * radius, "coefficient": force / normal}[kind]
    if lot.rng.random() < 0.6:
        signals["load"] = normal
    else:
        above.append(LOADS[language].format(f"{load:g}"))
    return signals, above, coefficients, [n * np.pi / 30 * radius for n in rpm]


def _slider(lot: _Lot, language: str):
    """Six strokes to and fro, with an offset of the force."""
    speed, load, rate = lot.of([1e-4, 1e-3, 5e-3]), lot.of([2.0, 10.0, 50.0]), lot.of([20, 50])
    coefficient = lot.rng.uniform(0.1, 0.9)
    stroke = np.r_[np.zeros(rate), np.full(10 * rate, speed)]
    velocity = np.r_[np.concatenate([(-1) ** k * stroke for k in range(6)]), np.zeros(rate)]
    time = np.arange(velocity.size) / rate
    normal = load * (1 + 0.001 * lot.rng.standard_normal(time.size))
    force = np.sign(velocity) * coefficient * (1 + lot.noise(time.size)) * normal
    force = force + lot.of([0.0, 0.3]) * coefficient * load
    force = force + 0.001 * load * lot.rng.standard_normal(time.size)
    signals, above = {"time": time, "force": force}, []
    if lot.rng.random() < 0.5:
        signals["way"] = np.cumsum(velocity) / rate
    else:
        signals["speed"] = velocity * (1 + 0.001 * lot.rng.standard_normal(time.size))
    if lot.rng.random() < 0.6:
        signals["load"] = normal
    else:
        above.append(LOADS[language].format(f"{load:g}"))
    return signals, above, [coefficient], [speed]


def _digits(column: np.ndarray) -> int:
    moving = np.abs(column[column != 0])
    return int(np.clip(5 - np.floor(np.log10(np.median(moving))), 0, 9)) if moving.size else 0
