"""Results appear whole or not at all, whatever happens to the process."""

import contextlib
import errno
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
import xarray as xr

from tribolab.campaign.store import staging
from tribolab.campaign.store.data_files import link, write_data
from tribolab.campaign.store.ledger import MARKER, Ledger
from tribolab.campaign.store.staging import staged
from tribolab.core.errors import ConfigError, OutputError
from tribolab.reading.netcdf.fresh import is_fresh


def write(output, text):
    with staged(output) as folder:
        (folder / "answer.txt").write_text(text)


def beside(output):
    return sorted(path.name for path in output.parent.iterdir() if path != output)


def test_the_new_replaces_the_old_as_a_whole(tmp_path):
    output = tmp_path / "deep" / "results"
    write(output, "old")
    write(output, "new")
    assert sorted(p.name for p in output.iterdir()) == [MARKER, "answer.txt"]
    assert (output / "answer.txt").read_text() == "new"
    assert beside(output) == []


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, SystemExit])
def test_an_error_leaves_the_old_and_nothing_else(tmp_path, error):
    output = tmp_path / "results"
    write(output, "old")
    with pytest.raises(error), staged(output) as folder:
        (folder / "answer.txt").write_text("half")
        raise error
    assert (output / "answer.txt").read_text() == "old"
    assert beside(output) == []


def test_without_an_exchange_of_folders_two_renames_do(tmp_path, monkeypatch):
    monkeypatch.setattr(staging, "exchange", lambda one, other: False)
    output = tmp_path / "results"
    write(output, "old")
    write(output, "new")
    assert (output / "answer.txt").read_text() == "new"
    assert beside(output) == []


KILLED = """
import os, signal
from pathlib import Path
from tribolab.campaign.store import staging

output, moment = Path({output!r}), {moment!r}
die = lambda *_, **__: os.kill(os.getpid(), signal.SIGKILL)
if moment in ("between", "exchanged"):
    exchange = staging.exchange
    staging.exchange = lambda one, other: moment == "exchanged" and exchange(one, other)
rename = Path.rename
def dying_rename(self, target):
    result = rename(self, target)
    if moment == "between" and self == output:
        die()
    return result
Path.rename = dying_rename
staging.shutil.rmtree = die if moment == "exchanged" else staging.shutil.rmtree
with staging.staged(output) as folder:
    (folder / "answer.txt").write_text("new")
    if moment == "writing":
        die()
"""


@pytest.mark.parametrize(
    ("moment", "seen", "mended"),
    [("writing", "old", "old"), ("between", None, "new"), ("exchanged", "new", "new")],
)
def test_a_kill_leaves_old_or_new_and_the_next_run_tidies_up(tmp_path, moment, seen, mended):
    output = tmp_path / "results"
    write(output, "old")
    code = KILLED.format(output=str(output), moment=moment)
    done = subprocess.run([sys.executable, "-c", code], check=False)
    assert done.returncode == -signal.SIGKILL
    assert beside(output) != []
    if seen:
        assert (output / "answer.txt").read_text() == seen
    with contextlib.suppress(RuntimeError), staged(output):
        assert (output / "answer.txt").read_text() == mended
        raise RuntimeError
    assert (output / "answer.txt").read_text() == mended
    assert beside(output) == []


def test_the_room_of_a_living_process_is_left_alone(tmp_path):
    output = tmp_path / "results"
    with staged(output) as first:
        (first / "answer.txt").write_text("first")
        write(output, "second")  # another process, say, that is quicker
        assert (first / "answer.txt").is_file()
    assert (output / "answer.txt").read_text() == "first"
    assert beside(output) == []


def test_a_folder_with_something_else_in_it_is_never_replaced(tmp_path):
    (tmp_path / "thesis.tex").write_text("three years of work")
    with pytest.raises(ConfigError, match=r"thesis.tex.*--output"):
        write(tmp_path, "new")
    with pytest.raises(ConfigError, match="is a file"):
        write(tmp_path / "thesis.tex", "new")
    assert (tmp_path / "thesis.tex").read_text() == "three years of work"


def test_what_somebody_put_into_the_results_survives_every_rerun(tmp_path):
    output = tmp_path / "results"
    write(output, "first")
    (output / "notes").mkdir()
    (output / "notes" / "what I saw.md").write_text("squeal at 1 mm/s")
    (output / "empty").mkdir()
    (output / "there").symlink_to("nowhere")
    for text in ("second", "third"):
        write(output, text)
        assert (output / "answer.txt").read_text() == text
        assert (output / "notes" / "what I saw.md").read_text() == "squeal at 1 mm/s"
        assert (output / "empty").is_dir()
        assert (output / "there").is_symlink()
    assert Ledger.read(output).foreign() == ["empty", "notes/what I saw.md", "there"]
    assert beside(output) == []


def test_a_folder_that_we_left_empty_is_ours_and_goes_with_the_next_run(tmp_path):
    output = tmp_path / "results"
    with staged(output) as folder:
        (folder / "report.json").write_text("everything failed")
        (folder / "figures" / "traces").mkdir(parents=True)
        (folder / "data").mkdir()
    assert Ledger.read(output).foreign() == []
    (output / "theirs").mkdir()
    assert Ledger.read(output).foreign() == ["theirs"]
    write(output, "second")
    assert sorted(p.name for p in output.iterdir()) == [MARKER, "answer.txt", "theirs"]


def test_a_file_of_ours_that_somebody_changed_is_kept_under_another_name(tmp_path):
    output = tmp_path / "results"
    with staged(output) as folder:
        (folder / "answer.txt").write_text("first")
        (folder / "table.csv").write_text("1")
    (output / "answer.txt").write_text("mine now, and longer")
    with staged(output) as folder:
        (folder / "answer.txt").write_text("second")
        (folder / "table.csv").write_text("2")
    [other] = Ledger.read(output).foreign()
    assert other.startswith("answer.changed-")
    assert (output / other).read_text() == "mine now, and longer"
    assert (output / "answer.txt").read_text() == "second"
    write(output, "third")
    assert Ledger.read(output).foreign() == [other]


def test_a_folder_of_theirs_with_the_name_of_a_file_of_ours_is_kept(tmp_path):
    output = tmp_path / "results"
    with staged(output) as folder:
        (folder / "other.txt").write_text("first")
    (output / "answer.txt").mkdir()
    (output / "answer.txt" / "mine.txt").write_text("mine")
    write(output, "second")
    assert (output / "answer.txt").read_text() == "second"
    assert (output / "answer.txt_mine.txt").read_text() == "mine"


def test_a_copied_marker_makes_nothing_ours(tmp_path):
    output, thesis = tmp_path / "results", tmp_path / "thesis"
    write(output, "new")
    thesis.mkdir()
    (thesis / "thesis.tex").write_text("three years of work")
    shutil.copy2(output / MARKER, thesis)
    with pytest.raises(ConfigError, match=r"thesis.tex"):
        write(thesis, "new")
    (thesis / "answer.txt").write_text("42")  # another file of a name that is listed
    with pytest.raises(ConfigError, match=r"thesis.tex"):
        write(thesis, "new")


def test_results_that_were_copied_are_still_ours(tmp_path):
    write(tmp_path / "results", "old")
    shutil.copytree(tmp_path / "results", tmp_path / "copy", copy_function=shutil.copyfile)
    write(tmp_path / "copy", "new")
    assert (tmp_path / "copy" / "answer.txt").read_text() == "new"
    assert Ledger.read(tmp_path / "copy").foreign() == []


@pytest.mark.parametrize("name", ["a[1]", "b*", "c?d", "..e", "[!x]"])
def test_brackets_and_stars_in_the_name_are_no_wildcards(tmp_path, name):
    output, other = tmp_path / name, tmp_path / "a1"
    write(output, "old")
    write(other, "other")
    code = KILLED.format(output=str(output), moment="writing")
    subprocess.run([sys.executable, "-c", code], check=False)
    assert len(beside(output)) > 1
    write(output, "new")
    assert (output / "answer.txt").read_text() == "new"
    assert beside(output) == ["a1"]


INSIDE = """
import os, signal
from pathlib import Path
from tribolab.campaign.store import staging

staging.os.path.ismount = lambda path: True
output, moment = Path({output!r}), {moment!r}
die = lambda *_, **__: os.kill(os.getpid(), signal.SIGKILL)
rename, count = Path.rename, 0
def dying_rename(self, target):
    global count
    if count == moment:
        die()
    count += 1
    return rename(self, target)
Path.rename = dying_rename
with staging.staged(output) as folder:
    (folder / "answer.txt").write_text("new")
    (folder / "more").mkdir()
    (folder / "more" / "text.txt").write_text("new")
"""


@pytest.mark.parametrize("moment", [*range(6), 99])
def test_a_folder_that_cannot_be_renamed_is_swapped_inside(tmp_path, moment, monkeypatch):
    output = tmp_path / "results"
    write(output, "old")
    (output / "notes.md").write_text("mine")
    code = INSIDE.format(output=str(output), moment=moment)
    done = subprocess.run([sys.executable, "-c", code], check=False)
    assert done.returncode == (0 if moment == 99 else -signal.SIGKILL)
    staging.recover(output)
    assert (output / "answer.txt").read_text() == "new"
    assert (output / "more" / "text.txt").read_text() == "new"
    assert (output / "notes.md").read_text() == "mine"
    assert sorted(p.name for p in output.iterdir()) == [MARKER, "answer.txt", "more", "notes.md"]
    assert beside(output) == []


def test_a_mount_point_takes_results(tmp_path):
    if os.geteuid() != 0:
        pytest.skip("only root mounts")
    output = tmp_path / "volume"
    output.mkdir()
    mount = ["mount", "-t", "tmpfs", "tmpfs", str(output)]
    if subprocess.run(mount, check=False, capture_output=True).returncode:
        pytest.skip("no mounts here")
    try:
        write(output, "first")
        write(output, "second")
        assert (output / "answer.txt").read_text() == "second"
        assert sorted(p.name for p in output.iterdir()) == [MARKER, "answer.txt"]
        assert beside(output) == []
    finally:
        subprocess.run(["umount", str(output)], check=True)


def test_a_link_to_itself_is_one_clear_error(tmp_path):
    (tmp_path / "loop").symlink_to("loop")
    with pytest.raises((ConfigError, OutputError), match="loop"):
        write(tmp_path / "loop" / "results", "new")


def test_a_name_that_is_too_long_is_one_clear_error(tmp_path):
    with pytest.raises(OutputError, match="too long"):
        write(tmp_path / ("x" * 256), "new")
    assert list(tmp_path.iterdir()) == []


def test_a_link_to_a_folder_stays_a_link(tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "results").symlink_to(tmp_path / "disk")
    write(tmp_path / "results", "new")
    assert (tmp_path / "results").is_symlink()
    assert (tmp_path / "disk" / "answer.txt").read_text() == "new"


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (errno.ENOSPC, "disk is full"),
        (errno.EDQUOT, "quota is used up"),
        (errno.EFBIG, "larger than the file system or a limit"),
        (errno.EROFS, "read-only"),
        (errno.EACCES, "no permission"),
        (errno.EIO, "disk reports an error"),
        (errno.ESTALE, "file server has lost"),
        (errno.EMFILE, "too many files are open"),
        (errno.EADV, "cannot write here"),
    ],
)
def test_a_write_that_fails_is_one_clear_error_and_the_old_stays(tmp_path, number, words):
    output = tmp_path / "results"
    write(output, "old")
    with pytest.raises(OutputError, match=rf"{words}.*untouched"), staged(output):
        raise OSError(number, os.strerror(number), str(output / "answer.txt"))
    assert (output / "answer.txt").read_text() == "old"


_TOO_LARGE = """
import resource, sys
from pathlib import Path
import numpy as np, xarray as xr
from tribolab.campaign.store.data_files import write_data
resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))
signals = xr.Dataset({"force": ("time", np.random.default_rng(1).random(400_000))})
write_data({"run": signals}, Path(sys.argv[1]) / "run.nc")
"""


def test_a_limit_of_the_file_size_is_told_though_hdf5_hides_it(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", _TOO_LARGE, str(tmp_path)], capture_output=True, text=True
    )
    assert "OutputError: run.nc: the file is larger than" in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_an_error_about_another_file_keeps_its_own_words(tmp_path):
    with pytest.raises(PermissionError, match="raw.csv"), staged(tmp_path / "results"):
        raise PermissionError(errno.EACCES, "Permission denied", str(tmp_path / "raw.csv"))


@contextlib.contextmanager
def ordinary_user():
    if os.geteuid() != 0:
        yield
        return
    os.seteuid(65534)
    try:
        yield
    finally:
        os.seteuid(0)


def test_an_unwritable_folder_is_one_clear_error():
    folder = Path(tempfile.mkdtemp())
    try:
        folder.chmod(0o555)
        with ordinary_user(), pytest.raises(OutputError, match="no permission"):
            write(folder / "results", "new")
        assert list(folder.iterdir()) == []
    finally:
        folder.chmod(0o755)
        shutil.rmtree(folder)


def test_only_a_file_that_the_running_command_wrote_is_read_without_isolation(tmp_path):
    earlier, planted = tmp_path / "earlier.nc", tmp_path / "results" / "new" / "data" / "a.nc"
    planted.parent.mkdir(parents=True)
    (tmp_path / "results.lock").touch()  # not locked by anybody
    for file in (earlier, planted):
        write_data({None: xr.Dataset()}, file)
    with staged(tmp_path / "made") as folder:
        (folder / "data").mkdir()
        written, linked, copied = (folder / "data" / f"{n}.nc" for n in ("new", "linked", "copied"))
        write_data({None: xr.Dataset()}, written)
        link(earlier, linked)
        shutil.copy2(earlier, copied)  # as where links are unsupported
        os.utime(copied, (0, 0))
        assert [is_fresh(file) for file in (written, linked, copied)] == [True, False, False]
    assert not is_fresh(tmp_path / "made" / "data" / "new.nc")
    assert not is_fresh(planted)
