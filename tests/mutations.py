"""Ways in which a raw file goes wrong: each mutator takes bytes and a generator, and gives bytes.

Plain functions of (content, rng), so that a seed reproduces every damaged file. `KINDS` says which
mutators suit which family of files.
"""

from __future__ import annotations

import io
import re
import struct
import warnings
import zipfile
import zlib

import numpy as np

Rng = np.random.Generator

_NASTY = (
    *(b"nan", b"inf", b"-inf", b"1e999", b"-1e-999", b"1e308", b"-1.7e308", b"", b" ", b"-", b"."),
    *(b"Err110", b"*.*******um", b"10.0mm", b"0x1F", b"1_000", b"1.234,5", b'"1', b'"', b"'", b"#"),
    *(b"\x00", b"\xff\xfe", b"\xb5m", b"9" * 400, b"1" + b"0" * 30, b"1;2", b"1\t2", b"TRUE"),
    *(b"2026-03-02", b"-0", b"+5", b"1e", b"1e-320", b"\xe2\x88\x921.5", "١٢".encode()),
)
_WORDS = (b"Fx", b"Time", b"Column", b"x", b"", b"Kraft", b"\xb5", b"[N]", b"(N", b"N]", b"[bla]")


def _some(rng: Rng, most: int) -> int:
    """Draw a number from 1 to `most`, small ones more often."""
    return int(min(most, 1 + rng.geometric(2.0 / (most + 1))))


# ---- bytes


def flip(content: bytes, rng: Rng) -> bytes:
    """Put random bytes at random places."""
    mutated = bytearray(content)
    for place in rng.integers(0, max(len(content), 1), _some(rng, 40)):
        if place < len(mutated):
            mutated[place] = rng.integers(0, 256)
    return bytes(mutated)


def flip_start(content: bytes, rng: Rng) -> bytes:
    """Put random bytes where formats keep their structure: the first two thousand bytes."""
    return flip(content[:2048], rng) + content[2048:]


def truncate(content: bytes, rng: Rng) -> bytes:
    """Cut the end off, anywhere."""
    return content[: int(rng.integers(0, len(content) + 1))]


def truncate_start(content: bytes, rng: Rng) -> bytes:
    """Cut the start off."""
    return content[int(rng.integers(0, min(len(content), 5000) + 1)) :]


def remove_block(content: bytes, rng: Rng) -> bytes:
    """Take a block out."""
    first = int(rng.integers(0, len(content) + 1))
    return content[:first] + content[first + int(rng.integers(1, 5000)) :]


def double_block(content: bytes, rng: Rng) -> bytes:
    """Write a block twice."""
    first = int(rng.integers(0, len(content) + 1))
    last = first + int(rng.integers(1, 5000))
    return content[:last] + content[first:]


def overwrite_block(content: bytes, rng: Rng) -> bytes:
    """Overwrite a block as a failing disk does: zeros, ones or noise."""
    first = int(rng.integers(0, len(content) + 1))
    length = min(int(rng.integers(1, 5000)), len(content) - first)
    noise = rng.integers(0, 256, length, dtype=np.uint8).tobytes()
    block = (b"\0" * length, b"\xff" * length, noise)[rng.integers(3)]
    return content[:first] + block + content[first + length :]


def wild_number(content: bytes, rng: Rng) -> bytes:
    """Put extreme whole numbers where a binary format may keep sizes and offsets."""
    mutated = bytearray(content)
    for _ in range(_some(rng, 6)):
        form = ("<I", ">I", "<Q", ">Q", "<H")[rng.integers(5)]
        bits = 8 * struct.calcsize(form)
        number = (2**bits - 1, 2 ** (bits - 1), 2 ** (bits - 1) - 1, 2 ** (bits // 2), 0, 1, 7)
        reach = min(len(mutated), 4096 if rng.random() < 0.7 else len(mutated))
        place = 4 * int(rng.integers(0, max(reach // 4, 1)))
        written = struct.pack(form, number[rng.integers(len(number))])
        mutated[place : place + len(written)] = written
    return bytes(mutated)


# ---- text


def _lines(content: bytes) -> list[bytes]:
    return re.split(rb"(?<=\n)|(?<=\r)(?!\n)", content)


def _place(lines: list[bytes], rng: Rng) -> int:
    """Draw a line; among the first forty, where headers stand, as often as anywhere."""
    return int(rng.integers(0, len(lines) if rng.random() < 0.5 else min(len(lines), 40)))


def drop_lines(content: bytes, rng: Rng) -> bytes:
    """Leave out lines."""
    lines = _lines(content)
    for _ in range(_some(rng, 20)):
        if lines:
            del lines[_place(lines, rng)]
    return b"".join(lines)


def double_lines(content: bytes, rng: Rng) -> bytes:
    """Write lines twice, here or elsewhere."""
    lines = _lines(content)
    for _ in range(_some(rng, 10)):
        lines.insert(_place(lines, rng), lines[_place(lines, rng)])
    return b"".join(lines)


def shuffle_lines(content: bytes, rng: Rng) -> bytes:
    """Change the order of a stretch of lines, or of all."""
    lines = _lines(content)
    first = _place(lines, rng)
    last = len(lines) if rng.random() < 0.3 else first + int(rng.integers(2, 200))
    part = lines[first:last]
    order = rng.permutation(len(part))
    return b"".join(lines[:first] + [part[i] for i in order] + lines[last:])


def swap_decimals(content: bytes, rng: Rng) -> bytes:
    """Exchange decimal marks, in the whole file or from some line on."""
    first = int(rng.integers(0, len(content) + 1)) if rng.random() < 0.5 else 0
    swaps = (b".,,.", b".,", b",.", b",;", b";,", b",\t", b"\t,", b"\t ", b" \t")[rng.integers(9)]
    half = len(swaps) // 2
    old, new = (swaps[::2], swaps[1::2]) if half == 2 else (swaps[:1], swaps[1:])
    return content[:first] + content[first:].translate(bytes.maketrans(old, new))


def change_encoding(content: bytes, rng: Rng) -> bytes:
    """Save the text in another encoding, with or without a mark at its start."""
    text = content.decode("latin-1")
    kind = int(rng.integers(9))
    if kind == 0:
        return b"\xef\xbb\xbf" + content
    if kind == 1:
        return text.encode("utf-8")
    if kind == 2:
        return b"\xff\xfe" + content  # the mark alone
    if kind == 3:
        return text.encode("utf-16")[: -1 if rng.random() < 0.3 else None]
    if kind == 4:
        return text.encode("cp500", errors="replace")
    form = ("utf-16-le", "utf-16-be", "utf-32", "utf-8-sig")[kind - 5]
    return text.encode(form)


def change_line_ends(content: bytes, rng: Rng) -> bytes:
    """Write other line ends, everywhere or in a part."""
    end = (b"\r", b"\n", b"\r\n", b"\r\r\n", b"\n\n", b"", b"\x0b", b"\x85")[rng.integers(8)]
    first = int(rng.integers(0, len(content) + 1)) if rng.random() < 0.5 else 0
    return content[:first] + re.sub(rb"\r+\n|\r|\n", end, content[first:])


def rename_columns(content: bytes, rng: Rng) -> bytes:
    """Change words in a line among the first forty."""
    lines = _lines(content)
    for _ in range(_some(rng, 4)):
        place = int(rng.integers(0, min(len(lines), 40)))
        words = re.split(rb"([,;\t \[\]()])", lines[place])
        words[rng.integers(len(words))] = _WORDS[rng.integers(len(_WORDS))]
        lines[place] = b"".join(words)
    return b"".join(lines)


def nasty_cells(content: bytes, rng: Rng) -> bytes:
    """Put what instruments write instead of numbers into cells."""
    lines = _lines(content)
    for _ in range(_some(rng, 10)):
        place = _place(lines, rng)
        cells = re.split(rb"([,;\t\r\n])", lines[place])
        cells[rng.integers(len(cells))] = _NASTY[rng.integers(len(_NASTY))]
        lines[place] = b"".join(cells)
    return b"".join(lines)


def nasty_column(content: bytes, rng: Rng) -> bytes:
    """Put one such thing into the same column of all lines from some line on."""
    lines = _lines(content)
    first, column = _place(lines, rng), 2 * int(rng.integers(0, 4))
    thing = _NASTY[rng.integers(len(_NASTY))]
    for place in range(first, len(lines)):
        cells = re.split(rb"([,;\t\r\n])", lines[place])
        if column < len(cells):
            cells[column] = thing
            lines[place] = b"".join(cells)
    return b"".join(lines)


def long_line(content: bytes, rng: Rng) -> bytes:
    """Make one line very long."""
    lines = _lines(content)
    place = _place(lines, rng)
    piece = (b"7", b"1.5,", b"[", b"a ", b'"', b"(((", b"\t")[rng.integers(7)]
    lines[place] = piece * int(rng.integers(1, 300_000)) + lines[place]
    return b"".join(lines)


# ---- archives (xlsx) and MAT, beneath the compression


def _rezipped(content: bytes, change) -> bytes:
    """Pass every member (name, bytes) through `change`, which gives a list of such pairs."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            members = [(name, archive.read(name)) for name in archive.namelist()]
    except (zipfile.BadZipFile, zlib.error, ValueError, OSError, EOFError, struct.error):
        return content  # damaged in another way before
    except (NotImplementedError, RuntimeError):  # a kind of packing that there is not
        return content
    out = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        warnings.simplefilter("ignore", UserWarning)  # a name used twice is meant
        for name, data in change(members):
            archive.writestr(name, data)
    return out.getvalue()


def _xml(members: list, rng: Rng) -> int:
    wanted = [n for n, (name, _) in enumerate(members) if name.endswith((".xml", ".rels"))]
    return wanted[rng.integers(len(wanted))] if wanted else 0


def zip_members(content: bytes, rng: Rng) -> bytes:
    """Damage one member's text, leave a member out, or write it twice."""

    def change(members):
        place, kind = _xml(members, rng), rng.integers(4)
        name, data = members[place]
        if kind == 0:
            return [*members[:place], *members[place + 1 :]]
        if kind == 1:
            return [*members, (name, flip(data, rng))]
        if kind == 2:
            members[place] = (name, nasty_xml(data, rng))
        else:
            members[place] = (name, flip(data, rng))
        return members

    return _rezipped(content, change)


def nasty_xml(data: bytes, rng: Rng) -> bytes:
    """Put nasty values between tags and into attributes."""
    places = [m.span(1) for m in re.finditer(rb'[>"]([^<>"]{1,60})[<"]', data)]
    for _ in range(_some(rng, 10)):
        if places:
            first, last = places[rng.integers(len(places))]
            thing = _NASTY[rng.integers(len(_NASTY))][: last - first].replace(b"\x00", b"0")
            data = data[:first] + thing.ljust(last - first) + data[last:]
    return data


def entity_bomb(content: bytes, rng: Rng) -> bytes:
    """Let one member's entities unfold to gigabytes, or point at a file."""
    levels = "".join(
        f'<!ENTITY e{n} "{f"&e{n - 1};" * 10 if n else "boom" * 10}">' for n in range(10)
    )
    outside = '<!ENTITY e9 SYSTEM "file:///etc/hostname">'
    inside = levels if rng.random() < 0.7 else outside

    def change(members):
        place = _xml(members, rng)
        name, data = members[place]
        body = re.sub(rb"^\s*<\?xml[^>]*\?>", b"", data)
        root = re.search(rb"<([A-Za-z:]+)", body)
        start = f"<?xml version='1.0'?><!DOCTYPE {root[1].decode() if root else 'x'} [{inside}]>"
        body = re.sub(rb">([^<>]{1,40})<", b">&e9;<", body, count=1)
        members[place] = (name, start.encode() + body)
        return members

    return _rezipped(content, change)


def path_outside(content: bytes, rng: Rng) -> bytes:
    """Add members whose names lead out of the archive's folder."""
    outside = ("../outside.xml", "../../outside.txt", "/tmp/outside.xml", "..\\outside.xml")

    def change(members):
        place = _xml(members, rng)
        name, data = members[place]
        escaped = outside[rng.integers(len(outside))]
        if rng.random() < 0.5:
            members[place] = (escaped, data)
            return [
                (n, d.replace(name.rsplit("/", 1)[-1].encode(), escaped.encode()))
                for n, d in members
            ]
        return [*members, (escaped, data)]

    return _rezipped(content, change)


def zip_bomb(content: bytes, rng: Rng) -> bytes:
    """Let one member unfold to a hundred megabytes of blanks."""
    blanks = b" " * (1 << 20)

    def change(members):
        place = _xml(members, rng)
        name, data = members[place]
        middle = data.find(b">") + 1
        members[place] = (
            name,
            data[:middle] + blanks * int(rng.integers(100, 150)) + data[middle:],
        )
        return members

    return _rezipped(content, change)


def mat_inside(content: bytes, rng: Rng) -> bytes:
    """Damage the elements of a MAT file beneath their compression."""
    out, place = [content[:128]], 128
    while place + 8 <= len(content):
        kind, size = struct.unpack_from("<II", content, place)
        data = content[place + 8 : place + 8 + size]
        if kind == 15:
            try:
                inner = zlib.decompress(data)
            except zlib.error:
                return content
            damage = (flip_start, wild_number, truncate, flip)[rng.integers(4)]
            head, tail = inner[:256], inner[256:]
            data = zlib.compress(damage(head, rng) + tail, 1)
        out.append(struct.pack("<II", kind, len(data)) + data)
        place += 8 + size
    return b"".join(out)


BYTES = (flip, truncate, truncate_start, remove_block, double_block, overwrite_block)
LINES = (drop_lines, double_lines, shuffle_lines, swap_decimals, change_encoding, change_line_ends)
LINES += (rename_columns, nasty_cells, nasty_column, long_line)
BINARY = (flip_start, wild_number)
ARCHIVE = (zip_members, zip_members, zip_members, entity_bomb, path_outside, zip_bomb)
KINDS = {
    "text": (*BYTES, *LINES, *LINES),
    "zip": (*BYTES, *ARCHIVE),
    "mat": (*BYTES, *BINARY, mat_inside, mat_inside),
    "binary": (*BYTES, *BINARY, *BINARY),
}


def family(content: bytes) -> str:
    """Return the family of a file, told by its first bytes."""
    if content[:4] == b"PK\x03\x04":
        return "zip"
    if content[:6] == b"MATLAB":
        return "mat"
    return "binary" if b"\0" in content[:4096] else "text"


def mutate(content: bytes, rng: Rng) -> tuple[bytes, str]:
    """Damage a file in one to three ways; return it and the names of the ways."""
    ways = KINDS[family(content)]
    names = []
    for _ in range(1 + int(rng.random() < 0.3) + int(rng.random() < 0.1)):
        way = ways[rng.integers(len(ways))]
        content = way(content, rng)
        names.append(way.__name__)
        if len(content) == 0:
            break
    return content, "+".join(names)


# ---- whole files of unusual kinds, made rather than damaged


def _numbers(rng: Rng, rows: int, columns: int, mark: str) -> str:
    values = rng.normal(size=(rows, columns)).round(4)
    values[:, 0] = 0.1 * np.arange(rows)
    return "\n".join(mark.join(map(str, row)) for row in values) + "\n"


def wide(rng: Rng) -> bytes:
    """Thousands of columns."""
    columns, mark = int(rng.integers(500, 6000)), (",", ";", "\t", " ")[rng.integers(4)]
    units = ("[N]", "(mm)", "", "[bla]", "[s]")
    names = mark.join(f"c{n}{units[rng.integers(5)]}" for n in range(columns))
    head = names + "\n" if rng.random() < 0.6 else ""
    return (head + _numbers(rng, int(rng.integers(2, 40)), columns, mark)).encode()


def deep(rng: Rng) -> bytes:
    """Thousands of brackets, tags or lists in one another."""
    depth = int(rng.integers(500, 300_000))
    pairs = ("[]", "()", "{}", ("<a>", "</a>"), ('{"a":', "}"), ("<row>", "</row>"))
    first, last = pairs[rng.integers(len(pairs))]
    nested = first * depth + "1" + last * depth
    kind = int(rng.integers(4))
    if kind == 0:  # in a header
        return f"Time [s],F{nested} [N]\n{_numbers(rng, 20, 2, ',')}".encode()
    if kind == 1:  # a unit
        return f"Time [s],Fx [{nested}]\n{_numbers(rng, 20, 2, ',')}".encode()
    if kind == 2:
        return nested.encode()
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", nested)
        archive.writestr("xl/workbook.xml", nested)
        archive.writestr("main.xml", nested)
    return out.getvalue()


def endless(rng: Rng) -> bytes:
    """Lines without end, or ends without lines."""
    pieces = (
        "1.5,",
        "7",
        " ",
        "\t",
        "\n",
        "\r",
        "\r\n",
        "a",
        '"',
        "'",
        "1 ",
        ";",
        "#",
        "\x0b",
        "e+",
    )
    piece = pieces[rng.integers(len(pieces))]
    head = "Time [s],Fx [N],Fz [N]\n" if rng.random() < 0.5 else ""
    tail = "\n" + _numbers(rng, 20, 3, ",") if rng.random() < 0.5 else ""
    return (head + piece * int(rng.integers(100_000, 12_000_000)) + tail).encode()


def foreign(rng: Rng) -> bytes:
    """A sound table in an encoding that labs abroad use."""
    encodings = ("utf-16", "utf-16-le", "utf-16-be", "utf-32", "utf-7", "cp500", "cp037", "koi8-r")
    encodings += ("shift_jis", "gb18030", "big5", "euc_kr", "iso2022_jp", "cp1251", "mac_roman")
    words = ("Zeit [s]", "時間 [s]", "Время [с]", "시간", "Kraft [µN]", "Fx [N]", "Δx", "−5", "‰")
    names = ",".join(words[rng.integers(len(words))] for _ in range(3))
    text = f"{names}\n{_numbers(rng, 200, 3, ',')}"
    content = text.encode(encodings[rng.integers(len(encodings))], errors="replace")
    return mutate(content, rng)[0] if rng.random() < 0.5 else content


def wild_cells(rng: Rng) -> bytes:
    """Numbers beyond all numbers, in every place."""
    wild = (
        "1e999",
        "-1e999",
        "1e-999",
        "9" * 4000,
        "nan",
        "inf",
        "-inf",
        "1e308",
        "-1e308",
        "5e-324",
    )
    share = float(rng.choice([0.01, 0.3, 1.0]))
    cells = rng.normal(size=(300, 3)).round(3).astype(object)
    cells[:, 0] = (0.1 * np.arange(300)).round(3)
    for place in np.argwhere(rng.random(cells.shape) < share):
        cells[tuple(place)] = wild[rng.integers(len(wild))]
    heads = ("# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n", "", "x [mm],y [mm],z [um]\n")
    heads += ("Time [1e999 s],Fx [9**9 N],Fz [N]\n", "x [mm],z [um],n\n")
    rows = "\n".join(",".join(map(str, row)) for row in cells)
    return (heads[rng.integers(len(heads))] + rows + "\n").encode()


def long_header(rng: Rng) -> bytes:
    """Ten thousand lines before the table, of several kinds."""
    lines = (
        "# key: value",
        "Load = 31 N",
        "",
        "1;2",
        "step 1",
        "[section]",
        "a,b,c",
        "\t\t",
        "12.5",
    )
    one = lines[rng.integers(len(lines))]
    mixed = rng.random() < 0.5
    header = [lines[rng.integers(len(lines))] if mixed else f"{one}{n}" for n in range(10_000)]
    table = "Time [s],Fx [N],Fz [N]\n" + _numbers(rng, 100, 3, ",")
    return ("\n".join(header) + "\n" + table * int(rng.integers(1, 4))).encode()


MADE = (wide, deep, endless, foreign, wild_cells, long_header)
