"""What others do with our tables, and what an error may tell of a file."""

from __future__ import annotations

from pathlib import Path

from hostile.base import (
    FORCE,
    LONG,
    TRIBOLAB,
    UNREADABLE,
    USAGE,
    Command,
    campaign,
    case,
    notebook,
    run,
)

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
    from tribolab.reading.dialect.find import known_dialects

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
    "tl.rubber.read_modulus('passwd')",
    "tl.read_results('passwd')",
):

    @case(f"secrets 15: {_call}", _call, **_NEVER)
    def _(folder: Path, call: str) -> Command:
        _secret(folder)
        return notebook(call)
