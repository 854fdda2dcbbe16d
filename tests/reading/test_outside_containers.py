"""What a file says of other files is not followed: archives, workbooks, companion logs."""

import stat
import zipfile
from pathlib import Path

import numpy as np
import pytest

import tribolab as tl
from tribolab.core.errors import ConfigError, ReadError
from tribolab.reading.dialect.find import load_dialect

FORCE = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n" + "".join(
    f"{n / 10},{n}.5,31.0\n" for n in range(300)
)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("../run.csv", "has a name outside of it"),
        ("a/../../run.csv", "has a name outside of it"),
        ("..\\run.csv", "has a name outside of it"),
        ("/etc/run.csv", "has a name outside of it"),
        ("C:\\run.csv", "has a name outside of it"),
        ("link.csv", "is a link"),
    ],
)
def test_members_of_an_archive_that_lead_out_of_it_are_refused(name, words, tmp_path):
    path = tmp_path / "in" / "a.zip"
    path.parent.mkdir()
    with zipfile.ZipFile(path, "w") as archive:
        part = zipfile.ZipInfo(name)
        if words == "is a link":
            part.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(part, FORCE)
    for reader in (tl.read, tl.read_scans):
        with pytest.raises(ReadError, match=rf"a\.zip: .*{words}"):
            reader(path)
    assert sorted(tmp_path.rglob("*")) == [path.parent, path]


def test_an_archive_with_a_folder_is_read(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr("raw/day 1/run..1.csv", FORCE)
    assert tl.read(tmp_path / "a.zip").sizes["time"] == 300


def test_a_workbook_does_not_open_another_that_it_refers_to(tmp_path):
    """The number that the office program saved with the formula counts."""
    from openpyxl import Workbook

    other, book = Workbook(), Workbook()
    other.active.append(["Fx [N]"])
    other.save(tmp_path / "other.xlsx")
    book.active.append(["Time [s]", "Fx [N]", "Fz [N]"])
    for n in range(100):
        book.active.append([n / 10, 0.5 + n % 3, 31.0])
    book.save(tmp_path / "a.xlsx")
    with zipfile.ZipFile(tmp_path / "a.xlsx") as old:
        parts = {name: old.read(name) for name in old.namelist()}
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    parts["xl/externalLinks/externalLink1.xml"] = (
        '<externalLink xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">'
        f'<externalBook xmlns:r="{office}" r:id="rId1"/></externalLink>'
    ).encode()
    parts["xl/externalLinks/_rels/externalLink1.xml.rels"] = (
        '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
        f'<Relationship Id="rId1" Type="{office}/externalLinkPath" Target="{tmp_path}/other.xlsx" '
        'TargetMode="External"/></Relationships>'
    ).encode()
    sheet = parts["xl/worksheets/sheet1.xml"]
    cell = b'<c r="B2" t="n"><v>0.5</v></c>'
    assert cell in sheet
    saved = b'<c r="B2"><f>[1]Sheet!$A$1</f><v>0.75</v></c>'
    parts["xl/worksheets/sheet1.xml"] = sheet.replace(cell, saved)
    with zipfile.ZipFile(tmp_path / "a.xlsx", "w") as new:
        for name, content in parts.items():
            new.writestr(name, content)
    (tmp_path / "other.xlsx").chmod(0)
    run = tl.read(tmp_path / "a.xlsx")
    assert run.friction_force.values[:2].tolist() == [0.75, 1.5]


def test_an_x3p_does_not_reach_beyond_its_archive(tmp_path):
    made = tmp_path / "a.x3p"
    secret = tmp_path / "data.bin"
    secret.write_bytes(np.ones(16).tobytes())
    axis = "<C{0}><AxisType>{1}</AxisType><DataType>D</DataType><Increment>1e-6</Increment></C{0}>"
    for link in (str(secret), "../data.bin", "../" * 9 + str(secret)[1:], f"file://{secret}"):
        with zipfile.ZipFile(made, "w") as archive:
            archive.writestr(
                "main.xml",
                '<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2"><Record1><Axes>'
                + axis.format("X", "I") + axis.format("Y", "I") + axis.format("Z", "A")
                + "</Axes></Record1><Record3><MatrixDimension><SizeX>4</SizeX><SizeY>4</SizeY>"
                "<SizeZ>1</SizeZ></MatrixDimension><DataLink><PointDataLink>" + link
                + "</PointDataLink></DataLink></Record3></p:ISO5436_2>",
            )  # fmt: skip
        with pytest.raises(ReadError, match=r"a\.x3p"):
            tl.read_scans(made)


def test_a_companion_log_that_is_a_link_wants_to_be_named(tmp_path):
    away = tmp_path / "elsewhere.csv"
    away.write_text("# Linear slider, motion log\nTime [s],Position [mm]\n")
    main = tmp_path / "a_force.csv"
    main.write_text(FORCE)
    (tmp_path / "a_motion.csv").symlink_to(away)
    with pytest.raises(ReadError, match=r"a_motion\.csv is a link to .*elsewhere\.csv"):
        tl.read(main)
    main.rename(tmp_path / "stored.csv")  # as git-annex and DataLad keep every file
    main.symlink_to(tmp_path / "stored.csv")
    with pytest.raises(ReadError) as caught:
        tl.read(main)
    assert "is a link" not in str(caught.value)


@pytest.mark.parametrize("other", ["/../../etc/x", "..\\x", "/etc/x", "\0"])
def test_a_companion_lies_beside_its_log(other, tmp_path):
    described = Path(tl.__file__).parents[1] / "raw_data_schema/instruments/linear_slider.toml"
    text = described.read_text("utf-8")
    assert '"_motion"' in text
    escaped = other.replace("\\", "\\\\").replace("\0", "\\u0000")
    (tmp_path / "own.toml").write_text(text.replace('"_motion"', f'"{escaped}"'))
    with pytest.raises(ConfigError, match=r"pair\.other"):
        load_dialect(tmp_path / "own.toml")
