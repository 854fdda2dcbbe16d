"""Small files that unpack to all of memory, name more objects than can be read, or never end."""

from __future__ import annotations

import gzip
import io
import json
import struct
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from hostile.base import FORCE, TRIBOLAB, USAGE, Command, case, notebook, wrong_campaign

_MILLION = 1_000_000
Maker = Callable[[Path], None]


def _repeated(write: Callable[[bytes], Any], piece: bytes, megabytes: int) -> None:
    block = piece * (_MILLION // len(piece))
    for _ in range(megabytes):
        write(block)


def _gzip(piece: bytes, megabytes: int, head: str = "") -> Maker:
    def make(path: Path) -> None:
        with gzip.open(path, "wb", 1) as file:
            file.write(head.encode())
            _repeated(file.write, piece, megabytes)

    return make


def _zip(members: dict[str, tuple[str, bytes, int]]) -> Maker:
    """Pack members: a head, and a piece repeated over so many megabytes."""

    def make(path: Path) -> None:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
            for name, (head, piece, megabytes) in members.items():
                with archive.open(name, "w", force_zip64=True) as file:
                    file.write(head.encode())
                    _repeated(file.write, piece, megabytes)

    return make


def _parquet(rows: int, columns: int, compression: str, feather: bool = False) -> Maker:
    def make(path: Path) -> None:
        import pyarrow as pa
        from pyarrow import feather as fe
        from pyarrow import parquet as pq

        names = ["Time [s]", "Fx [N]", "Fz [N]", *(f"c{n}" for n in range(columns - 3))]
        table = pa.table(dict.fromkeys(names, pa.array(np.zeros(rows))))
        if feather:
            fe.write_feather(table, path, compression=compression)
        else:
            pq.write_table(table, path, compression=compression)

    return make


def _long_texts(path: Path) -> None:
    """One text of 10 MB, which each of 10 000 rows repeats by its number."""
    import pyarrow as pa
    from pyarrow import parquet as pq

    words = pa.DictionaryArray.from_arrays(np.zeros(10_000, "i4"), ["x" * 10 * _MILLION])
    pq.write_table(pa.table({"Time [s]": np.arange(1e4), "Fx [N]": words}), path)


def _mat(megabytes: int, variables: int = 1) -> Maker:
    def make(path: Path) -> None:
        head = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
        size = megabytes * _MILLION // 8
        parts = struct.pack("<IIII", 6, 8, 6, 0) + struct.pack("<IIii", 5, 8, size, 1)
        parts += struct.pack("<II8s", 1, 1, b"F") + struct.pack("<II", 9, 8 * size)
        packer = zlib.compressobj()
        begin = struct.pack("<II", 14, len(parts) + 8 * size) + parts
        packed = packer.compress(begin) + packer.flush(zlib.Z_FULL_FLUSH)
        zeros = zlib.compressobj(wbits=-15)  # one megabyte, which stands there again and again
        packed += megabytes * (zeros.compress(bytes(_MILLION)) + zeros.flush(zlib.Z_FULL_FLUSH))
        high, low = divmod(zlib.adler32(begin), 1 << 16)
        check = (high + megabytes * _MILLION * low) % 65521 << 16 | low
        packed += b"\x03\x00" + struct.pack(">I", check)  # an empty last block
        element = struct.pack("<II", 15, len(packed)) + packed
        path.write_bytes(head + element * variables)

    return make


def _hdf5(fill: Callable[[Any], None]) -> Maker:
    def make(path: Path) -> None:
        import h5py

        with h5py.File(path, "w", libver="latest") as file:  # quick to write
            file["Time [s]"] = np.arange(100.0)
            file["Fx [N]"] = np.ones(100)
            fill(file)

    return make


def _attributes(file: Any) -> None:
    for number in range(30_000):
        file.attrs[f"a{number}"] = number


def _datasets(count: int) -> Callable[[Any], None]:
    def fill(file: Any) -> None:
        for number in range(count):
            file[f"d{number}"] = np.zeros(2)

    return fill


def _groups(file: Any) -> None:
    for number in range(30_000):
        file.create_group(f"g{number}")


def _zeros(rows: int) -> Callable[[Any], None]:
    def fill(file: Any) -> None:
        many = file.create_dataset("Fz [N]", (rows,), "f8", chunks=(_MILLION,), compression=9)
        for chunk in range(10):
            many[chunk * _MILLION : (chunk + 1) * _MILLION] = 0.0

    return fill


def _fields(file: Any) -> None:
    file["t"] = np.zeros(10, dtype=[(f"c{n}", "f8") for n in range(1500)])


def _netcdf(variables: int = 0, rows: int = 10) -> Maker:
    def make(path: Path) -> None:
        import netCDF4

        with netCDF4.Dataset(path, "w") as data:
            data.createDimension("time", rows)
            packing = {"zlib": True, "chunksizes": (min(rows, _MILLION),)}
            for name in ("time", "friction_force", *(f"v{n}" for n in range(variables))):
                data.createVariable(name, "f8", ("time",), **packing)

    return make


def _classic(path: Path) -> None:
    from scipy.io import netcdf_file

    with netcdf_file(path, "w") as data:
        data.createDimension("time", 10)
        for number in range(30_000):
            data.createVariable(f"v{number}", "f8", ("time",))


def _npz(path: Path) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive:
        head = io.BytesIO()
        shape = {"descr": "<f8", "fortran_order": False, "shape": (100 * _MILLION,)}
        np.lib.format.write_array_header_1_0(head, shape)
        for name in ("time.npy", "Fx.npy"):
            with archive.open(name, "w", force_zip64=True) as file:
                file.write(head.getvalue())
                _repeated(file.write, b"\0", 800)


_NS = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_RELATIONS = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006/relationships"


def _xlsx(piece: str, megabytes: int, sheets: int = 1, dimension: str = "") -> Maker:
    """Write a workbook whose sheets repeat rows, or cells of one row."""

    def make(path: Path) -> None:
        numbers = range(1, sheets + 1)
        inside = f'<worksheet xmlns="{_NS}">{dimension}<sheetData>'
        listed = "".join(f'<sheet name="s{n}" sheetId="{n}" r:id="r{n}"/>' for n in numbers)
        targets = "".join(
            f'<Relationship Id="r{n}" Type="{_RELATIONS}/worksheet" Target="s.xml"/>'
            for n in numbers
        )
        _zip(
            {
                "[Content_Types].xml": ('<Types xmlns="x"/>', b" ", 0),
                "_rels/.rels": (
                    f'<Relationships xmlns="{_PACKAGE}"><Relationship Id="a" Type="{_RELATIONS}'
                    '/officeDocument" Target="xl/workbook.xml"/></Relationships>',
                    *(b" ", 0),
                ),
                "xl/workbook.xml": (
                    f'<workbook xmlns="{_NS}" xmlns:r="{_RELATIONS}"><sheets>{listed}</sheets>'
                    "</workbook>",
                    *(b" ", 0),
                ),
                "xl/_rels/workbook.xml.rels": (
                    f'<Relationships xmlns="{_PACKAGE}">{targets}</Relationships>',
                    *(b" ", 0),
                ),
                "xl/s.xml": (inside, piece.encode(), megabytes),
            }
        )(path)

    return make


def _tdms(channels: int, repeats: int = 1) -> Maker:
    def make(path: Path) -> None:
        from nptdms import ChannelObject, TdmsWriter

        with TdmsWriter(path) as file:
            for _ in range(repeats):
                file.write_segment(
                    [ChannelObject("g", f"c{n}", np.zeros(2)) for n in range(channels)]
                )

    return make


def _text(head: str, piece: str, megabytes: int, tail: str = "") -> Maker:
    def make(path: Path) -> None:
        with path.open("wb") as file:
            file.write(head.encode())
            _repeated(file.write, piece.encode(), megabytes)
            file.write(tail.encode())

    return make


def _wide(columns: int, head: bool = True, rows: int = 20) -> Maker:
    def make(path: Path) -> None:
        names = ["Time [s]", "Fx [N]", *(f"c{n} [V]" for n in range(columns - 2))]
        cells = [[f"{(7 * r + 13 * c) % 97 / 9:.2f}" for c in range(columns)] for r in range(rows)]
        lines = [",".join(row) for row in ([names] if head else []) + cells]
        path.write_text("\n".join(lines) + "\n")

    return make


def _json(make_text: Callable[[], str]) -> Maker:
    return lambda path: path.write_text(make_text()) and None


_LAUGHS = (
    '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY x0 "ha">'
    + "".join(f'<!ENTITY x{n} "{f"&x{n - 1};" * 10}">' for n in range(1, 12))
    + ']><?mso-application progid="Excel.Sheet"?><Workbook xmlns="urn:schemas-microsoft-com:office:'
    'spreadsheet"><Worksheet><Table><Row><Cell><Data>&x11;</Data></Cell></Row></Table></Worksheet>'
    "</Workbook>"
)
BOMBS: dict[str, Maker] = {
    "a.csv.gz: zeros": _gzip(b"0\n", 2000),
    "b.csv.gz: 60 MB of rows": _gzip(b"0.1,0.5,31.0\n", 60, FORCE),
    "c.csv.gz: 60 MB of one line": _gzip(b"1.5,", 60, FORCE),
    "d.csv.gz: 60 MB of line ends": _gzip(b"\n", 60, FORCE),
    "e.csv.gz: 60 MB of letters": _gzip(b"x", 60),
    "f.csv.gz: 60 MB of short lines": _gzip(b"0\n", 60),
    "a.zip: a long table": _zip({"a.csv": (FORCE, b"0.1,0.5,31.0\n", 2000)}),
    "b.zip: 60 MB of a table": _zip({"a.csv": (FORCE, b"0.1,0.5,31.0\n", 60)}),
    "c.zip: 60 MB of letters": _zip({"a.csv": ("", b"x", 60)}),
    "d.zip: 10 000 members": _zip({f"a{n}.csv": (FORCE, b"1", 0) for n in range(10_000)}),
    "a.parquet: 1e8 zeros": _parquet(50 * _MILLION, 4, "zstd"),
    "b.parquet: 10 000 columns": _parquet(2, 10_000, "zstd"),
    "c.parquet: long texts": _long_texts,
    "d.parquet: 1e7 rows": _parquet(10 * _MILLION, 3, "snappy"),
    "a.feather: 2e8 zeros": _parquet(50 * _MILLION, 4, "zstd", feather=True),
    "a.mat: 2 GB": _mat(2000),
    "b.mat: 200 MB": _mat(200),
    "c.mat: 60 MB 20 times": _mat(60, 20),
    "d.mat: 2000 variables of 1 MB": _mat(1, 2000),
    "a.h5: 30 000 attributes": _hdf5(_attributes),
    "b.h5: 30 000 datasets": _hdf5(_datasets(30_000)),
    "c.h5: 9900 datasets": _hdf5(_datasets(9900)),
    "d.h5: 30 000 groups": _hdf5(_groups),
    "e.h5: 1e11 zeros": _hdf5(_zeros(10**11)),
    "f.h5: 1e8 zeros": _hdf5(_zeros(10**8)),
    "g.h5: 1500 fields": _hdf5(_fields),
    "a.nc: 9000 variables": _netcdf(9000),
    "b.nc: 1e10 rows": _netcdf(rows=10**10),
    "c.nc: 1e8 rows": _netcdf(rows=10**8),
    "d.nc: 30 000 variables, classic": _classic,
    "a.npz: 1.6 GB": _npz,
    "a.xlsx: 1 GB of rows": _xlsx("<row><c><v>1</v></c></row>", 1000),
    "b.xlsx: 60 MB of rows": _xlsx("<row><c><v>1</v></c><c><v>2</v></c></row>", 60),
    "c.xlsx: 60 MB of cells": _xlsx("<c><v>1</v></c>", 60),
    "d.xlsx: 5000 sheets": _xlsx("<row><c><v>1</v></c></row>", 1, 5000),
    "e.xlsx: a forged dimension": _xlsx(
        "<row><c><v>1</v></c></row>", 1, dimension='<dimension ref="A1:XFD1048576"/>'
    ),
    "a.xls: entities within entities": _json(lambda: _LAUGHS),
    "b.xls: 40 MB of rows": _text(
        '<?xml version="1.0"?><?mso-application progid="Excel.Sheet"?><Workbook xmlns='
        '"urn:schemas-microsoft-com:office:spreadsheet"><Worksheet><Table>',
        *("<Row><Cell><Data>1</Data></Cell></Row>", 40, "</Table></Worksheet></Workbook>"),
    ),
    "a.tdms: 6000 channels": _tdms(6000),
    "b.tdms: 5000 segments": _tdms(2, 5000),
    "a.x3p: 1 GB": _zip({"main.xml": ("<p>", b"<a/>", 1), "bindata/data.bin": ("", b"\0", 1000)}),
    "a.txt: 100 000 columns": _wide(100_000),
    "b.txt: 100 000 columns without names": _wide(100_000, head=False),
    "c.txt: 20 000 columns": _wide(20_000, rows=100),
    "d.txt: 40 MB of settings": _text("", "Load: 31 N\n", 40),
    "e.txt: 40 MB of words, then a table": _text("", "Load of the ball on the plate\n", 40),
    "a.json: 100 000 deep": _json(lambda: "[" * 100_000 + "]" * 100_000),
    "b.json: 1e6 keys": _json(lambda: json.dumps({f"k{n}": n for n in range(_MILLION)})),
    "c.json: 40 MB of pairs": _json(lambda: json.dumps({"Fx": [[1, 2]] * 5 * _MILLION})),
}  # fmt: skip

for _name, _make in BOMBS.items():
    for _command in ("info", "check", "dialect", "read_scans"):

        @case(
            f"bombs 4: {_command}, {_name}",
            *(_command, _name.split(":")[0], _make),
            codes=(0, 1, 3),
            large=True,
        )
        def _(folder: Path, command: str, name: str, make: Maker) -> Command:
            make(folder / name)
            if command == "read_scans":
                return notebook(f"tl.read_scans({name!r}, x_unit='mm', height_unit='um')")
            return [*TRIBOLAB, command, name]


for _what, _more in {
    "100 000 keys": "".join(f"k{n} = 1\n" for n in range(100_000)),
    "100 000 known keys": "[[run]]\n" + "".join(f'"k{n}" = "a"\n' for n in range(100_000)),
    "150 000 runs": '[[run]]\nfiles = "a.csv"\n' * 150_000,
    "150 000 runs in a list": "",
    "5000 runs": '[[run]]\nfiles = "a.csv"\n' * 5000,
    "100 000 files of a run": "[[run]]\nfiles = [" + '"a.csv",' * 100_000 + "]\n",
    "100 000 media": "".join(f"[medium.m{n}]\nviscosity = '1 Pa s'\n" for n in range(100_000)),
    "a text of 40 MB": "[[run]]\nnote = '" + "x" * 40 * _MILLION + "'\n",
    "40 MB of comments": "# a\n" * 10 * _MILLION,
}.items():

    @case(f"bombs 4: a campaign of {_what}", _what, _more, codes=(USAGE, 3), says="campaign.toml")
    def _(folder: Path, what: str, more: str) -> Command:
        if "list" in what:
            runs = "run = [" + "{files = 'a.csv'}," * 150_000 + "]\n"
            return wrong_campaign(folder, {"[campaign]\n": f"{runs}[campaign]\n"})
        return wrong_campaign(folder, {}, more)
