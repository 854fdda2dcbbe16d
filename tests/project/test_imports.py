"""Importing tribolab is cheap, and old import paths lead to where a module is now."""

import importlib
import subprocess
import sys

import pytest

import tribolab
from tribolab.core.moved import MOVED


def test_every_public_name_resolves():
    for name in tribolab.__all__:
        face = getattr(tribolab, name)
        for inner in getattr(face, "__all__", []):
            assert getattr(face, inner) is not None


def test_a_name_that_left_the_top_level_says_where_it_is():
    assert "adhesion" not in dir(tribolab)
    with pytest.warns(FutureWarning, match=r"tl\.adhesion is now tl\.contact\.adhesion") as said:
        assert tribolab.adhesion is tribolab.contact.adhesion
    assert [warning.filename for warning in said] == [__file__]
    former = "adhesion read_modulus FitSettings psd_1d Decision objections load_campaign pack"
    for name in former.split():
        with pytest.warns(FutureWarning, match=rf"tl\.{name} is now tl\."):
            assert getattr(tribolab, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'adhesions'"):
        _ = tribolab.adhesions


def test_the_path_of_a_module_that_has_moved_leads_to_it_with_a_warning():
    code = (
        "from tribolab.across.compare import compare as old; "
        "import tribolab as tl; assert old is tl.compare"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "tribolab.across.compare is now tribolab.comparison.comparison" in done.stderr
    for path in MOVED.values():
        importlib.import_module(path)


@pytest.mark.parametrize(
    "head",
    [
        "# Linear slider, force log\nTime [s],Fx [N],Fz [N]",
        "Slider of ours\nZeit [s],Reibkraft [mN],Normalkraft [N]",
    ],
)
def test_a_run_of_one_file_is_told_without_what_takes_long_to_load(tmp_path, head):
    """Known or drafted: pandas, xarray and pint each take longer than 5 MB of numbers to read."""
    file = tmp_path / "log.csv"
    rows = "".join(f"{n / 100:.2f},{1 + n % 3},5\n" for n in range(300))
    file.write_text(f"{head}\n{rows}")
    code = (
        "import sys\nfrom tribolab.cli import main\n"
        f"sys.argv = ['tribolab', 'info', {str(file)!r}]\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "print(sorted({'pandas', 'xarray', 'pint', 'scipy', 'netCDF4'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "300 rows over 2.99 s" in done.stdout, done.stdout
    assert done.stdout.splitlines()[-1] == "[]"
