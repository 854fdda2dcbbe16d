"""HDF5, netCDF and MAT 7.3 that take their data from another file of the machine."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from hostile.base import TRIBOLAB, Command, case

SECRET = "root:secret of this machine"
Way = Callable[[Any, Path], None]


def secret(folder: Path) -> Path:
    """Write a text that nobody may read, and an HDF5 file next to it; returns the text."""
    import h5py

    path = folder / "elsewhere" / "secret.txt"
    path.parent.mkdir()
    path.write_text(SECRET * 40)
    with h5py.File(path.with_suffix(".h5"), "w") as file:
        file["Fx [N]"] = np.full(100, 7.0)
    return path


def external(file: Any, away: Path) -> None:
    """Store the forces in the text."""
    size = away.stat().st_size // 8
    file.create_dataset("Fx [N]", (size,), "f8", external=[(str(away), 0, 8 * size)])


def external_bytes(file: Any, away: Path) -> None:
    """Store bytes that look like a note in the text."""
    file.create_dataset("notes", (100,), "u1", external=[(str(away), 0, 100)])


def external_in_group(file: Any, away: Path) -> None:
    """Store the forces in the text, two groups down."""
    external(file.create_group("a").create_group("b"), away)


def link(file: Any, away: Path) -> None:
    """Link to the forces of another file."""
    import h5py

    file["Fx [N]"] = h5py.ExternalLink(str(away.with_suffix(".h5")), "/Fx [N]")


def soft_link_through_a_link(file: Any, away: Path) -> None:
    """Link within the file, by way of a link out of it."""
    import h5py

    file["away"] = h5py.ExternalLink(str(away.with_suffix(".h5")), "/")
    file["Fx [N]"] = h5py.SoftLink("/away/Fx [N]")


def virtual(file: Any, away: Path) -> None:
    """Show the forces of another file as a dataset."""
    import h5py

    layout = h5py.VirtualLayout(shape=(100,), dtype="f8")
    layout[:] = h5py.VirtualSource(str(away.with_suffix(".h5")), "Fx [N]", shape=(100,))
    file.create_virtual_dataset("Fx [N]", layout)


def reference(file: Any, away: Path) -> None:
    """Refer to forces in the text, as MATLAB does to fields; no link leads to them."""
    import ctypes

    import h5py

    library = ctypes.CDLL(h5py.h5o.__file__)
    library.H5Oincr_refcount.argtypes = [ctypes.c_int64]
    away_size = away.stat().st_size // 8
    stored = {"external": [(str(away), 0, 8 * away_size)]}
    for name, more in (("time_s", {}), ("Fx_N", stored)):
        hidden = file.create_dataset(None, (away_size, 1), "f8", **more)
        assert library.H5Oincr_refcount(hidden.id.id) >= 0  # else it goes when the file is closed
        field = file.create_dataset(f"run/{name}", (1,), dtype=h5py.ref_dtype)
        field[0] = hidden.ref


def foreign_filter(file: Any, away: Path) -> None:
    """Pack the forces with a filter that HDF5 would load from a plugin."""
    import h5py

    made = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    made.set_chunk((10,))
    made.set_filter(32004, h5py.h5z.FLAG_OPTIONAL, ())
    space = h5py.h5s.create_simple((100,))
    h5py.h5d.create(file.id, b"Fx [N]", h5py.h5t.NATIVE_DOUBLE, space, made)


WAYS: list[Way] = [
    *(external, external_bytes, external_in_group, link, soft_link_through_a_link, virtual),
]


def write(path: Path, way: Way, away: Path, user_block: int = 512) -> None:
    """Write a file of the kind that its ending says, with data from elsewhere."""
    import h5py

    is_mat = path.suffix == ".mat"
    with h5py.File(path, "w", userblock_size=user_block if is_mat else 0) as file:
        file["Time [s]"] = np.arange(100) / 10
        way(file, away)
    if is_mat:
        with path.open("r+b") as raw:
            raw.write(b"MATLAB 7.3 MAT-file".ljust(124) + b"\x00\x02IM")


for _way in (*WAYS, foreign_filter, reference):
    for _ending in ("h5", "nc", "mat"):
        for _command in ("info", "check", "run"):

            @case(
                f"outside 1: {_command}, {_way.__name__}, {_ending}",
                *(_command, _way, _ending),
                says="from outside a file|not part of the HDF5 library",
                never=f"{SECRET}|7.0 N",
            )
            def _(folder: Path, command: str, way: Way, ending: str) -> Command:
                write(folder / f"a.{ending}", way, secret(folder))
                return [*TRIBOLAB, command, f"a.{ending}"]
