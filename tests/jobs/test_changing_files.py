"""The checksum of a result is that of the bytes it was made from."""

import hashlib
import os
import threading

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.raw import limits, source
from tribolab.reading.runs import gather

HEAD = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n"
LONG_AGO = 10 * limits.AT_REST.value


def rows(first: int, last: int, force: float = 1.0) -> str:
    return "".join(f"{n / 100:.2f},{force},31.0\n" for n in range(first, last))


@pytest.fixture
def run(tmp_path):
    path = tmp_path / "run.csv"
    path.write_text(HEAD + rows(0, 500))
    return path


def changed_while_read(monkeypatch, change, times):
    """Have a file changed after its content was read and before the reading is over."""
    whole, left = gather.read_content, [times]

    def read_content(path, *rest):
        content = whole(path, *rest)
        left[0] -= 1
        if left[0] >= 0:
            change(path)
        return content

    monkeypatch.setattr(gather, "read_content", read_content)


def append(path):
    start = path.read_text().count("\n")
    with path.open("a") as file:
        file.write(rows(start, start + 100))


def in_place(path):
    """Other numbers, as many bytes, and the same time of writing: a copy that keeps times."""
    state = path.stat()
    force = path.read_text().splitlines()[-1].split(",")[1]
    path.write_text(HEAD + rows(0, 500, float(force) + 1))
    os.utime(path, ns=(state.st_atime_ns, state.st_mtime_ns))


def replaced(path):
    new = path.with_suffix(".new")
    new.write_text(path.read_text().replace("31.0", "32.0"))
    new.replace(path)


@pytest.mark.parametrize("change", [append, in_place, replaced], ids=lambda f: f.__name__)
@pytest.mark.parametrize("old", [False, True], ids=["recent", "old"])
def test_a_file_that_changes_once_is_read_again(change, old, run, monkeypatch):
    if old:
        then = run.stat().st_mtime - LONG_AGO
        os.utime(run, (then, then))
    changed_while_read(monkeypatch, change, 1)
    data = tl.read(run)
    assert data.attrs["source_sha256"] == hashlib.sha256(run.read_bytes()).hexdigest()
    force, load = np.loadtxt(run, delimiter=",", skiprows=2, usecols=(1, 2), unpack=True)
    assert np.array_equal(data.friction_force, force) and np.array_equal(data.normal_force, load)


def test_a_change_that_size_and_times_do_not_show_is_seen_by_the_checksum(run, monkeypatch):
    """File systems note times coarsely, networks late."""
    whole, before = source.Path.stat, run.stat()

    def stat(path, **how):
        return before if path == run else whole(path, **how)

    monkeypatch.setattr(source.Path, "stat", stat)
    changed_while_read(monkeypatch, in_place, 1)
    data = tl.read(run)
    assert data.attrs["source_sha256"] == hashlib.sha256(run.read_bytes()).hexdigest()
    assert (data.friction_force == 2.0).all()


@pytest.mark.parametrize("change", [append, in_place, replaced], ids=lambda f: f.__name__)
def test_a_file_that_changes_each_time_is_refused_by_name(change, run, monkeypatch):
    changed_while_read(monkeypatch, change, 100)
    with pytest.raises(ReadError, match=r"run\.csv: the file changes while it is read \(.*wait"):
        tl.read(run)


def test_a_run_that_is_still_measured_is_refused_or_read_as_it_is_at_the_end(run):
    """Another thread writes rows all the time, as an instrument does."""
    stop = threading.Event()

    def measure():
        number = 500
        with run.open("a", buffering=1) as file:
            while not stop.is_set():
                file.write(rows(number, number + 1))
                number += 1

    instrument = threading.Thread(target=measure)
    instrument.start()
    try:
        with pytest.raises(ReadError, match="changes while it is read"):
            tl.read(run)
    finally:
        stop.set()
        instrument.join()
    data = tl.read(run)
    assert data.attrs["source_sha256"] == hashlib.sha256(run.read_bytes()).hexdigest()
    assert data.sizes["time"] == run.read_text().count("\n") - 2


def test_a_scan_and_a_modulus_are_watched_too(tmp_path, monkeypatch):
    from tribolab.reading import modulus_tables
    from tribolab.reading.scans import read_scan as scans

    profile, table = tmp_path / "line.txt", tmp_path / "pdms.csv"
    profile.write_text("Point spacing: 0.25 um\nZ [um]\n" + "1.0\n1.5\n1.25\n" * 20)
    table.write_text("f,E_stor,E_loss\nHz,MPa,MPa\n0.1,1.5,0.1\n10,1.8,0.3\n")

    def spoil(module, name):
        whole = getattr(module, name)

        def read(path, *rest):
            with path.open("ab") as file:
                file.write(b" ")
            return whole(path, *rest)

        monkeypatch.setattr(module, name, read)

    spoil(scans, "read_content")
    spoil(modulus_tables, "_text")
    for reader, path in ((tl.read_scans, profile), (tl.rubber.read_modulus, table)):
        with pytest.raises(ReadError, match=rf"{path.name}: the file changes while it is read"):
            reader(path)
