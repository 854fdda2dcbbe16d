"""Layouts that real instruments write: blank rows, short rows, units in cells, workbooks in XML."""

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.raw.containers.workbook import sheets_of
from tribolab.reading.unknown.proposal.draft import draft_dialect

NAMES, UNITS = ["Time", "Friction force", "Normal force", "Speed"], ["s", "N", "N", "mm/s"]


def rows():
    rng = np.random.default_rng(1)
    t = np.arange(600) * 0.1
    v = np.where(t < 5, 0.0, np.where(t > 35, 3.0, 1.0))
    friction = np.where(v > 0, 3.0, 0) + 0.02 * rng.standard_normal(600)
    load = 10 + 0.02 * rng.standard_normal(600)
    return [
        [f"{a:.1f}", f"{b:.4f}", f"{c:.4f}", f"{d:.3f}"]
        for a, b, c, d in zip(t, friction, load, v, strict=True)
    ]


def table(*head, body=None, mark=","):
    return "\r\n".join(mark.join(row) for row in (*head, *(body or rows()))) + "\r\n"


def xml_workbook():
    def cell(text, kind):
        return f'<Cell><Data ss:Type="{kind}">{text}</Data></Cell>'

    head = "".join(f"<Row>{''.join(cell(c, 'String') for c in r)}</Row>" for r in (NAMES, UNITS))
    body = "".join(f"<Row>{''.join(cell(c, 'Number') for c in r)}</Row>" for r in rows())
    space = "urn:schemas-microsoft-com:office:spreadsheet"
    return (
        f'<?xml version="1.0"?><?mso-application progid="Excel.Sheet"?><Workbook xmlns="{space}" '
        f'xmlns:ss="{space}"><Worksheet ss:Name="Data"><Table>{head}{body}</Table></Worksheet>'
        "</Workbook>"
    )


def dated(k, row):
    return ["2024-03-05", f"10:{k // 600:02d}:{k / 10 % 60:04.1f}", *row[1:]]


LAYOUTS = {
    "a blank row between names and units": lambda: table(NAMES, [""] * 4, UNITS),
    "a blank line between names and units": lambda: table(NAMES, [], UNITS),
    "first row one cell short": lambda: table(NAMES, UNITS, rows()[0][:3], body=rows()[1:]),
    "cells of one blank": lambda: table(
        NAMES,
        UNITS,
        body=[[a, " " if k % 97 == 3 else b, c, d] for k, (a, b, c, d) in enumerate(rows())],
    ),
    "a title above": lambda: table(["Sliding test 4", "", "", ""], NAMES, UNITS),
    "settings above": lambda: table(["Load", "10 N", "Speed", "1 mm/s"], NAMES, UNITS),
    "last row shifted": lambda: table(NAMES, UNITS, body=[*rows()[:-1], ["", *rows()[-1]]]),
    "units behind the numbers": lambda: table(
        NAMES,
        body=[[f"{c} {u}" for c, u in zip(row, UNITS, strict=True)] for row in rows()],
        mark=";",
    ),
    "a column of dates beside one of times": lambda: table(
        ["Date", *NAMES],
        ["", "", *UNITS[1:]],
        body=[dated(k, row) for k, row in enumerate(rows())],
    ),
    "thousands": lambda: table(
        NAMES, ["ms", *UNITS[1:]], body=[[f'"{1000 * float(r[0]):,.0f}"', *r[1:]] for r in rows()]
    ),
    "a workbook in XML": xml_workbook,
}


TEXTS = [(layout, encoding) for layout in LAYOUTS for encoding in ("utf-8", "utf-16")]
TEXTS.remove(("a workbook in XML", "utf-16"))  # Excel writes it in UTF-8


@pytest.mark.parametrize(("layout", "encoding"), TEXTS)
def test_a_layout_of_real_files_is_read_at_once(layout, encoding, tmp_path):
    path = tmp_path / "run.csv"
    path.write_bytes(LAYOUTS[layout]().encode(encoding))
    run = tl.read(path)
    assert run.sizes["time"] >= 599
    found = tl.friction_coefficient(run, tl.find_segments(run))
    np.testing.assert_allclose(found.friction_coefficient, [0.2998, 0.3003], atol=2e-4)
    np.testing.assert_allclose(found.sliding_speed, [1e-3, 3e-3], rtol=1e-9)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (xml_workbook().replace("</Workbook>", ""), "damaged"),
        (
            xml_workbook().replace(
                "<Workbook", '<!DOCTYPE x [<!ENTITY a SYSTEM "b">]><Workbook', 1
            ),
            "an entity from outside the file",
        ),
        (xml_workbook().replace("<Row>", '<Row ss:Index="9999999">', 1), "larger than a table"),
    ],
)
def test_a_damaged_workbook_in_xml_costs_one_message(text, says, tmp_path):
    (tmp_path / "run.xml").write_text(text, "utf-8")
    with pytest.raises(ReadError, match=says):
        sheets_of(tmp_path / "run.xml")
    with pytest.raises(ReadError):
        tl.read(tmp_path / "run.xml")


def test_heights_in_a_are_in_angstrom(tmp_path):
    x = np.arange(400) * 0.5
    z = 300 * np.sin(x / 5)
    lines = [f"{a:.4f},{b:.1f}" for a, b in zip(x, z, strict=True)]
    (tmp_path / "scan.csv").write_text("Lateral(um),Total Profile(A)\n" + "\n".join(lines))
    scan = tl.read_scans(tmp_path / "scan.csv")
    assert float(scan.height.max()) == pytest.approx(300e-10, rel=1e-3)
    assert float(scan.x[1] - scan.x[0]) == pytest.approx(0.5e-6)


def test_a_path_that_only_grows_is_no_position_beside_one_that_turns(tmp_path):
    t = np.arange(2000) * 0.02
    x = 3 * np.abs((t / 4) % 2 - 1)  # mm, to and fro at 0.75 mm/s
    path = np.concatenate([[0], np.cumsum(np.abs(np.diff(x)))]) / 1000  # m
    mu = 0.2 * np.sign(np.gradient(x)) + 0.003 * np.random.default_rng(4).standard_normal(2000)
    lines = [f"{a:.2f};{b:.5f};{c:.4f};{d:.4f}" for a, b, c, d in zip(t, path, x, mu, strict=True)]
    head = "Time [s];Distance [m];Position [mm];mu []\n"
    (tmp_path / "run.txt").write_text(head + "\n".join(lines))
    run = tl.read(tmp_path / "run.txt")
    assert float(run.position.max()) == pytest.approx(3e-3)
    found = tl.friction_coefficient(run, tl.find_segments(run))
    np.testing.assert_allclose(found.sliding_speed, 0.75e-3, rtol=0.01)


def test_a_summary_below_a_sheet_and_settings_on_another_are_understood(tmp_path):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    cover = book.active
    cover.title = "Deckblatt"
    for row in [("Normalkraft", 20, "N"), ("Drehzahl", 120, "1/min"), ("Reibradius", 15, "mm")]:
        cover.append(row)
    sheet = book.create_sheet("Messdaten")
    sheet.append(["Zeit [s]", "Reibkraft [N]"])
    rng = np.random.default_rng(5)
    for k in range(400):
        sheet.append([k, 5 + 0.05 * float(rng.standard_normal())])
    sheet.append([])
    sheet.append(["Mittelwert", 5.0])
    book.save(tmp_path / "run.xlsx")
    run = tl.read(tmp_path / "run.xlsx")
    assert run.sizes["time"] == 400
    found = tl.friction_coefficient(run, tl.find_segments(run))
    assert found.sliding_speed.item() == pytest.approx(2 * np.pi * 2 * 0.015)
    assert found.friction_coefficient.item() == pytest.approx(0.25, rel=0.01)


def test_a_line_of_thousands_of_cells_is_a_table_without_line_ends(tmp_path):
    (tmp_path / "run.txt").write_text("\t".join(f"{0.01 * k:.3f}" for k in range(5000)) + "\n")
    with pytest.raises(ReadError, match="5000 columns in 1 rows.*each row on a line of its own"):
        draft_dialect(tmp_path / "run.txt")
