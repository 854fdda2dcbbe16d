"""In which encoding a text is told by what decodes to plausible text, in both directions."""

import numpy as np
import pytest

from tribolab.reading.scan_files import read_scans
from tribolab.reading.unknown.layout.lines import find_encoding

NUMBERS = b"\n0.0 1.5\n0.1 1.25\n"
EASTERN = [
    ("gb18030", "Z(μm)"),
    ("gb18030", "温度(℃)"),
    ("gb18030", "三坐标 样品：喷砂铝 3#，间距 4 μm"),
    ("cp932", "触針半径 2 μm"),
    ("cp949", "촉침 반경 2 μm"),
    ("big5", "探針半徑 2 μm"),
]
WESTERN = [
    ("latin-1", "µm"),
    ("latin-1", "é"),
    ("latin-1", "ß"),
    ("latin-1", "20 °C ± 2, 3 m² · s³"),
    ("latin-1", "Größe, gemäß Maßstab [µm]"),
    ("latin-1", "MEDIÇÃO, DIREÇÃO"),
    ("latin-1", "«données» créées à Orléans"),
    ("latin-1", "ÀÉÈÙ ÄÖÜß"),
    ("latin-1", "Nº 5 ¿Qué? ¡Sí! ÑANDÚ"),
    ("latin-1", "Ångström, høyde, blåst ÆØÅ"),
    ("latin-1", "°°°°°° §§§§"),
    ("cp1252", "“µm” – 5 € ™ … Œuvre"),
    ("cp1250", "příčná šířka žluťoučký kůň úpěl"),
    ("cp1250", "ŠÍŘKA VÝŠKA ŽÁDNÝ"),
    ("cp1250", "wysokość źródło ŻÓŁĆ"),
    ("cp1250", "magasság űrő"),
    ("cp1254", "yüzey pürüzlülüğü ölçümü, ağırlığı"),
    ("cp1254", "İSTANBUL ÖLÇÜM ĞÜŞİÖÇ"),
    ("cp1251", "Профилограмма, мкм"),
    ("cp1251", "ИЗМЕРЕНИЕ ШЕРОХОВАТОСТИ"),
    ("cp1251", "ТЕСТ"),
    ("cp1253", "ΥΨΟΣ ΜΕΤΡΗΣΗ τραχύτητας"),
    ("koi8-r", "высота шероховатость"),
]


@pytest.mark.parametrize(("encoding", "text"), EASTERN)
def test_an_east_asian_text_is_known_by_its_letters(encoding, text):
    assert find_encoding(text.encode(encoding) + NUMBERS)[0] == encoding


@pytest.mark.parametrize(("encoding", "text"), WESTERN)
def test_a_text_of_single_bytes_is_not_taken_for_an_east_asian_one(encoding, text):
    assert find_encoding(text.encode(encoding) + NUMBERS)[0] in ("latin-1", "cp1252", encoding)


@pytest.mark.parametrize(
    ("encoding", "head"),
    [
        ("gb18030", "三维形貌仪\r\n操作员：王芳\r\nX（mm）   Y（mm）   Z（μm）"),
        ("cp932", "三次元表面形状\r\n対物レンズ\r\nX(mm)  Y(mm)  高さ(μm)"),
        ("cp949", "표면 형상 측정기\r\nX(mm)    Y(mm)    Z(μm)"),
    ],
)
def test_units_in_such_a_text_are_read(encoding, head, tmp_path):
    z = np.round(np.sin(np.arange(48.0)).reshape(6, 8), 4)
    rows = "\r\n".join(
        f"{0.004 * i:.3f}   {0.004 * j:.3f}   {z[j, i]:.4f}" for j in range(6) for i in range(8)
    )
    file = tmp_path / "points.txt"
    file.write_bytes(f"{head}\r\n{rows}\r\n".encode(encoding))
    scan = read_scans(file)
    np.testing.assert_allclose(scan.height, 1e-6 * z, atol=1e-15)
    np.testing.assert_allclose(np.diff(scan.x), 4e-6)


def test_what_blanks_part_above_a_table_is_found_again(tmp_path):
    file = tmp_path / "line.txt"
    rows = "\n".join(f"  {0.001 * n:.3f}    {np.sin(n / 5):.4f}" for n in range(64))
    head = "# stylus  tip radius: 2 um\n# second line\n  X(mm)     Z(µm)"
    file.write_text(f"{head}\n{rows}\n", encoding="utf-8")
    scan = read_scans(file)
    assert scan.attrs["tip_radius_m"] == pytest.approx(2e-6)
    assert scan.attrs["pitch_m"] == pytest.approx(1e-6)
