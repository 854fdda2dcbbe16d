"""Scans in formats that are read here: x3p of all makers, bare XML, soft gauges, packed Surf."""

import struct
import warnings
import zipfile
import zlib

import numpy as np
import pytest

from tribolab.app.info.file_info import read_scan
from tribolab.core.errors import ReadError
from tribolab.reading.scan_files import read_scans

HEIGHTS = np.random.default_rng(5).normal(0, 1e-6, (7, 12))
HOLES = np.zeros(HEIGHTS.shape, bool)
HOLES[3, 4] = HOLES[2, 9] = True

MAIN = """<?xml version="1.0" encoding="UTF-8"?>
<{p}ISO5436_2 xmlns{n}="http://www.opengps.eu/2008/ISO5436_2"><Record1>
<Revision>{revision}</Revision><FeatureType>{feature}</FeatureType><Axes>
<CX><AxisType>{x_type}</AxisType><DataType>{x_data}</DataType><Increment>1e-6</Increment></CX>
<CY><AxisType>I</AxisType><DataType>D</DataType><Increment>2e-6</Increment></CY>
<CZ><AxisType>A</AxisType><DataType>{z_data}</DataType>{z_scale}</CZ></Axes></Record1>
<Record2><Date>2024-05-06T07:08:09</Date><Instrument><Manufacturer>Maker</Manufacturer>
<Model>unknown</Model></Instrument></Record2>
<Record3><MatrixDimension><SizeX>{nx}</SizeX><SizeY>{ny}</SizeY><SizeZ>1</SizeZ>
</MatrixDimension>{data}</Record3></{p}ISO5436_2>"""


def described(data, **changes):
    ny, nx = HEIGHTS.shape
    said = {
        "p": "p:", "n": ":p", "revision": "ISO5436 - 2000", "feature": "SUR", "x_type": "I",
        "x_data": "D", "z_data": "D", "z_scale": "", "nx": nx, "ny": ny,
    }  # fmt: skip
    return MAIN.format(data=data, **{**said, **changes}).encode()


def archive(path, main, folder="", **members):
    with zipfile.ZipFile(path, "w") as file:
        file.writestr(f"{folder}main.xml", main)
        for name, content in members.items():
            file.writestr(f"{folder}bindata/{name}.bin", content)
    return path


def link(valid=False):
    mask = "<ValidPointsLink>bindata/valid.bin</ValidPointsLink>" if valid else ""
    return f"<DataLink><PointDataLink>bindata/data.bin</PointDataLink>{mask}</DataLink>"


@pytest.mark.parametrize("kind", "DFLI")
def test_x3p_of_another_writer(tmp_path, kind):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        from SurfaceTopography import Topography
    written = np.ma.array(HEIGHTS.T, mask=HOLES.T)
    path = tmp_path / "map.x3p"
    Topography(written, (12e-6, 14e-6), unit="m").to_x3p(str(path), dtype=kind)
    scan = read_scans(path)
    digit = {"D": 1e-18, "F": 1e-12, "L": 2e-15, "I": 1e-10}[kind]
    np.testing.assert_allclose(scan.height, np.where(HOLES, np.nan, HEIGHTS), rtol=0, atol=digit)
    np.testing.assert_allclose([scan.x[1], scan.y[1]], [1e-6, 2e-6])
    assert scan.attrs["instrument_vendor"] == "SurfaceTopography"


@pytest.mark.parametrize("folder", ["", "scan 1/", "a/b/"])
@pytest.mark.parametrize("byte_each", [False, True])
def test_x3p_in_a_folder_of_any_revision_with_a_mask_of_bits_or_bytes(tmp_path, folder, byte_each):
    valid = ~HOLES.ravel()
    mask = valid.astype("u1").tobytes()
    if not byte_each:
        mask = np.packbits(valid, bitorder="little").tobytes()
    main = described(link(valid=True), revision="ISO25178-72:2017")
    path = archive(tmp_path / "m.x3p", main, folder, data=HEIGHTS.tobytes(), valid=mask)
    scan = read_scans(path)
    np.testing.assert_array_equal(scan.height, np.where(HOLES, np.nan, HEIGHTS))
    assert scan.attrs["recorded_at"] == "2024-05-06T07:08:09"
    assert "instrument_name" not in scan.attrs  # "unknown" is no name


def test_x3p_of_whole_numbers_with_increment_and_offset(tmp_path):
    raw = np.arange(84, dtype="<i2").reshape(7, 12)
    scale = "<Increment>1e-9</Increment><Offset>5e-6</Offset>"
    main = described(link(), z_data="I", z_scale=scale)
    scan = read_scans(archive(tmp_path / "m.x3p", main, data=raw.tobytes()))
    np.testing.assert_allclose(scan.height, 5e-6 + 1e-9 * raw, rtol=1e-12)


@pytest.mark.parametrize("bare", [False, True])
def test_lists_of_heights_in_the_xml_as_archive_and_alone(tmp_path, bare):
    cells = [
        "" if hole else repr(float(z)) for z, hole in zip(HEIGHTS.flat, HOLES.flat, strict=True)
    ]
    data = "<DataList>" + "".join(f"<Datum>{c}</Datum>" for c in cells) + "</DataList>"
    main = described(data, p="", n="")
    path = tmp_path / ("map.xml" if bare else "map.x3p")
    path.write_bytes(main) if bare else archive(path, main)
    scan = read_scans(path)
    np.testing.assert_array_equal(scan.height, np.where(HOLES, np.nan, HEIGHTS))


def test_a_profile_with_positions_of_its_own(tmp_path):
    z = HEIGHTS.ravel()
    x = 0.3 * np.arange(z.size)  # in units of the axis's increment, 1 um
    cells = "".join(
        f"<Datum>{a!r};{b!r}</Datum>" for a, b in zip(x.tolist(), z.tolist(), strict=True)
    )
    main = described(f"<DataList>{cells}</DataList>", feature="PRF", x_type="A", nx=z.size, ny=1)
    scan = read_scans(archive(tmp_path / "p.x3p", main))
    assert dict(scan.sizes) == {"scan": 1, "x": z.size}
    assert scan.attrs["pitch_m"] == pytest.approx(3e-7)
    record = np.empty(z.size, [("x", "<f8"), ("z", "<f8")])
    record["x"], record["z"] = x, z
    main = described(link(), feature="PRF", x_type="A", nx=z.size, ny=1)
    same = read_scans(archive(tmp_path / "b.x3p", main, data=record.tobytes()))
    np.testing.assert_array_equal(same.height, scan.height)


def test_border_without_data_is_cut_off(tmp_path):
    bare = np.pad(HEIGHTS, ((2, 1), (0, 3)), constant_values=np.nan)
    main = described(link(), nx=15, ny=10)
    scan = read_scans(archive(tmp_path / "m.x3p", main, data=bare.tobytes()))
    np.testing.assert_array_equal(scan.height, HEIGHTS)
    assert scan.attrs["cropped"] == (
        "3 rows and 3 columns at the border without a height were cut off"
    )
    assert float(scan.x[0]) == float(scan.y[0]) == 0.0
    assert scan.attrs["length_m"] == pytest.approx(11e-6)


def test_damaged_archives_say_so(tmp_path):
    short = archive(tmp_path / "s.x3p", described(link()), data=HEIGHTS.tobytes()[:-8])
    with pytest.raises(ReadError, match="83 points, but says that they are 84"):
        read_scans(short)
    with pytest.raises(ReadError, match="damaged"):
        read_scans(archive(tmp_path / "n.x3p", described(link())))
    with pytest.raises(ReadError, match="no heights"):
        read_scans(archive(tmp_path / "e.x3p", described("")))


LIST = (
    "<DataList>"
    + "".join(f"<Datum>{z!r}</Datum>" for z in HEIGHTS.ravel().tolist())
    + "</DataList>"
)
DTD = (
    "<!ELEMENT p:ISO5436_2 ANY>\n<!ELEMENT Datum (#PCDATA)>\n"
    "<!ATTLIST p:ISO5436_2 xmlns:p CDATA #IMPLIED>\n<!-- ISO 25178-72 -->\n"
)


def with_dtd(declarations, used="", outside=""):
    head, root = described(LIST).decode().split("\n", 1)
    text = f"{head}\n<!DOCTYPE p:ISO5436_2 {outside}[\n{declarations}]>\n{root}"
    return text.replace("Maker", f"Maker{used}").encode()


@pytest.mark.parametrize("inside", [True, False])
@pytest.mark.parametrize(
    ("declarations", "used"),
    [
        (DTD, ""),
        (DTD + '<!ENTITY mu "&#181;">\n', "&mu;"),
        (DTD + '<!ENTITY % kind "CDATA">\n', ""),
    ],
)
def test_a_soft_gauge_with_an_internal_dtd_is_read(tmp_path, inside, declarations, used):
    path, text = tmp_path / "gauge.x3p", with_dtd(DTD + declarations, used)
    if inside:
        archive(path, text)
    else:
        path = tmp_path / "gauge.xml"
        path.write_bytes(text)
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height, HEIGHTS, rtol=1e-12)
    assert scan.attrs["instrument_vendor"] == ("Maker\u00b5" if used else "Maker")


LAUGHS = '<!ENTITY e0 "ha">' + "".join(
    f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 10)
)
HARMFUL = {
    "outside": ('<!ENTITY e9 SYSTEM "file:///etc/hostname">', "from outside the file"),
    "laughs": (LAUGHS, "that expands to more"),
    "long": (f'<!ENTITY e9 "{"ha" * 5000}">', "that expands to more"),
    "attribute": (f'<!ATTLIST Datum a CDATA "{"ha" * 5000}">', "that each element takes"),
    "parameter": ('<!ENTITY % e9 SYSTEM "file:///etc/hostname"> %e9;', "from outside the file"),
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize("harm", HARMFUL)
def test_xml_with_entities_that_take_in_files_or_expand_is_refused(tmp_path, harm, encoding):
    declarations, says = HARMFUL[harm]
    text = with_dtd(
        DTD + declarations, "" if harm in ("parameter", "attribute") else "&e9;"
    ).decode()
    if encoding == "utf-16":
        text = text.replace("UTF-8", "UTF-16")
    path = archive(tmp_path / "gauge.x3p", text.encode(encoding))
    with pytest.raises(ReadError, match=says) as refused:
        read_scans(path)
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 400


def test_the_dtd_of_another_file_is_not_opened(tmp_path):
    text = with_dtd(DTD, outside='SYSTEM "file:///etc/hostname" ')
    scan = read_scans(archive(tmp_path / "gauge.x3p", text))
    np.testing.assert_allclose(scan.height, HEIGHTS, rtol=1e-12)


def test_a_map_longer_than_any_instrument_is_refused(tmp_path):
    main = described(link()).replace(b"<Increment>1e-6", b"<Increment>14.47")
    path = archive(tmp_path / "m.x3p", main, data=HEIGHTS.tobytes())
    with pytest.raises(ReadError, match=r"159\.2 m long along x"):
        read_scans(path)


VALUES = np.round(np.sin(np.arange(40) / 5.0), 6)


SMD = (
    "ISO 5436 - 2000 ground01\r\nPRF 1 ISO5436\r\nCX I 40 mm 1.0e0 D 2.5e-4\r\n"
    "CZ A 40 um 1.0e0 D\r\n\x03\r\nDATE 25-Nov-2004\r\nPROFILE_FILTER Gaussian LS 0.0 LC 0.8\r\n"
    "\x03\r\n{}\r\n\x03\r\n12345\r\n\x03\x1a"
)
PRF = (
    "1 2\nSG2004 0.000000e+000 PRF\nCX M 4.000000e+001 MM 1.000000e+000 D\n"
    "CZ M 4.000000e+001 UM 1.000000e-006 L\nEOR\nSTYLUS_RADIUS 2.000000e+000 UM\n"
    "SPACING CX 2.500000e-004\nCOMMENT none\nEOR\n{}\nEOR\nEOF\n"
)


@pytest.mark.parametrize(("form", "scale"), [(SMD, 1), (PRF, 1000000)])
def test_soft_gauges_as_text(tmp_path, form, scale):
    path = tmp_path / "gauge.txt"
    numbers = VALUES if scale == 1 else np.rint(scale * VALUES).astype(int)
    path.write_bytes(form.format("\n".join(map(str, numbers))).encode())
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height[0], 1e-6 * VALUES, rtol=0, atol=1e-15)
    assert scan.attrs["pitch_m"] == pytest.approx(0.25e-6)
    assert scan.attrs.get("tip_radius_m") == (None if scale == 1 else pytest.approx(2e-6))
    path.write_bytes(form.format("\n".join(map(str, numbers[:30]))).encode())
    with pytest.raises(ReadError, match="30 heights are in the file"):
        read_scans(path)


def surf(packed, unit, ny=7):
    """Write a Surf file of 12 x ny points, 1 and 2 um apart, heights in nm."""
    raw = np.arange(12 * ny, dtype="<i4")
    units = b"".join(text.ljust(16, b"\0") for text in (unit, unit, b"nm") * 2)
    header = b"DSCOMPRESSED" if packed else b"DIGITAL SURF"
    header += struct.pack("<4h30s30s5h", 0, 1, 1, 2, b"", b"", 0, 0, 0, 0, 0)
    header += struct.pack("<f4xh5i3f", 0, 32, 0, 100, 12, ny, 12 * ny, 1, 2, 1)
    header += b"".join(name.ljust(16, b"\0") for name in (b"X", b"Y", b"Z")) + units
    header += struct.pack("<3f3h12x7hfI6x2h", 1, 1, 1, 0, 0, 0, 0, 0, 12, 1, 6, 2024, 0, 0, 0, 0, 0)
    body = raw.tobytes()
    if packed:
        halves = [body[:160], body[160:]]
        done = [zlib.compress(half) for half in halves]
        sizes = [(len(half), len(part)) for half, part in zip(halves, done, strict=True)]
        body = struct.pack("<5I", 2, *sizes[0], *sizes[1]) + b"".join(done)
    return header.ljust(512, b"\0") + body


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("unit", ["µm".encode(), "µm".encode("latin-1"), b"um"])
def test_surf_files_packed_or_not_with_any_micro(tmp_path, packed, unit):
    path = tmp_path / "map.sur"
    path.write_bytes(surf(packed, unit))
    scan = read_scans(path)
    assert dict(scan.sizes) == {"y": 7, "x": 12}
    np.testing.assert_allclose([scan.x[1], scan.y[1]], [1e-6, 2e-6], rtol=1e-6)
    np.testing.assert_allclose(np.diff(scan.height), 1e-9, rtol=1e-6)
    path.write_bytes(surf(packed, unit)[:-40])
    with pytest.raises(ReadError, match=r"damaged|cannot read"):
        read_scans(path)


def test_a_surf_file_of_one_line_is_a_profile(tmp_path):
    path = tmp_path / "profile.sur"
    path.write_bytes(surf(True, b"um", ny=1))
    assert dict(read_scans(path).sizes) == {"scan": 1, "x": 12}


@pytest.mark.parametrize("mark", ["ISO", "BCR"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_sdf_of_the_standard_and_of_its_draft(tmp_path, mark, end):
    counts = np.rint(HEIGHTS / 1e-10).astype(int)
    head = {
        "ManufacID": "MAKER", "CreateDate": "010220231200", "ModDate": "010220231200",
        "NumPoints": 12, "NumProfiles": 7, "Xscale": "1e-6", "Yscale": "1e-6", "Zscale": "1e-10",
        "Zresolution": -1, "Compression": 0, "DataType": 6, "CheckType": 0,
    }  # fmt: skip
    said = "".join(f"{key} = {value}\n" for key, value in head.items())
    rows = "\n".join(" ".join(map(str, row)) for row in counts)
    text = tmp_path / "text.sdf"
    text.write_bytes(f"a{mark}-1.0\n{said}*\n{rows}\n*\n".replace("\n", end).encode())
    packed = tmp_path / "packed.sdf"
    packed.write_bytes(
        f"b{mark}-1.0".encode()
        + struct.pack("<10s12s12sHH4d3B", b"M", b"1", b"2", 12, 7, 1e-6, 1e-6, 1e-10, -1, 0, 6, 0)
        + counts.astype("<i4").tobytes()
    )
    for path in (text, packed):
        scan = read_scans(path)
        np.testing.assert_allclose(scan.height.values, counts * 1e-10, atol=1e-18)
        assert scan.attrs["pitch_m"] == pytest.approx(1e-6)


def test_an_sdf_draft_that_is_cut_short_is_told_by_its_own_name(tmp_path):
    path = tmp_path / "cut.sdf"
    path.write_bytes(b"bBCR-1.0" + b"M" * 30)
    with pytest.raises(ReadError) as told:
        read_scans(path)
    assert str(path) in str(told.value)


def test_a_mark_for_lost_points_in_a_foreign_format_is_no_height(tmp_path):
    z = np.random.default_rng(2).normal(size=(10, 12)).round(3)
    cells = z.astype(object)
    cells[2, 3] = cells[2, 4] = 1.70141e38
    head = "# File Format = ASCII\n# Created by SPIP 6.0\n# x-pixels = 12\n# y-pixels = 10\n"
    head += "# x-length = 1200\n# y-length = 1000\n# z-unit = nm\n# voidpixels = 2\n"
    rows = "\n".join("\t".join(map(str, row)) for row in cells)
    (tmp_path / "a.asc").write_text(f"{head}# Start of Data:\n{rows}\n")
    scan = read_scans(tmp_path / "a.asc")
    assert int(np.isnan(scan.height).sum()) == 2
    assert float(np.nanmax(np.abs(scan.height))) < 1e-8
    assert "1.70141e+38 2 times" in scan.attrs["taken_for_missing"]


def test_zygo_text_is_a_map_in_pixels_of_its_camera(tmp_path):
    z = np.random.default_rng(2).normal(size=(9, 12)).round(4)
    points = [f"{x} {y} {z[y, x]}" for y in range(9) for x in range(12)]
    points[14] = "2 1 No Data"
    head = 'Zygo XYZ Data File - Format 2\n"8.1"\n0 0 0 0 0 0\n0 0 12 9\n"a"\n"b"\n"c"\n'
    head += "0 0.5 6.3e-07 0 1 20 1.5e-06 1577872800\n#\n"
    (tmp_path / "a.xyz").write_text(head + "\n".join(points) + "\n#\n")
    scan = read_scans(tmp_path / "a.xyz")
    assert np.isnan(scan.height.values[1, 2]) and scan.attrs["pitch_m"] == pytest.approx(1.5e-6)
    np.testing.assert_allclose(scan.height.values[2:], 1e-6 * z[2:], atol=1e-12)
    (tmp_path / "b.xyz").write_text((head + "\n".join(points)).replace("1.5e-06", "0") + "\n#\n")
    with pytest.raises(ReadError, match="how large a pixel is"):
        read_scans(tmp_path / "b.xyz")


def test_points_on_circles_are_told_to_lie_on_no_grid(tmp_path):
    turn = np.arange(120) * 2 * np.pi / 120
    rows = [
        f"{r * np.cos(a):.4f};{r * np.sin(a):.4f};{np.sin(3 * a):.4f}" for r in (5, 7) for a in turn
    ]
    (tmp_path / "cmm.csv").write_text("x [mm];y [mm];z [um]\n" + "\n".join(rows) + "\n")
    with pytest.raises(ReadError, match="even grid along x; of points that lie freely"):
        read_scan(tmp_path / "cmm.csv")
