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

from tribolab.campaign import staging
from tribolab.campaign.staging import MARKER, staged
from tribolab.errors import ConfigError, OutputError


def write(output, text):
    with staged(output) as folder:
        (folder / "answer.txt").write_text(text)


def beside(output):
    return sorted(path.name for path in output.parent.iterdir() if path != output)


def test_the_new_replaces_the_old_as_a_whole(tmp_path):
    output = tmp_path / "deep" / "results"
    write(output, "old")
    (output / "left_over.txt").write_text("of the old")
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
from tribolab.campaign import staging

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


def test_a_link_to_a_folder_stays_a_link(tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "results").symlink_to(tmp_path / "disk")
    write(tmp_path / "results", "new")
    assert (tmp_path / "results").is_symlink()
    assert (tmp_path / "disk" / "answer.txt").read_text() == "new"


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_a_full_disk_is_one_clear_error_and_the_old_stays(tmp_path, number):
    output = tmp_path / "results"
    write(output, "old")
    with pytest.raises(OutputError, match=r"(full|used up).*untouched"), staged(output):
        raise OSError(number, os.strerror(number))
    assert (output / "answer.txt").read_text() == "old"


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
