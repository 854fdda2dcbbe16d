"""Report which kinds of files are read directly, after questions or not, and their accuracy.

    python tests/robustness/file_kinds.py --seeds 100:103 --write docs/file_kinds.md

Over the rig's files in all its layouts (`layouts`), whose truth is known; over
measured files with independent reference numbers; and over sample files of a public package. An
error is a coefficient more than 3 standard errors from the truth (in a
run of several numbers: beyond the bound that is passed by chance as rarely), a speed 1 % off, a
segment that is missing, a file that is not read. The exit code is 1 then.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from file_kinds import AT_ONCE, DESCRIBED, DRAFTED, NOT, judge, read_in_some_way  # noqa: E402
from layouts import KINDS, write_kind  # noqa: E402

import tribolab as tl  # noqa: E402
from tribolab.core.errors import TribolabError  # noqa: E402

SHARED = Path(__file__).parents[3] / "shared" / "data"
WAYS = (AT_ONCE, DRAFTED, DESCRIBED, NOT)
READERS = """
## Layouts that need a Python reader

No published file and no manufacturer's documentation shows these layouts. tribolab asks about such
files or refuses them. To read them, write a reader in Python, put it next to the campaign file, and
name it there (`instrument = "my_reader.py"`). Run the campaign with `--trust`.

| layout | reader |
|---|---|
| each number after its name (`t:1.5 F:2.0`) | the example below |
| one JSON record per line | `pd.read_json(path, lines=True)` |
| a map with positions along two sides | `pd.read_csv(path, index_col=0)` (index: y) |
| a map as one column of heights | `np.loadtxt(path, skiprows=n).reshape(rows, columns)` |
| heights in arrays with a separate mask, mesh or scale | `np.load`, `h5py`; apply mask and scale |
| column names listed in lines above the numbers | `pd.read_csv(path, skiprows=n, names=names)` |
| abbreviations explained above; names in two rows | `pd.read_csv`, as above |
| steps or specimens side by side | `pd.read_csv`, then `pd.concat` of the parts |
| one channel per row (time, name, number) | `pd.read_csv(path).pivot(index=, columns=, values=)` |
| one signal per row | `pd.read_csv(path, header=None, index_col=0).T` |
| columns with separate clocks | `np.interp` to the clock of the friction force |
| fixed-width columns without blanks between them | `pd.read_fwf(path, widths=widths)` |
| one column wrapped over several lines | `np.fromstring(text, sep=" ")` |
| calibration in a sentence (except `Gain Fx: 10 N/V`) | multiply by the calibration factor |
| two load cells whose sum is the load | add the columns |
| a table of step speeds in the header | a column with the speed of each step |
| sheets or groups as steps of one run | `pd.concat(pd.read_excel(path, sheet_name=None))` |
| text between the rows of one table | `pd.read_csv(path, comment="#")` |
| distance sensor readings over time | heights and `speed * time` as `height` and `x` |

```python
import re
import xarray as xr


def can_read(head):
    return "yes" if re.match(rb"t:[\\d.]+ F:", head) else "no"


def read(path):
    rows = re.findall(r"t:(\\S+) F:(\\S+) N:(\\S+) v:(\\S+)", path.read_text())
    t, ft, fn, v = zip(*((float(x) for x in row) for row in rows))
    units = {"friction_force": (ft, "N"), "normal_force": (fn, "N")}
    units["sliding_velocity"] = v, "mm/s"
    signals = {name: ("time", x, {"units": unit}) for name, (x, unit) in units.items()}
    return xr.Dataset(signals, {"time": ("time", list(t), {"units": "ms"})})
```
"""


class Line(NamedTuple):
    """A row of the table; `wrong` says why the verdict is so."""

    kind: str
    about: str
    way: str
    numbers: str
    wrong: str = ""


def of_rig(name: str, seeds: range) -> Line:
    """Judge the rig's files of one kind."""
    kind = KINDS[name]
    ways, wrong, off, error, beyond, count = set(), [], [0.0], [0.0], 0, 0
    for seed in seeds:
        with tempfile.TemporaryDirectory() as folder:
            written = write_kind(name, folder, seed)
            read = read_in_some_way(written, Path(folder))
            ways.add(read.way)
            if read.run is None:
                wrong.append(f"seed {seed}: {read.why}")
                continue
            judged = judge(written, read.run)
        wrong += [f"seed {seed}: {fault}" for fault in judged.faults]
        off += judged.off.tolist()
        error += (judged.sem / judged.truth).tolist()
        beyond += int((judged.off > 3).sum())
        count += judged.mu.size
    numbers = f"{count} right, at most {max(off):.1f} standard errors off; error {max(error):.2%}"
    if beyond:
        numbers += f"; {beyond} beyond 3"
    return Line(name, kind.about, max(ways, key=WAYS.index), numbers, "; ".join(wrong))


def _pull_and_push(run: object) -> float:
    segments = tl.find_segments(run, trim=0.1)
    friction = tl.friction_coefficient(run, segments)
    return float(np.nanmedian(np.abs(friction["half_loop"].values)))


def _mean(run: object) -> float:
    return float(run["friction_coefficient"].values.mean())


def _last(run: object) -> float:
    friction = tl.friction_coefficient(run, tl.find_segments(run))
    return float(friction["friction_coefficient"].values[-1])


class Measured(NamedTuple):
    """A measured file, its number by somebody else, and what of the reading is compared with it."""

    path: str
    about: str
    reference: float | None = None
    tolerance: float = 0.0
    number: Callable[[object], float] = _mean


_PAPER = "stickslip_paper_CeCILL-B"
MEASURED = (
    Measured(
        "actuator_friction_CC0/Circle_1bar.csv",
        "no header, tabs; half loop 5.631 N",
        5.631,
        0.01,
        _pull_and_push,
    ),
    Measured(
        "actuator_friction_CC0/O-ring257_1bar.csv",
        "the same; half loop 7.002 N",
        7.002,
        0.01,
        _pull_and_push,
    ),
    Measured(
        "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt",
        "velocity step in rock; mu 0.60796",
        0.60796,
        0.002,
        _last,
    ),
    Measured(f"{_PAPER}/k168Nm_v1100.mat", "MAT 5; mu 0.33409", 0.33409, 1e-4),
    Measured(f"{_PAPER}/k1002Nm_v4300.mat", "MAT 5; mu 0.2918", 0.2918, 3e-4),
    Measured("cetr_umt2_MIT/*_001.csv", "settings, header at each step, gram-force"),
    Measured("pcs_mtm_ehd_MIT/demo_5.txt", "duplicate names, steps, restarting clock"),
    Measured("tdms_force_MIT/TDMSSample.tdms", "TDMS groups"),
)


def of_measured(one: Measured) -> Line:
    """Read a measured file, and compare its number."""
    [path] = SHARED.glob(one.path)
    name = path.parent.name.rsplit("_", 1)[0]
    try:
        run = tl.read(path)
    except TribolabError as error:
        return Line(name, one.about, NOT, "", str(error))
    if one.reference is None:
        signals = sum(1 for signal in run.data_vars if run[signal].dtype.kind == "f")
        return Line(name, one.about, AT_ONCE, f"{signals} signals; no reference")
    value = one.number(run)
    off = value / one.reference - 1
    wrong = "" if abs(off) <= one.tolerance else f"{value:.5g} for {one.reference:.5g}"
    return Line(name, one.about, AT_ONCE, f"{100 * off:+.2f} % of the reference", wrong)


def of_package() -> list[Line]:
    """Read the sample files that ship with nptdms: none of them is of a friction experiment."""
    import nptdms

    lines = []
    for path in sorted((Path(nptdms.__file__).parent / "test" / "data").glob("*.tdms")):
        try:
            tl.read(path)
            lines.append(Line("nptdms", path.name, AT_ONCE, "", "it holds no friction"))
        except TribolabError as error:
            told = "no known instrument" in str(error)
            lines.append(Line("nptdms", path.name, NOT, "no run", "" if told else str(error)))
    return lines


def table(lines: list[Line]) -> str:
    """Return the lines as a table in Markdown."""
    rows = ["| kind | peculiarity | read | friction coefficient |", "|---|---|---|---|"]
    rows += [f"| {x.kind} | {x.about} | {x.way} | {x.wrong or x.numbers} |" for x in lines]
    return "\n".join(rows) + "\n"


def page(rig: list[Line], others: list[Line], seeds: range) -> str:
    """Return the page for the docs."""
    counts = {way: sum(line.way == way for line in rig) for way in WAYS}
    told = ", ".join(f"{count} {way}" for way, count in counts.items() if count)
    return f"""# Which files are read

Generated by `tests/robustness/file_kinds.py --write docs/file_kinds.md`; do not edit.

*Directly*: `tl.read(file)` needs no further information. *After questions*: we answered the
questions of `tribolab info --write`. *With a dialect*: we wrote a dialect by hand, because the file
does not state what its columns are or how they are scaled.

## Simulated files with known results

{len(rig)} kinds, {len(seeds)} runs of each: {told}. A
coefficient is *right* if it differs from the true value by at most 3 standard errors. For a run
with several coefficients, the bound is wider, so that the chance of exceeding it is the same.
*Error* is the largest relative standard error.

{table(rig)}
## Measured files, and sample files of a package

References were computed independently. Files without friction are refused.

{table(others)}{READERS}"""


def main() -> int:
    """Print the tables; the exit code says whether all is right."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", default="100:103", help="FIRST:LAST+1")
    parser.add_argument("--kinds", default="", help="names, separated by commas")
    parser.add_argument("--write", type=Path, help="the page to write")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    seeds = range(*map(int, options.seeds.split(":")))
    names = list(filter(None, options.kinds.split(","))) or list(KINDS)
    rig = [of_rig(name, seeds) for name in names]
    others = [] if options.kinds else [*map(of_measured, MEASURED), *of_package()]
    print(table(rig), table(others), sep="\n")
    wrong = [line for line in (*rig, *others) if line.wrong]
    if options.write and not options.kinds:
        options.write.write_text(page(rig, others, seeds), encoding="utf-8")
    print(f"{len(wrong)} of {len(rig) + len(others)} kinds are wrong" if wrong else "all are right")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
