"""Report which files of profiles and maps are read, how, and the accuracy of their heights.

    python tests/robustness/scan_kinds.py [--write docs/scan_kinds.md]

Over files that are written here with known heights, by SurfaceTopography's own writers where it
has some, and over the measured files of ``../shared/data``, whose heights and pitch a few plain
lines parse independently of the scan readers (`plain`). An error is a file that is not read
(or not refused) as the table says, a height that is off by more than its last digit, a pitch that
is off by 1e-6. The exit code is 1 then.
"""

from __future__ import annotations

import argparse
import re
import struct
import sys
import tempfile
import warnings
import zipfile
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

import tribolab as tl
from tribolab.core.errors import TribolabError

SHARED = Path(__file__).parents[3] / "shared" / "data"
AT_ONCE, DRAFTED, DESCRIBED, REFUSED = "directly", "by its header", "with a dialect", "refused"
LINE = np.round(1e-6 * np.sin(np.arange(240) / 9.0), 10)  # m
AREA = np.round(1e-6 * np.add.outer(np.sin(np.arange(7)), np.cos(np.arange(12))), 10)
PITCH = 0.25e-6


class Kind(NamedTuple):
    """A kind of file: how it is called, the file's name, its bytes, and the heights in it [m]."""

    about: str
    name: str
    content: bytes
    heights: np.ndarray
    digit: float = 1e-12
    way: str = AT_ONCE


Plain = tuple[np.ndarray, float]  # heights and pitch [m]


class Row(NamedTuple):
    """A row of the table; `wrong` says why the verdict is so."""

    about: str
    way: str
    numbers: str
    wrong: str = ""


def column(values: np.ndarray, scale: float = 1e6) -> str:
    """Write heights one below the other, in um."""
    return "\n".join(f"{scale * value:.4f}" for value in values) + "\n"


def texts() -> Iterable[Kind]:
    """Profiles as text."""
    rows = "".join(f"{n * 0.00025:.5f},{1e6 * z:.4f}\n" for n, z in enumerate(LINE))
    said = {
        "x and heights, units in brackets": f"X [mm],Z [um]\n{rows}",
        "x and heights, units in a separate line": f"Export\nX,Z\nmm,um\n{rows}",
        "a table of results before the profile": f"Name,Value\nRa,0.5\n\nX [mm],Z [um]\n{rows}",
        "three traces below each other": "\n".join(
            f"Trace {n}\nX [mm],Z [um]\n{rows}" for n in (1, 2, 3)
        ),
        "heights only, pitch and count above": "Spacing: 0.25 um\nPoints: 240\n"
        f"Z [um]\n{column(LINE)}",
        "heights only, traverse length and count above": "Traverse length: 0.06 mm\nNumber of "
        f"points: 240\nZ [um]\n{column(LINE)}",
        "heights with decimal commas, German names": "Messpunktabstand: 0,25 µm\nHöhe [µm]\n"
        + column(LINE).replace(".", ","),
    }
    for about, text in said.items():
        truth = np.stack([LINE] * 3) if "three" in about else LINE
        yield Kind(about, "line.txt", text.encode("latin-1"), truth, 1e-10, DRAFTED)
    head = "ISO 5436 - 2000 a\nPRF 1 ISO5436\nCX I 240 mm 1.0 D 2.5e-4\nCZ A 240 um 1.0 D\n\x03\n"
    smd = (head + column(LINE)).encode()
    yield Kind("SMD text (soft gauges)", "a.smd", smd, LINE, 1e-10)
    head = (
        "1 2\nA 0.0 PRF\nCX M 2.4e2 MM 1.0 D\nCZ M 2.4e2 UM 1.0e-4 L\nEOR\nSPACING CX 2.5e-4\nEOR\n"
    )
    counts = "".join(f"{round(1e10 * z)}\n" for z in LINE)
    yield Kind("PRF text (soft gauges)", "a.prf", (head + counts + "EOR\n").encode(), LINE, 1e-10)


def matrices() -> Iterable[Kind]:
    """Maps as text, as microscopes export them."""
    holes = AREA.copy()
    holes[2, 5] = holes[4, 8] = np.nan
    cells = [[f"{1e6 * z:.4f}" for z in row] for row in AREA]
    rows = "\n".join(",".join(row) for row in cells) + "\n"
    keyence = '"Model","VK-X"\n"Horizontal","12"\n"Vertical","7"\n"XY Calibration","250.0","nm"\n'
    text = f'{keyence}"Unit","um"\n\n"Height"\n{rows}'
    yield Kind("matrix below a header (Keyence)", "a.csv", text.encode(), AREA)
    cells = [[f"{1e6 * z:.4f}" if np.isfinite(z) else "NaN" for z in row] for row in holes]
    rows = "\n".join("\t".join(row) for row in cells) + "\n"
    text = f"Pixel Size X: 0.25 µm\nPixel Size Y: 0.25 µm\nZ unit: µm\n{rows}"
    yield Kind("matrix with missing heights (Alicona)", "a.txt", text.encode("latin-1"), holes)
    cells = [[f"{1e9 * z:.1f}" if np.isfinite(z) else "Bad" for z in row] for row in holes]
    rows = "\n".join(" ".join(row) for row in cells) + "\n"
    text = f"Field of view: 3.0 um x 1.75 um\nPixels: 12 x 7\nHeight unit: nm\n{rows}"
    yield Kind("matrix below its field of view (Bruker)", "a.txt", text.encode(), holes)


def described(
    data: str, kind: str = "D", feature: str = "SUR", size: tuple[int, int] = (12, 7)
) -> str:
    """Return the description of an x3p archive."""
    axes = "".join(
        f"<C{axis}><AxisType>{'A' if axis == 'Z' else 'I'}</AxisType><DataType>{kind}</DataType>"
        f"<Increment>{1 if axis == 'Z' else PITCH}</Increment></C{axis}>"
        for axis in "XYZ"
    )
    return (
        f"<ISO5436_2><Record1><FeatureType>{feature}</FeatureType><Axes>{axes}</Axes></Record1>"
        f"<Record3><MatrixDimension><SizeX>{size[0]}</SizeX><SizeY>{size[1]}</SizeY>"
        f"<SizeZ>1</SizeZ></MatrixDimension>{data}</Record3></ISO5436_2>"
    )


def archived(main: str, folder: str = "", **members: bytes) -> bytes:
    """Return an x3p archive."""
    with tempfile.TemporaryFile() as file:
        with zipfile.ZipFile(file, "w") as archive:
            archive.writestr(f"{folder}main.xml", main)
            for name, content in members.items():
                archive.writestr(f"{folder}bindata/{name}.bin", content)
        file.seek(0)
        return file.read()


def archives() -> Iterable[Kind]:
    """Maps and profiles as x3p and in its XML."""
    link = "<DataLink><PointDataLink>bindata/data.bin</PointDataLink>{}</DataLink>"
    raw = AREA.astype("<f8").tobytes()
    plain = described(link.format(""))
    yield Kind("x3p", "a.x3p", archived(plain, data=raw), AREA)
    yield Kind("x3p in a folder of the archive", "a.x3p", archived(plain, "scan/", data=raw), AREA)
    valid = np.ones(AREA.size, dtype=bool)
    valid[[17, 40]] = False
    mask = np.packbits(valid, bitorder="little").tobytes()
    masked = described(link.format("<ValidPointsLink>bindata/valid.bin</ValidPointsLink>"))
    holes = np.where(valid.reshape(AREA.shape), AREA, np.nan)
    yield Kind("x3p with a mask", "a.x3p", archived(masked, data=raw, valid=mask), holes)
    wide = np.pad(AREA, ((1, 2), (0, 3)), constant_values=np.nan).astype("<f8")
    main = described(link.format(""), size=wide.shape[::-1])
    yield Kind("x3p with a border without data", "a.x3p", archived(main, data=wide.tobytes()), AREA)
    listed = (
        "<DataList>" + "".join(f"<Datum>{float(z)!r}</Datum>" for z in AREA.flat) + "</DataList>"
    )
    yield Kind("x3p with heights as a list", "a.x3p", archived(described(listed)), AREA)
    yield Kind("bare XML of x3p", "a.xml", described(listed).encode(), AREA)
    main = described(link.format(""), feature="PRF", size=(LINE.size, 1))
    profile = LINE.astype("<f8").tobytes()
    yield Kind("x3p of a profile", "a.x3p", archived(main, data=profile), LINE)


def surf(packed: bool) -> bytes:
    """Return a Surf file with heights in tenths of nm, the units with a UTF-8 micro sign."""
    raw = np.rint(1e10 * AREA).astype("<i4").tobytes()
    units = b"".join(t.ljust(16, b"\0") for t in ("µm".encode(), "µm".encode(), b"nm") * 2)
    header = b"DSCOMPRESSED" if packed else b"DIGITAL SURF"
    header += struct.pack("<4h30s30s5h", 0, 1, 1, 2, b"", b"", 0, 0, 0, 0, 0)
    header += struct.pack("<f4xh5i3f", 0, 32, -20000, 20000, 12, 7, 84, 0.25, 0.25, 0.1)
    header += b"".join(name.ljust(16, b"\0") for name in (b"X", b"Y", b"Z")) + units
    header += struct.pack("<3f3h12x7h", 1, 1, 1, 0, 0, 0, 0, 0, 12, 1, 6, 2024, 0)
    if packed:
        done = zlib.compress(raw)
        raw = struct.pack("<3I", 1, len(raw), len(done)) + done
    return header.ljust(512, b"\0") + raw


def judge(kind: Kind, folder: Path) -> Row:
    """Write a file, read it, and compare what was read."""
    path = folder / kind.name
    path.write_bytes(kind.content)
    try:
        scan = tl.read_scans(path)
    except TribolabError as error:
        return Row(kind.about, REFUSED, "", str(error))
    way = DRAFTED if scan.attrs["instrument"] == "drafted from the file" else AT_ONCE
    heights = np.squeeze(scan.height.values)
    if heights.shape != kind.heights.shape:
        return Row(kind.about, way, "", f"{heights.shape} points, not {kind.heights.shape}")
    away = heights - kind.heights
    away -= 0.0 if kind.name != "a.sur" else np.nanmean(away)  # a constant is no topography
    off = float(np.nanmax(np.abs(away)))
    pitch = scan.attrs["pitch_m"] / PITCH - 1.0
    faults = []
    if (np.isnan(heights) != np.isnan(kind.heights)).any():
        faults.append("other points are missing")
    if off > kind.digit or abs(pitch) > 1e-6:
        faults.append(f"heights off by {off:.2g} m, pitch by {pitch:.2g}")
    if way != kind.way:
        faults.append(f"read {way}, not {kind.way}")
    return Row(kind.about, way, f"heights within {1e9 * off:.2g} nm", "; ".join(faults))


class Measured(NamedTuple):
    """A measured file, what its description says, and what it holds: points, pitch, rms [m]."""

    file: str
    about: str
    given: dict[str, str]
    points: int
    pitch: float
    rms: float
    refused: str = ""


def pairs(lines: Iterable[str], mark: str, scales: tuple[float, float]) -> Plain:
    """Take x and heights off the first two cells of lines."""
    cells = (line.split(mark)[:2] for line in lines if line.strip())
    x, heights = np.array([[float(cell) for cell in row] for row in cells]).T
    return heights * scales[1], float(scales[0] * (x[-1] - x[0]) / (x.size - 1))


def of_sdf(text: str) -> Plain:
    """Take heights off the second part of an SDF text: profiles one after the other."""
    head, body = text.split("*")[:2]
    said = dict(line.split(" = ") for line in head.splitlines() if " = " in line)
    return np.array(body.split(), float) * float(said["Zscale"]), float(said["Xscale"])


def of_workbook(path: Path) -> Plain:
    """Take the fifth and sixth column off a sheet, in mm and um."""
    import openpyxl

    sheet = openpyxl.load_workbook(path, read_only=True)["DATA"]
    rows = [row[4:6] for row in sheet.iter_rows(values_only=True)]
    filled = [row for row in rows if all(isinstance(cell, int | float) for cell in row)]
    return pairs((f"{x};{z}" for x, z in filled), ";", (1e-3, 1e-6))


def plain(path: Path) -> Plain:
    """Read heights and pitch of a measured file without any reader of scans."""
    if path.suffix == ".xlsx":
        return of_workbook(path)
    text = path.read_bytes().decode("latin-1").replace("\r\n", "\n").replace("\r", "\n")
    if path.name.startswith("dektak"):
        below = text.split("Scan Data\n")[1].split("\n")
        rows = [line for line in below[1:] if re.match(r"[-\d.]+,", line)]
        return pairs(rows, ",", (1e-6, 1e-6))
    if path.suffix == ".sdf":
        return of_sdf(text)
    if path.name.startswith("gwyddion"):
        rows = [line.split() for line in text.splitlines() if not line.startswith("#")]
        heights = np.array(rows, float)
        return heights, 12.34e-6 / heights.shape[1]
    if path.name == "test1.txt":  # a map, row by row; positions in mm
        x, _, heights = np.array([line.split(",") for line in text.split()], float).T
        return 1e-6 * heights, 1e-3 * float(np.median(np.diff(x)))
    return pairs(text.splitlines(), "\t", (1e-3, 1e-6))


MEASURED = (
    Measured(
        "bearing_profiles_MIT/NU206-RE-1.txt",
        "roller profile, CR ends",
        {},
        7952,
        1.24008e-6,
        1.05549e-5,
    ),
    Measured(
        "bearing_profiles_MIT/NU208-IR-1.txt",
        "roller profile, CR LF",
        {},
        8064,
        1.61210e-6,
        2.10651e-5,
    ),
    Measured("surfacetopography_MIT/dektak-1.csv", "Dektak csv", {}, 9600, 1.56250e-7, 4.76423e-6),
    Measured(
        "surfacetopography_MIT/mitutoyo_2_mock.xlsx",
        "Mitutoyo workbook",
        {},
        6664,
        1.5e-6,
        3.96890e-6,
    ),
    Measured(
        "surfacetopography_MIT/mitutoyo_mock.xlsx", "Mitutoyo workbook", {}, 960, 5e-7, 1.68663e-7
    ),
    Measured("surfacetopography_MIT/sdf-1.sdf", "SDF text", {}, 28, 1e-6, 1.36029e-8),
    Measured(
        "surfacetopography_MIT/gwyddion-export-german.txt",
        "Gwyddion text, German",
        {},
        12,
        4.11333e-6,
        4.70575,
    ),
    Measured(
        "nanovea_map_MIT/test1.txt",
        "x, y, z without names",
        {"instrument": "nanovea_map"},
        10201,
        5e-6,
        2.25427e-5,
    ),
    Measured("nanovea_map_MIT/test1.txt", "x, y, z, no header", {}, 0, 0.0, 0.0, "states no units"),
    Measured(
        "surfacetopography_MIT/xy-4.txt", "x, z, no header", {}, 0, 0.0, 0.0, "states no units"
    ),
    Measured(
        "mitutoyo_sj410_res_MIT/12A11003.TXT",
        "results without a profile",
        {},
        0,
        0.0,
        0.0,
        "no profile",
    ),
)


def of_measured(known: Measured) -> Row:
    """Judge one measured file."""
    about = f"{known.about} (`{Path(known.file).name}`)"
    try:
        scan = tl.read_scans(SHARED / known.file, **known.given)
    except TribolabError as error:
        told = known.refused and known.refused in str(error)
        return Row(about, REFUSED, known.refused, "" if told else str(error))
    way = DESCRIBED if known.given else AT_ONCE
    if known.refused:
        return Row(about, way, "", "it was to be refused")
    heights = scan.height.values
    faults, told = [], f"{heights.size} points"
    if heights.size != known.points:
        faults.append(f"{heights.size} points, not {known.points}")
    if known.rms:
        own, pitch = plain(SHARED / known.file)
        if own.size != heights.size or abs(float(np.std(own)) / known.rms - 1) > 1e-5:
            faults.append(f"plainly read {own.size} points, rms height {np.std(own):.6g} m")
        elif own.size == heights.size:
            off = float(np.nanmax(np.abs(own.ravel() - heights.ravel())))
            told += f", heights within {1e9 * off:.2g} nm"
            if not off <= 1e-9 * known.rms:
                faults.append(f"heights {off:.3g} m off those that are plainly read")
        if abs(pitch / known.pitch - 1) > 1e-3:  # rounded positions
            faults.append(f"plainly read pitch {pitch:.6g} m")
    if known.rms and abs(float(np.nanstd(heights)) / known.rms - 1) > 1e-5:
        faults.append(f"rms height {float(np.nanstd(heights)):.6g} m, not {known.rms:.6g}")
    if known.pitch and abs(scan.attrs["pitch_m"] / known.pitch - 1) > 1e-5:
        faults.append(f"pitch {scan.attrs['pitch_m']:.6g} m, not {known.pitch:.6g}")
    return Row(about, way, told, "; ".join(faults))


def rows() -> list[Row]:
    """Judge all kinds and all measured files that are there."""
    surfs = (
        Kind(f"Surf file of Digital Surf, {word}", "a.sur", surf(packed), AREA, 1e-10)
        for word, packed in (("plain", False), ("packed", True))
    )
    with tempfile.TemporaryDirectory() as folder:
        done = [judge(kind, Path(folder)) for kind in (*texts(), *matrices(), *archives(), *surfs)]
    return done + [of_measured(known) for known in MEASURED if (SHARED / known.file).is_file()]


def table(lines: list[Row]) -> str:
    """Return the rows as Markdown."""
    head = ["| file | read | numbers |", "| --- | --- | --- |"]
    told = [f"WRONG: {row.wrong}" if row.wrong else row.numbers for row in lines]
    body = [f"| {row.about} | {row.way} | {word} |" for row, word in zip(lines, told, strict=True)]
    return "\n".join([*head, *body])


PAGE = """# Files of profiles and maps

Generated by `tests/robustness/scan_kinds.py` from synthetic files with known heights, and from
measured files. *Directly*: `tl.read_scans(file)` reads the file. *By its header*: the file is an
unknown text file whose header states everything. *With a dialect*: you must name a dialect
(`instrument=`). *Refused*: the message names what is missing. Independent code reads the reference
heights and the pitch of the measured profiles.

{table}

The library SurfaceTopography (tested: 1.27.1) reads the formats of some forty profilometers.
tribolab itself reads files that SurfaceTopography does not read, or reads only in part:

- x3p files of other revisions, of profiles, with `main.xml` in a folder, with positions for each
  point, or with heights as a list;
- Surf files that are packed or contain a UTF-8 micro sign;
- SMD and PRF text, and matrices of heights as text.

Neither SurfaceTopography nor surfalize ships sample files. We read files written by surfalize 0.19.
AL3D, SDF (text and binary) and x3p agree to the last digit. Surf files agree except for a constant
that surfalize adds. TMD files differ by a factor of 1000, because surfalize writes micrometres
where the format requires millimetres.

We had no SMD or PRF files of national laboratories; their layouts are from published descriptions
and examples. We know x3p files from manufacturers only through these two libraries.
"""


def main() -> int:
    """Print the table; the exit code says whether all is right."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", type=Path, help="the page to write")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    lines = rows()
    print(table(lines))
    if options.write:
        options.write.write_text(PAGE.format(table=table(lines)), encoding="utf-8")
    wrong = sum(bool(row.wrong) for row in lines)
    print(f"{wrong} of {len(lines)} kinds are wrong" if wrong else "all are right")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
