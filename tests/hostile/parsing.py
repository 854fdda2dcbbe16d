"""Units, patterns, and files that are large or strange."""

from __future__ import annotations

import zipfile
from pathlib import Path

from hostile.base import (
    FORCE,
    TRIBOLAB,
    UNREADABLE,
    USAGE,
    Command,
    case,
    notebook,
    wrong_campaign,
)

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
        return wrong_campaign(
            folder, {'youngs_modulus = "1.5 MPa"': f'youngs_modulus = "1 {unit}"'}
        )

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


def _pieces(folder: Path, command: str, where: str, piece: str) -> Command:
    """Write a file in which a time that grows with the square of a line would be minutes."""
    numbers, many = "1,2\n2,4\n3,1\n" * 10, piece * 300_000
    (folder / "odd.txt").write_text(
        {
            "a row": f"1{many}3\n{numbers}",
            "the header": f"Time [s],F{many}x [N]\n{numbers}",
            "the end": f"Time [s],Fx [N]\n{numbers}7{many}x\n",
        }[where]
    )
    return [*TRIBOLAB, command, "odd.txt"]


for _command in ("dialect", "info", "check"):
    for _where in ("a row", "the header", "the end"):
        for _piece in (" ", "\t", "\r", "(", "1,", "a,", "[N] "):
            case(
                f"large 8: {_command}, 300 000 times {_piece!r} in {_where}",
                *(_command, _where, _piece),
                codes=(0, 1, 3),
            )(_pieces)


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

    # The 5 s are for depth, which no office program writes. A million flat rows are what a legal
    # workbook may hold (1 048 576): reading them takes as long as there are cells, some 20 s.
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
