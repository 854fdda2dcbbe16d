"""The kinds of files: what was run, how it is written, and what a person knows of it besides."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from layouts.motion import Leg, MachineMotion, carried_out, crank
from layouts.record import MeasuredRecord, Sensors, recorded
from tribolab.core.errors import AnalysisError, nearest
from tribolab.rig.laws import DryLaw

Writer = Callable[[MeasuredRecord, Path], Path]
_RATE = 50.0  # Hz
_LAW = DryLaw(0.35, 0.04)
_UNLOADED = Leg(0.0, 8.0, 0.0)
_LOADED = Leg(0.0, 4.0)


@dataclass(frozen=True)
class LayoutKind:
    """One kind of file.

    Parameters
    ----------
    name, about
        What it is called here, and what it is.
    run
        What is measured.
    write
        Writes the file (and what lies beside it) into a folder.
    typed
        What a person types over the draft: pieces of its TOML and what goes in their place.
    dialect
        What a person writes who knows the instrument, where no draft can be made.
    zero
        Where the zero of the friction force is read, if a person says it.
    """

    name: str
    about: str
    run: Callable[[int], MeasuredRecord]
    write: Writer
    typed: tuple[tuple[str, str], ...] = ()
    dialect: str = ""
    zero: str | None = None


@dataclass(frozen=True)
class WrittenRun:
    """A run in a file of some kind, and its truth."""

    kind: LayoutKind
    path: Path
    record: MeasuredRecord


KINDS: dict[str, LayoutKind] = {}


def add_kind(kind: LayoutKind) -> None:
    """Add a kind of file to those that are known."""
    KINDS[kind.name] = kind


def write_kind(name: str, folder: str | Path, seed: int = 0) -> WrittenRun:
    """Simulate a run, and write it as instruments of one kind do.

    Parameters
    ----------
    name
        Of the kind, see `KINDS`.
    folder
        Where to; made if it is not there.
    seed
        Of the noise.

    Raises
    ------
    AnalysisError
        If there is no such kind.
    """
    if name not in KINDS:
        raise AnalysisError(f"the rig writes no file of kind '{name}'{nearest(name, KINDS)}")
    kind = KINDS[name]
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    # of the same seed, files of two kinds are two runs
    record = kind.run(zlib.crc32(name.encode()) + seed)
    return WrittenRun(kind, kind.write(record, folder), record)


def on_disc(seed: int) -> MeasuredRecord:
    """Slide one way at three speeds, unloaded before and after."""
    speeds = (0.05, 0.1, 0.2)
    legs = [_UNLOADED, _LOADED, *(Leg(v, 15.0) for v in speeds), _LOADED, _UNLOADED]
    return recorded(carried_out(legs, _RATE), _LAW, 10.0, seed=seed)


def there_and_back(seed: int) -> MeasuredRecord:
    """Stroke both ways at three speeds."""
    return recorded(_strokes(), _LAW, 25.0, seed=seed)


def by_crank(seed: int) -> MeasuredRecord:
    """Stroke as a crank does, the load sensor set to zero before."""
    sensors = Sensors(normal_offset=0.0)
    motion = crank(10e-3, 1.0, 30, 200.0)
    return recorded(motion, _LAW, 20.0, seed=seed, sensors=sensors, build_up=5e-5)


def pulled(seed: int) -> MeasuredRecord:
    """Pull a sled of 200 g once at 100 mm/min, its sensor set to zero before."""
    motion = carried_out([_LOADED, Leg(0.1 / 60, 40.0)], _RATE)
    return recorded(motion, _LAW, 0.2 * 9.80665, seed=seed, sensors=Sensors(offset=0.0))


def on_disc_under_load(seed: int) -> MeasuredRecord:
    """Slide one way at three speeds, never unloaded, its load sensor set to zero before."""
    legs = [_LOADED, *(Leg(v, 15.0) for v in (0.05, 0.1, 0.2)), _LOADED]
    sensors = Sensors(normal_offset=0.0)
    return recorded(carried_out(legs, _RATE), _LAW, 10.0, seed=seed, sensors=sensors)


def _strokes() -> MachineMotion:
    legs = [_UNLOADED, _LOADED]
    for speed in (0.5e-3, 1e-3, 2e-3):
        legs += [Leg(speed, 10.0), Leg(0.0, 1.0), Leg(-speed, 10.0), Leg(0.0, 1.0)]
    return carried_out([*legs, _UNLOADED], _RATE)
