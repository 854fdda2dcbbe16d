"""Maps as text, as microscopes export them: a matrix below lines that say how large it is."""

import numpy as np
import pytest

from tribolab.core.errors import ReadError
from tribolab.reading.lexicon.lexicon import known_words
from tribolab.reading.scan_files import read_scans
from tribolab.reading.scans.header import map_header

ROWS, COLUMNS = 9, 14
HEIGHTS = np.round(np.random.default_rng(11).normal(0, 1e-6, (ROWS, COLUMNS)), 9)
HOLES = np.where((np.arange(HEIGHTS.size) % 41 == 7).reshape(HEIGHTS.shape), np.nan, HEIGHTS)


def rows(heights=HEIGHTS, mark=",", scale=1e6, decimal=".", hole="", end=""):
    lines = [
        mark.join(
            hole if np.isnan(z) else f"{scale * z:.9g}".replace(".", decimal) for z in row
        ) + end
        for row in heights
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


KEYENCE = (
    '"Date and time","2024/05/06 07:08:09"\n"Model","VK-X200 Series"\n"Horizontal","14"\n'
    '"Vertical","9"\n"XY Calibration","277.5","nm"\n"Output image data","Height"\n"Unit","um"\n\n'
    '"Height"\n'
)
FILES = {
    "Keyence": (KEYENCE + rows(), 277.5e-9, HEIGHTS),
    "Keyence, Japanese": (
        "機種,VK-X200\n横,14\n縦,9\nXYキャリブレーション,277.5,nm\n単位,µm\n高さ\n"
        + rows(end=","),
        277.5e-9,
        HEIGHTS,
    ),
    "Alicona": (
        "Pixel Size X: 0.4384 µm\nPixel Size Y: 0.4384 µm\nColumns: 14\nZ unit: mm\n"
        + rows(HOLES, "\t", 1e3, hole="NaN"),
        0.4384e-6,
        HOLES,
    ),
    "Bruker": (
        "Field of view: 28.0 um x 18.0 um\nPixels: 14 x 9\nHeight unit: nm\n"
        + rows(HOLES, " ", 1e9, hole="Bad"),
        2e-6,
        HOLES,
    ),
    "French, axis by axis": (
        "Axe X;Points;14;Pas;1,25;µm;Longueur;0,01625;mm\nAxe Y;Lignes;9;Pas;1,25;µm\n"
        "Axe Z;Unité;µm;Résolution;0,0001;µm\n" + rows(mark=";", decimal=","),
        1.25e-6,
        HEIGHTS,
    ),
    "German": (
        "Messfeld: 7,0 x 4,5 mm\nEinheit Höhe: µm\n" + rows(mark=";", decimal=","),
        0.5e-3,
        HEIGHTS,
    ),
    "French": ("Taille de pixel: 1,25 µm\nUnité Z: µm\n" + rows(mark="\t", decimal=","), 1.25e-6,
               HEIGHTS),
    "Spanish": ("Tamaño de píxel (um)\t0.8\nAltura [um]\n" + rows(mark="\t"), 0.8e-6, HEIGHTS),
    "Italian": ("Dimensione pixel = 0.8 um\nAltezze in nm\n" + rows(mark="\t", scale=1e9), 0.8e-6,
                HEIGHTS),
    "Chinese": ("像素尺寸,0.65,微米\n单位,um\n" + rows(HOLES, hole="***"), 0.65e-6, HOLES),
}  # fmt: skip


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "own"])
@pytest.mark.parametrize("maker", FILES)
def test_a_matrix_whose_header_says_all_is_read(tmp_path, maker, encoding):
    text, pitch, heights = FILES[maker]
    own = {"Keyence, Japanese": "cp932", "Chinese": "gb18030"}.get(maker, "latin-1")
    if encoding == "own" and own == "cp932":
        text = text.replace("µ", "u")  # which that encoding has not
    path = tmp_path / "map.csv"
    path.write_bytes(text.encode(own if encoding == "own" else encoding))
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height.values, heights, rtol=1e-9, atol=0)
    for dim, number in (("x", COLUMNS), ("y", ROWS)):
        np.testing.assert_allclose(scan[dim].values, pitch * np.arange(number), rtol=1e-12)


@pytest.mark.parametrize(
    ("above", "words"),
    [
        ("Unit: um\n", "does not say how far its points lie apart"),
        ("Pixel size: 1 um\n", "in which unit its heights are"),
        ("Pixel size: 1 um\nPixel size: 2 um\nUnit: um\n", "how far its points lie apart"),
        ("Field of view: 20 um\nUnit: um\n", "how far its points lie apart"),  # along which side?
        ("Pixel size: 1 um\nZ scale: 0.5\nUnit: um\n", "in which unit its heights are"),
        ("Pixel size: 1 um\nXY unit: um\n", "in which unit its heights are"),
        ("Pixel size: 1 um\nRows: 12\nUnit: um\n", "12 rows of 14; is it whole?"),
    ],
)
def test_what_a_matrix_does_not_say_is_told(tmp_path, above, words):
    path = tmp_path / "map.csv"
    path.write_text(above + rows())
    with pytest.raises(ReadError, match=words):
        read_scans(path)


def test_what_may_be_no_matrix_of_heights_is_not_taken_for_one(tmp_path):
    said = "Pixel size: 1 um\nUnit: um\n"
    two = tmp_path / "two.csv"
    two.write_text(said + rows() + "\nIntensity\n" + rows())
    with pytest.raises(ReadError, match="several matrices"):
        read_scans(two)
    names = ",".join(f"Channel {n}" for n in range(COLUMNS)) + "\n"
    places = "X/Y," + ",".join(f"{n}.0" for n in range(COLUMNS)) + "\n"
    beside = "\n".join(f"{n}.0,{line}" for n, line in enumerate(rows().splitlines())) + "\n"
    for text in (names + rows(), places + beside, ",".join(places.split(",")[1:]) + beside):
        path = tmp_path / "other.csv"
        path.write_text(said + text)
        with pytest.raises(ReadError):
            read_scans(path)


def test_a_pitch_goes_before_the_extent_and_counts_are_no_lengths():
    lines = ["Scan size X: 10 um", "Scan size Y: 5 um", "Pixel size: 0.99 um", "X size: 10"]
    said = map_header(lines, (10, 10), ".")
    assert (said.dx, said.dy) == pytest.approx((0.99e-6, 0.99e-6))
    assert (said.columns, said.rows, said.height) == (10, None, None)
    narrow = map_header(lines[:2], (10, 10), ".")
    assert (narrow.dx, narrow.dy) == pytest.approx((1e-6, 0.5e-6))


STATED = [
    ("# dx = 2.0 um\n# dy = 10.0 um\n# korkeus: nm\n# puuttuva arvo: -99999\n", -99999),
    ("# krok x: 2 µm\n# krok y: 10 µm\n# výška: nm\n# dosazeno: -12345\n", -12345),
    ("Punktabstand x;2,0;µm\nPunktabstand y;10,0;µm\nHöhe;nm\nkein Wert;9999999\n", 9999999),
    ("x-pitch   2 um\ny-pitch   0.01 mm\nvertical   nm\nNODATA_value   -1e6\n", -1e6),
    ("Δx: 2 µm\nΔy: 10 µm\n高度：nm\n无效点: 1e9\n", 1e9),
]


@pytest.mark.parametrize(("above", "mark"), STATED)
def test_two_pitches_a_bare_unit_and_a_stated_number_for_no_height_are_read(tmp_path, above, mark):
    path = tmp_path / "raster.asc"
    heights = np.round(HOLES, 9)
    decimal, between = (",", ";") if ";" in above else (".", " ")
    path.write_text(above + rows(heights, between, 1e9, decimal, hole=f"{mark:g}"), "utf-8")
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height.values, heights, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(np.diff(scan.x), 2e-6)
    np.testing.assert_allclose(np.diff(scan.y), 10e-6)
    assert "as the header states" in scan.attrs["taken_for_missing"]


def test_what_the_header_states_of_heights_takes_none_away(tmp_path):
    path = tmp_path / "raster.asc"
    spiked = HEIGHTS.copy()
    spiked[3, 4] = -2e-5
    said = "# pixel size: 1 um\n# unit: nm\n# minimum: -20000\n# missing points: 12\n"
    path.write_text(said + rows(spiked, " ", 1e9))
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height.values, spiked, rtol=1e-9, atol=1e-15)
    assert "taken_for_missing" not in scan.attrs


@pytest.mark.parametrize("said", ["Punktabstand: 2,5 µm", "Pixel size [um]: 2.5", "dx=dy: 2,5 um"])
@pytest.mark.parametrize("decimal", [".", ","])
def test_the_header_may_have_another_decimal_mark_than_the_matrix(tmp_path, said, decimal):
    path = tmp_path / "map.txt"
    whole = np.round(HEIGHTS, 6 if decimal == "." else 9)  # in um no mark tells
    path.write_text(f"{said}\nHeight unit: um\n" + rows(whole, " ", 1e6, decimal), "utf-8")
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height, whole, atol=1e-15)
    np.testing.assert_allclose(np.diff(scan.x), 2.5e-6)
    np.testing.assert_allclose(np.diff(scan.y), 2.5e-6)


def test_a_length_that_may_have_a_mark_of_thousands_is_not_taken(tmp_path):
    path = tmp_path / "map.txt"
    path.write_text("Pixel size: 1,024 um\nHeight unit: um\n" + rows(np.round(HEIGHTS, 6), " "))
    with pytest.raises(ReadError, match="how far its points lie apart"):
        read_scans(path)


@pytest.mark.parametrize("said", ["multiply by 0.01", "dz: 0.01 um", "scaling factor: 0.1"])
def test_whole_numbers_that_may_be_counts_are_not_taken_for_heights(tmp_path, said):
    path = tmp_path / "map.txt"
    path.write_text(f"dx: 1 um\ndy: 1 um\nz: um\n{said}\n" + rows(np.round(HEIGHTS, 8), " ", 1e8))
    with pytest.raises(ReadError, match="in which unit its heights are"):
        read_scans(path)


def test_a_range_that_ends_at_the_last_point_has_one_step_less(tmp_path):
    path = tmp_path / "map.txt"
    path.write_text("X range: 13 um\nY range: 8 um\nHeight unit: um\n" + rows(mark=" "))
    scan = read_scans(path)
    np.testing.assert_allclose(np.diff(scan.x), 1e-6)
    np.testing.assert_allclose(np.diff(scan.y), 1e-6)


def test_a_value_for_no_height_may_stand_among_the_heights(tmp_path):
    path = tmp_path / "map.txt"
    path.write_text("dx: 1 um\ndy: 1 um\nz: um\nno data value: 0\n" + rows(HOLES, " ", hole="0"))
    np.testing.assert_allclose(read_scans(path).height.values, HOLES, rtol=1e-9)


@pytest.mark.parametrize(
    "above",
    [
        "WSxM ASCII Matrix file\nX Amplitude: 7 um\nY Amplitude: 4.5 um\nZ Amplitude: {reach} um\n",
        "Lateral resolution,0.5 um/pixel\nZ unit,um\n",
        "Step size: 0.5 um\nHeight unit: um\n",
        "Point spacing [um]: 0.5\nLine spacing [um]: 0.5\nHeights in um\n",
    ],
)
def test_what_afm_and_stylus_programs_write_above_a_map_is_understood(tmp_path, above):
    path = tmp_path / "map.csv"
    heights = np.round(HEIGHTS, 9)
    path.write_text(above.format(reach=f"{1e6 * np.ptp(heights):.3f}") + rows(heights))
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height, heights, atol=1e-15)
    np.testing.assert_allclose(np.diff(scan.x), 0.5e-6)
    np.testing.assert_allclose(np.diff(scan.y), 0.5e-6)


def test_a_stated_range_that_is_not_that_of_the_heights_states_no_unit(tmp_path):
    path = tmp_path / "map.csv"
    path.write_text("Step: 1 um\nZ Amplitude: 300 nm\n" + rows())
    with pytest.raises(ReadError, match="in which unit its heights are"):
        read_scans(path)


def test_every_word_for_a_pitch_is_understood_above_a_map_as_above_a_profile(tmp_path):
    [pitch] = [word for word in known_words() if word.quantity == "pitch"]
    terms = [term for language in pitch.terms.values() for term in language]
    assert len(terms) > 80
    profile = "Z [um]\n" + "\n".join(f"{1e6 * z:.3f}" for z in HEIGHTS.ravel()) + "\n"
    path = tmp_path / "scan.csv"
    for term in terms:
        for body in (f"Height unit: um\n{rows()}", profile):
            path.write_text(f"{term}: 2 um\n{body}", "utf-8")
            scan = read_scans(path)
            assert np.diff(scan.x)[0] == pytest.approx(2e-6), term
            assert scan.height.size == HEIGHTS.size, term


def test_a_pitch_along_x_alone_is_taken_along_y_and_doubted(tmp_path):
    path = tmp_path / "map.csv"
    path.write_text("X increment: 2 um\nHeight unit: um\n" + rows())
    scan = read_scans(path)
    np.testing.assert_allclose(np.diff(scan.y), 2e-6)
    assert "along y" in scan.attrs["doubtful"]
    path.write_text("X increment: 2 um\nY range: 18 um\nHeight unit: um\n" + rows())
    assert "doubtful" not in read_scans(path).attrs
