"""Names, terminals, pipes, links, and formats with odd contents."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from hostile.base import (
    FORCE,
    LONG,
    ROWS,
    TRIBOLAB,
    UNREADABLE,
    USAGE,
    Command,
    campaign,
    case,
    notebook,
    run,
    wrong_campaign,
)

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
        says="2 of 2 runs",
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


@case(
    "names 10: a campaign in a folder of such a name",
    codes=(0, 1),
    says="2 of 2 runs",
    never="cannot be",
    after=lambda folder: _results_there(next(folder.glob("in*"))),
    **LONG,
)
def _(folder: Path) -> Command:
    inner = Path(os.fsdecode(os.fsencode(folder) + b"/in\xff\xfe"))
    inner.mkdir()
    file = campaign(inner)
    scan = next((file.parent / "raw/profiles").glob("*.csv"))
    scan.rename(Path(os.fsdecode(os.fsencode(scan).replace(b"_1.csv", b"_\xe4.csv"))))
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
        return _shell([*TRIBOLAB, "check", "--verbose", *(f"a{n}.csv" for n in range(5))], rest)


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
                return notebook("s = tl.read_scans('s.sdf')\nprint(tl.roughness_parameters(s))")
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
        return wrong_campaign(folder, replace, more)


@case("toml 10: a dialect a thousand deep", codes=(USAGE,), says="d.toml")
def _(folder: Path) -> Command:
    (folder / "a.csv").write_text(FORCE)
    (folder / "d.toml").write_text("x = " + "[" * 1000 + "]" * 1000)
    return [*TRIBOLAB, "info", "a.csv", "-i", "d.toml"]
