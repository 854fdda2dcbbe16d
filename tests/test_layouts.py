"""Layouts that real instruments write: blank rows, short rows, units in cells, workbooks in XML."""

import numpy as np
import pytest

import tribolab as tl
from tribolab.errors import ReadError
from tribolab.io.tables.workbook import sheets_of

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
            xml_workbook().replace("<Workbook", '<!DOCTYPE x [<!ENTITY a "b">]><Workbook', 1),
            "entities",
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
