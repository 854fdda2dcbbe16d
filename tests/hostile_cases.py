"""What users do without meaning to: files, names and moments that tribolab has to survive.

A case prepares a folder and returns the command; what the answer has to be stands beside it.
``tests/benchmarks/break_it.py`` runs all of them with limits on time and memory,
``tests/test_hostile.py`` the quick ones.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from campaigns import simulated

TRIBOLAB = [sys.executable, "-m", "tribolab"]
FINE, FOUND, USAGE, UNREADABLE = 0, 1, 2, 3
Command = list[str | bytes]


@dataclass(frozen=True)
class Case:
    """One way to break it.

    Attributes
    ----------
    name, prepare
        What it is called; it fills a folder and returns the command.
    codes
        Exit codes that are right.
    says, never
        Patterns that have to be in the answer, and must not be.
    seconds
        Of computing, its children's included.
    large
        Whether it writes a file of hundreds of megabytes, or takes long.
    settings
        Environment variables.
    after
        Says what is wrong in the folder afterwards; nothing if it is as it should be.
    """

    name: str
    prepare: Callable[[Path], Command]
    codes: tuple[int, ...] = (UNREADABLE,)
    says: str = ""
    never: str = ""
    seconds: float = 5.0
    large: bool = False
    settings: Mapping[str, str] = field(default_factory=dict)
    after: Callable[[Path], str] | None = None


CASES: list[Case] = []


def case(name: str, *args, **options) -> Callable:
    """Register a function of (folder, *args) as a case."""

    def register(function: Callable) -> Callable:
        CASES.append(Case(name, lambda folder: function(folder, *args), **options))
        return function

    return register


def notebook(code: str) -> Command:
    """Lines as in a notebook: an error of ours is told with its exit code, any other crashes."""
    head = "import sys, tribolab as tl\ntry:\n"
    body = "".join(f"    {line}\n" for line in code.splitlines())
    tail = "except tl.TribolabError as error:\n    print(error, file=sys.stderr); sys.exit(3)\n"
    return [sys.executable, "-W", "error::RuntimeWarning", "-c", head + body + tail]


ROWS = "".join(f"{0.1 * n:.1f},{0.5 + n % 3},31.{n % 7}\n" for n in range(300))
FORCE = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n" + ROWS


# ---- a campaign to spoil


@cache
def _whole() -> Path:
    """Return a small campaign with its results; simulated once for all cases."""
    folder = Path(tempfile.mkdtemp(prefix="break_it_campaign_"))
    import atexit

    atexit.register(shutil.rmtree, folder, True)
    from tribolab.report.run import run_campaign

    file = simulated(folder, repeats=1, scans=True)
    run_campaign(file, jobs=1)
    return file


def campaign(folder: Path, results: bool = False, change=lambda text: text) -> Path:
    """Copy the campaign, with results if wanted; returns its file."""
    left_out = shutil.ignore_patterns() if results else shutil.ignore_patterns("results")
    shutil.copytree(_whole().parent, folder / "c", ignore=left_out)
    file = folder / "c" / "campaign.toml"
    file.write_text(change(file.read_text("utf-8")), "utf-8")
    return file


def run(file: Path, *more: str) -> Command:
    """Return the command that analyses a campaign."""
    return [*TRIBOLAB, "run", str(file), "-q", "-j", "1", *more]


LONG = {"seconds": 90.0, "large": True}


# ---- 1 to 5: loss


def _spoil(folder: Path, log: str, how: Callable[[Path], None]) -> Command:
    file = campaign(folder, results=True)
    how(next((folder / "c/raw").rglob(log)))
    return run(file)


def _folder_instead(path: Path) -> None:
    path.unlink()
    path.mkdir()


def _kept(folder: Path) -> str:
    old = (_whole().parent / "results/tables/friction.csv").read_text("utf-8")
    new = (folder / "c/results/tables/friction.csv").read_text("utf-8")
    return "" if new == old else "the friction of before is lost"


for _name, _how in {
    "empty": lambda path: path.write_bytes(b""),
    "gone": Path.unlink,
    "a folder": _folder_instead,
    "noise": lambda path: path.write_bytes(bytes(range(256)) * 40),
}.items():
    for _log in ("*dry*_force.csv", "*glycerol*_motion.csv"):
        case(
            f"loss 1: {_log} is {_name}",
            *(_log, _how),
            codes=(UNREADABLE,),
            says="kept from 20",
            after=_kept,
            **LONG,
        )(_spoil)


@case("loss 1: a scan is empty", says="kept from 20", **LONG)
def _(folder: Path) -> Command:
    return _spoil(folder, "profiles/*.csv", lambda path: path.write_bytes(b""))


def _mine(folder: Path) -> str:
    notes = folder / "c/results/notes/mine.md"
    return "" if notes.exists() and notes.read_text() == "squeal" else "a file of theirs is lost"


@case("loss 2: files of others survive", codes=(0, 1), says="mine.md", after=_mine, **LONG)
def _(folder: Path) -> Command:
    file = campaign(folder, True, lambda text: text.replace("trim = 0.10", "trim = 0.11"))
    (folder / "c/results/notes").mkdir()
    (folder / "c/results/notes/mine.md").write_text("squeal")
    return run(file)


def _thesis(folder: Path) -> str:
    return "" if (folder / "thesis/thesis.tex").is_file() else "the thesis is lost"


@case("loss 2: a copied marker makes nothing ours", codes=(USAGE,), after=_thesis, large=True)
def _(folder: Path) -> Command:
    from tribolab.campaign.ledger import MARKER

    file = campaign(folder, results=True)
    (folder / "thesis").mkdir()
    (folder / "thesis/thesis.tex").write_text("three years")
    shutil.copy(folder / "c/results" / MARKER, folder / "thesis")
    return run(file, "-o", str(folder / "thesis"))


@case("loss 3: an input in the results", codes=(USAGE,), says="results must lie apart", large=True)
def _(folder: Path) -> Command:
    file = campaign(
        folder,
        True,
        lambda text: text.replace("[contact]", '[contact]\nmodulus_file = "../results/dma.csv"'),
    )
    (folder / "c/results/dma.csv").write_text("f,E_stor,E_loss\nHz,MPa,MPa\n1,1,1\n2,2,2\n")
    return run(file)


@case("loss 5: brackets in the output's name", codes=(0, 1), **LONG)
def _(folder: Path) -> Command:
    return run(campaign(folder), "-o", str(folder / "out [1]*"))


# ---- 6: units


for _unit in ("9**9**9**9", "m" * 100_000, "(" * 5000, "m^999999999", "10**(10**10)", "__import__"):
    _label = _unit[:16]

    @case(f"units 6: header [{_label}]", _unit, codes=(USAGE, UNREADABLE))
    def _(folder: Path, unit: str) -> Command:
        (folder / "u.csv").write_text(FORCE.replace("[N],Fz", f"[{unit}],Fz"))
        return [*TRIBOLAB, "info", "u.csv"]

    @case(f"units 6: notebook '1 {_label}'", _unit)
    def _(folder: Path, unit: str) -> Command:
        return notebook(f"tl.LineContact('1 ' + {unit!r}, '10 cm', '1.5 MPa', 0.5)")

    @case(f"units 6: campaign '1 {_label}'", _unit, codes=(USAGE,), says="campaign.toml")
    def _(folder: Path, unit: str) -> Command:
        return _toml(folder, {'youngs_modulus = "1.5 MPa"': f'youngs_modulus = "1 {unit}"'})


# ---- 7: patterns


@case("patterns 7: (a+)+$ in a dialect", codes=(USAGE, UNREADABLE))
def _(folder: Path) -> Command:
    (folder / "a.txt").write_text("a" * 5000 + "!\n" + FORCE)
    (folder / "d.toml").write_text(
        'name = "d"\n[header]\npattern = "^(a+)+$"\n[[column]]\nquantity = "time"\n'
        'name = "Time"\n[[column]]\nquantity = "friction_force"\nname = "Fx"\n'
    )
    return [*TRIBOLAB, "info", "a.txt", "-i", "d.toml"]


@case("patterns 7: a pattern of 100 000 groups", codes=(USAGE, UNREADABLE))
def _(folder: Path) -> Command:
    (folder / "a.csv").write_text(FORCE)
    (folder / "d.toml").write_text(f'name = "d"\n[header]\npattern = "{"(a|b)*" * 20_000}"\n')
    return [*TRIBOLAB, "info", "a.csv", "-i", "d.toml"]


# ---- 8: large and strange files


def _wide(folder: Path, head: bool, clock: bool) -> Path:
    n = 5000
    rows = [",".join(f"{(7 * r + 13 * c) % 97 / 9:.4f}" for c in range(n)) for r in range(50)]
    if clock:
        rows = [f"{0.1 * r:.1f}," + row.split(",", 1)[1] for r, row in enumerate(rows)]
    names = ",".join(["time [s]", "Fx [N]", *(f"ch{c} [V]" for c in range(n - 2))])
    path = folder / "wide.csv"
    path.write_text((names + "\n" if head else "") + "\n".join(rows) + "\n")
    return path


for _command in ("dialect", "info", "check"):
    for _head, _clock in ((True, True), (True, False), (False, True), (False, False)):

        @case(
            f"large 8: {_command}, 5000 columns, names {_head}, clock {_clock}",
            *(_command, _head, _clock),
            codes=(0, 1, 3),
        )
        def _(folder: Path, command: str, head: bool, clock: bool) -> Command:
            return [*TRIBOLAB, command, str(_wide(folder, head, clock))]

    for _name, _start, _piece, _end in (
        ("one line of numbers", b"", b"1.234 ", b""),
        ("one line of a letter", b"", b"x", b""),
        ("one line of commas", b"", b"1.5,", b""),
        ("one line of quotes", b"", b'"', b""),
        ("a header and one line", FORCE.encode()[:60], b"1.5,", b""),
        ("empty lines", b"", b"\n", b""),
        ("empty lines CR LF", b"", b"\r\n", b""),
        ("CR alone", b"", b"\r", b""),
        ("blanks", b"", b" ", b""),
        ("a header and empty lines", FORCE.encode()[:50], b"\n", b""),
        ("empty lines, then a table", b"", b"\n", FORCE.encode()),
        ("UTF-16 empty lines", b"\xff\xfe", b"\n\0", b""),
    ):

        @case(
            f"large 8: {_command}, 200 MB, {_name}",
            *(_command, _start, _piece, _end),
            codes=(0, 1, 3),
            large=True,
        )
        def _(folder: Path, command: str, start: bytes, piece: bytes, end: bytes) -> Command:
            with (folder / "long.txt").open("wb") as file:
                file.write(start)
                for _ in range(200):
                    file.write(piece * (1_000_000 // len(piece)))
                file.write(end)
            return [*TRIBOLAB, command, "long.txt"]

    for _tag, _depth in (("a", 3000), ("row", 100_000), ("a", 5_000_000)):

        @case(f"large 8: {_command}, xlsx with {_depth} <{_tag}>", _command, _tag, _depth)
        def _(folder: Path, command: str, tag: str, depth: int) -> Command:
            deep = f"<{tag}>" * depth + f"</{tag}>" * depth
            _workbook(folder / "deep.xlsx", f"<sheetData>{deep}</sheetData>")
            return [*TRIBOLAB, command, "deep.xlsx"]


_OFFICE = "http://schemas.openxmlformats.org"


def _workbook(path: Path, inside: str) -> None:
    types = f"{_OFFICE}/package/2006/content-types"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    relation = f"{_OFFICE}/officeDocument/2006/relationships"
    main = f"{_OFFICE}/spreadsheetml/2006/main"
    package = f"{_OFFICE}/package/2006/relationships"
    members = {
        "[Content_Types].xml": f'<Types xmlns="{types}"><Default Extension="rels" ContentType="'
        'application/vnd.openxmlformats-package.relationships+xml"/><Override PartName="/xl/'
        f'workbook.xml" ContentType="{kind}.sheet.main+xml"/><Override PartName="/xl/sheet.xml" '
        f'ContentType="{kind}.worksheet+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{package}"><Relationship Id="a" Type="{relation}/'
        'officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{relation}"><sheets><sheet '
        'name="DATA" sheetId="1" r:id="a"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{package}"><Relationship Id="a" '
        f'Type="{relation}/worksheet" Target="sheet.xml"/></Relationships>',
        "xl/sheet.xml": f'<worksheet xmlns="{main}">{inside}</worksheet>',
    }
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in members.items():
            archive.writestr(name, text)


# ---- 9: a cluster


def _nothing_left(folder: Path) -> str:
    left = {path.name for path in (folder / "c").iterdir()} - {"campaign.toml", "raw", "truth"}
    return f"left behind: {left}" if left else ""


@case(
    "cluster 9: no scheduler",
    codes=(USAGE,),
    says="no Dask scheduler answers",
    after=_nothing_left,
    seconds=30.0,
    large=True,
)
def _(folder: Path) -> Command:
    return run(campaign(folder), "--scheduler", "tcp://127.0.0.1:1")


_LOST = """
import os, sys
from tribolab.cli import main
from tribolab.report import run
from dask.distributed import LocalCluster
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None,
                      host="127.0.0.1", processes=True) as cluster:
        pids = [worker.pid for worker in cluster.workers.values()]
        whole = run.run_campaign
        def dying(*args, progress=None, **options):
            def kill(*_):
                import signal
                for nanny in cluster.workers.values():
                    nanny.auto_restart = False
                for pid in pids:
                    try:
                        os.kill(pid, signal.SIGKILL)
                    except ProcessLookupError:
                        pass
            return whole(*args, progress=kill, **options)
        run.run_campaign = dying
        import tribolab.campaign.executor as executor
        sys.argv = ["tribolab", "run", sys.argv[1], "-q", "--scheduler", cluster.scheduler_address]
        main()
"""


@case(
    "cluster 9: both workers gone",
    codes=(UNREADABLE,),
    says="Dask cluster is lost",
    after=_nothing_left,
    seconds=90.0,
    large=True,
)
def _(folder: Path) -> Command:
    (folder / "lost.py").write_text(_LOST)
    return [sys.executable, str(folder / "lost.py"), str(campaign(folder))]


# ---- 10: names, terminals, formats


POSIX = {"PYTHONUTF8": "0", "LC_ALL": "POSIX", "PYTHONCOERCECLOCALE": "0"}
_ODD = {"not UTF-8": b"odd_\xff\xe4.csv", "a new line": b"odd\n\x1b[31m.csv", "a blank": b" .csv"}
for _command in ("info", "check", "dialect"):
    for _what, _bytes in _ODD.items():
        for _where, _settings in (("UTF-8", {}), ("POSIX", POSIX)):

            @case(
                f"names 10: {_command}, a name with {_what}, {_where}",
                *(_command, _bytes),
                codes=(0, 1),
                settings=_settings,
            )
            def _(folder: Path, command: str, name: bytes) -> Command:
                inner = os.fsencode(folder) + b"/f\xff\xfe"
                os.mkdir(inner)  # noqa: PTH102 - a name of bytes
                with open(inner + b"/" + name, "w") as file:  # noqa: PTH123 - a name of bytes
                    file.write(FORCE)
                more = ["-o", str(folder / "d.toml")] if command == "dialect" else []
                return [*TRIBOLAB, command, inner + b"/" + name, *more]


def _results_there(folder: Path) -> str:
    return "" if (folder / "c/results/report.html").is_file() else "no report"


for _where, _settings in (("UTF-8", {}), ("POSIX", POSIX)):

    @case(
        f"names 10: a campaign of such names, {_where}",
        codes=(0, 1),
        settings=_settings,
        after=_results_there,
        **LONG,
    )
    def _(folder: Path) -> Command:
        file = campaign(folder)
        for log in ("force", "motion"):
            old = next((folder / "c/raw/friction").glob(f"*dry*_{log}.csv"))
            new = os.fsencode(old).replace(b"dry_31N_01", b"dry_31N_\xff\xe4")
            os.rename(old, new)  # noqa: PTH104 - a name of bytes
        return run(file)


def _shell(command: Command, *rest: str) -> Command:
    """Pass output on to a reader that leaves; the exit code is that of tribolab."""
    import shlex

    line = " ".join(map(shlex.quote, map(str, command)))
    return ["bash", "-c", f"set -o pipefail; {line} {' '.join(rest)}"]


for _name, _rest in (("| head -1", "| head -1"), ("> /dev/full", "> /dev/full"), (">&-", ">&-")):

    @case(f"pipes 10: check {_name}", _rest, codes=(0, 1, 2, 3))
    def _(folder: Path, rest: str) -> Command:
        for n in range(5):
            (folder / f"a{n}.csv").write_text(FORCE)
        return _shell([*TRIBOLAB, "check", "--all", *(f"a{n}.csv" for n in range(5))], rest)


for _command in ("info", "check", "dialect", "run"):

    @case(f"links 10: {_command} of a loop", _command, codes=(USAGE, UNREADABLE), says="symbolic")
    def _(folder: Path, command: str) -> Command:
        (folder / "loop.csv").symlink_to("loop.csv")
        return [*TRIBOLAB, command, "loop.csv"]


@case("links 10: a loop among the raw files", codes=(0, 1), after=_results_there, **LONG)
def _(folder: Path) -> Command:
    file = campaign(folder)
    (folder / "c/raw/friction/up").symlink_to("..")
    (folder / "c/raw/friction/sb-r_dry_31N_09_force.csv").symlink_to("sb-r_dry_31N_09_force.csv")
    return run(file)


@case("names 10: an output of 256 characters", codes=(UNREADABLE,), says="too long", large=True)
def _(folder: Path) -> Command:
    return run(campaign(folder), "-o", str(folder / ("o" * 256)))


@case("names 10: a dialect of 256 characters", says="File name too long")
def _(folder: Path) -> Command:
    (folder / "a.csv").write_text(FORCE)
    return [*TRIBOLAB, "dialect", "a.csv", "-o", "d" * 256 + ".toml"]


for _number in range(3):
    for _command in ("info", "check", "dialect"):

        @case(f"quotes 10: {_command}, open mark {_number}", _number, _command, codes=(0, 1, 3))
        def _(folder: Path, number: int, command: str) -> Command:
            text = (
                FORCE.replace("\n5.0,", '\n"5.0,'),
                'Time [s],Fx [N]\n"0.1,1\n' + ROWS,
                FORCE.replace("Fx [N]", '"Fx [N]'),
            )[number]
            (folder / "q.csv").write_text(text)
            return [*TRIBOLAB, command, "q.csv"]


def _sdf(x: str, z: str) -> str:
    return (
        "aBCR-1.0\nManufacID = x\nCreateDate = 010120000000\nModDate = 010120000000\n"
        f"NumPoints = 4\nNumProfiles = 4\nXscale = {x}\nYscale = {x}\nZscale = {z}\n"
        "Zresolution = -1\nCompression = 0\nDataType = 7\nCheckType = 0\n*\n"
        + "1 2 3 4\n" * 4
        + "*\n"
    )


for _x, _z in (("0", "1e-6"), ("1e-6", "0"), ("0", "0"), ("-1e-6", "1e-6"), ("nan", "nan")):
    for _command in ("info", "check", "read_scans"):

        @case(f"sdf 10: {_command}, scales {_x} and {_z}", *(_command, _x, _z), codes=(0, 1, 3))
        def _(folder: Path, command: str, x: str, z: str) -> Command:
            (folder / "s.sdf").write_text(_sdf(x, z))
            if command == "read_scans":
                return notebook("s = tl.read_scans('s.sdf')\nprint(tl.roughness(s))")
            return [*TRIBOLAB, command, "s.sdf"]


def _netcdf(path: Path, kind: str) -> None:
    import netCDF4
    import numpy as np

    with netCDF4.Dataset(path, "w") as data:
        data.createDimension("time", 50)
        data.createDimension("k", 3)
        dims = ("time", "k") if kind in ("2D", "2D time") else ("time",)
        at = ("time", "k") if kind == "2D time" else ("time",)
        if kind == "text time":
            time = data.createVariable("time", str, at)
            for n in range(50):
                time[n] = f"12:00:{n:02d}"
        else:
            time = data.createVariable("time", "f8", at)
            time[:] = (
                np.broadcast_to(np.arange(50.0)[:, None], (50, 3)).T[0]
                if at == ("time",)
                else np.arange(150.0).reshape(50, 3)
            )
        for name in ("friction_force", "normal_force"):
            if kind == "text":
                force = data.createVariable(name, str, dims)
                for n in range(50):
                    force[n] = str(n)
            else:
                force = data.createVariable(name, "f8", dims)
                force[:] = 31.0
            if kind == "array attributes":
                force.units = np.arange(3.0)
                force.long_name = np.arange(3)
        if kind == "array attributes":
            for key in ("instrument", "source", "columns_used", "columns_not_used", "history"):
                data.setncattr(key, np.arange(3))
            for key in ("time_origin_s", "set_speed_m_s", "set_normal_force_N", "findings"):
                data.setncattr(key, np.arange(2.0))
        if kind == "deep attributes":
            data.history = "json:" + "[" * 100_000


for _kind in ("text time", "2D", "2D time", "text", "array attributes", "deep attributes"):
    for _command in ("info", "check", "read"):

        @case(f"netcdf 10: {_command}, {_kind}", *(_command, _kind), codes=(0, 1, 3))
        def _(folder: Path, command: str, kind: str) -> Command:
            _netcdf(folder / "n.nc", kind)
            if command == "read":
                return notebook("r = tl.read('n.nc')\ntl.check(r)\nprint(r)")
            return [*TRIBOLAB, command, "n.nc"]


def _toml(folder: Path, replace: Mapping[str, str], more: str = "") -> Command:
    """Return a command on a campaign file that is wrong before any raw file is read."""
    text = (
        '[campaign]\nname = "x"\n[contact]\nyoungs_modulus = "1.5 MPa"\n[medium.glycerol]\n'
        'viscosity = "1 Pa s"\n[segments]\ntrim = 0.10\n[[run]]\nfiles = "*.csv"\n'
    )
    for old, new in replace.items():
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "raw").mkdir()
    (folder / "raw/a.csv").write_text(FORCE)
    (folder / "campaign.toml").write_text(text + more)
    return [*TRIBOLAB, "run", str(folder / "campaign.toml"), "-q", "-j", "1"]


for _name, _replace, _more in (
    ("an empty key", {}, '[x]\n"" = 1\n'),
    ("an empty table", {}, '[""]\n"" = 1\n'),
    ("an empty list of tables", {}, '[["".""]]\n"" = 1\n'),
    ("an empty medium", {"[medium.glycerol]": '[medium.""]\nvis = 1'}, ""),
    ("a key of 300 characters", {}, "k" * 300 + " = 1\n"),
    ("a file of 300 characters", {'"*.csv"': '"' + "f" * 300 + '"'}, ""),
    ("lists a thousand deep", {}, "x = " + "[" * 1000 + "]" * 1000 + "\n"),
    ("lists 400 deep", {"trim = 0.10": "trim = " + "[" * 400 + "]" * 400}, ""),
    ("tables a thousand deep", {}, "x = " + "{a=" * 1000 + "1" + "}" * 1000 + "\n"),
    ("dots three thousand deep", {}, "[" + ".".join("a" * 3000) + "]\nb = 1\n"),
    ("a number of 5000 digits", {"trim = 0.10": "trim = " + "9" * 5000}, ""),
    ("1e999", {"trim = 0.10": "trim = 1e999"}, ""),
    ("nan", {"trim = 0.10": "trim = nan"}, ""),
    ("ESC", {"trim = 0.10": 'trim = "\\u001b[31m' + "x" * 5000 + '"'}, ""),
    ("20 000 unknown keys", {}, "".join(f"k{n} = 1\n" for n in range(20_000))),
):

    @case(f"toml 10: {_name}", _replace, _more, codes=(USAGE,), says="campaign.toml")
    def _(folder: Path, replace: Mapping[str, str], more: str) -> Command:
        return _toml(folder, replace, more)


@case("toml 10: a dialect a thousand deep", codes=(USAGE,), says="d.toml")
def _(folder: Path) -> Command:
    (folder / "a.csv").write_text(FORCE)
    (folder / "d.toml").write_text("x = " + "[" * 1000 + "]" * 1000)
    return [*TRIBOLAB, "info", "a.csv", "-i", "d.toml"]


# ---- 14: tables for spreadsheets


@case("spreadsheets 14: names that are formulas", codes=(0,), says="SAFE", seconds=60.0, large=True)
def _(folder: Path) -> Command:
    name = "=HYPERLINK(1)"
    file = campaign(folder, change=lambda text: text.replace('"Sb-R"', f'"{name}"'))
    return notebook(
        "import pathlib\n"
        f"tl.run_campaign({str(file)!r}, jobs=1)\n"
        f"folder = pathlib.Path({str(file.parent)!r}) / 'results'\n"
        "raw = (folder / 'tables/friction.csv').read_text()\n"
        f"back = tl.read_results(folder)['friction']\n"
        f"assert set(back['surface']) == {{{name!r}}}\n"
        "assert not any(cell[:1] in '=@' for line in raw.splitlines() "
        "for cell in line.replace('\"', '').split(',') if cell)\n"
        "print('SAFE')"
    )


# ---- 15: what a file that is no table holds


SECRET = "root:x:0:0:hunter2:/root:/bin/bash\ndaemon:x:1:1:hunter2:/usr/sbin:/bin/sh\n" * 5
_NEVER = {"never": "hunter2|daemon"}


def _secret(folder: Path) -> str:
    (folder / "passwd").write_text(SECRET)
    return str(folder / "passwd")


for _command in ("info", "check", "dialect", "run"):

    @case(f"secrets 15: {_command}", _command, codes=(USAGE, UNREADABLE), **_NEVER)
    def _(folder: Path, command: str) -> Command:
        return [*TRIBOLAB, command, _secret(folder)]


def _instruments() -> list[str]:
    from tribolab.io.dialects import known_dialects

    return list(known_dialects())


for _instrument in _instruments():

    @case(f"secrets 15: as {_instrument}", _instrument, codes=(UNREADABLE,), **_NEVER)
    def _(folder: Path, instrument: str) -> Command:
        return [*TRIBOLAB, "info", _secret(folder), "-i", instrument]


@case("secrets 15: parted by colons", codes=(USAGE, UNREADABLE), **_NEVER)
def _(folder: Path) -> Command:
    (folder / "d.toml").write_text(
        'name = "d"\ntitle = "d"\n[text]\ndelimiter = ":"\n[[column]]\nquantity = "time"\n'
        'position = 1\nunit = "s"\n[[column]]\nquantity = "friction_force"\nposition = 5\n'
        'unit = "N"\n'
    )
    return [*TRIBOLAB, "info", _secret(folder), "-i", "d.toml"]


@case("secrets 15: as a dialect", codes=(USAGE,), **_NEVER)
def _(folder: Path) -> Command:
    (folder / "a.csv").write_text(FORCE)
    (folder / "d.toml").write_text(SECRET)
    return [*TRIBOLAB, "info", "a.csv", "-i", "d.toml"]


for _key in ("files", "scans", "modulus_file"):

    @case(f"secrets 15: {_key} = passwd", _key, codes=(USAGE, UNREADABLE), **LONG, **_NEVER)
    def _(folder: Path, key: str) -> Command:
        path = _secret(folder)
        new = {
            "files": ('files = "friction/sb-r_dry', f'files = ["{path}"] #'),
            "scans": ('scans = "', 'scans = "../../passwd" # "'),
            "modulus_file": ("[contact]", '[contact]\nmodulus_file = "../../passwd"'),
        }[key]
        return run(campaign(folder, change=lambda text: text.replace(*new, 1)))


for _call in (
    "tl.read('passwd')",
    "tl.read_scans('passwd', x_unit='mm', height_unit='um')",
    "tl.read_modulus('passwd')",
    "tl.read_results('passwd')",
):

    @case(f"secrets 15: {_call}", _call, **_NEVER)
    def _(folder: Path, call: str) -> Command:
        _secret(folder)
        return notebook(call)
