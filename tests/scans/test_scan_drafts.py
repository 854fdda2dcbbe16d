"""Heights without positions, and scans of unknown instruments: read by what their headers say."""

import gzip

import numpy as np
import pytest

from tribolab.app.checks import check_files
from tribolab.app.info.file_info import file_lines
from tribolab.core.errors import ReadError, TribolabError
from tribolab.qc.scan.checks import check_scans
from tribolab.reading.dialect.find import load_dialect
from tribolab.reading.scan_files import read_scans
from tribolab.reading.unknown.proposal.answers import corrected
from tribolab.reading.unknown.proposal.draft import draft_dialect, save_draft

Z = np.round(np.sin(np.arange(200) / 9.0), 4)
COLUMN = "\n".join(map(str, Z))
ROWS = "\n".join(f"{0.00025 * n:.5f},{z}" for n, z in enumerate(Z))
GERMAN = COLUMN.replace(".", ",")
DRAFTED = {
    "pitch before the heights": f"Point spacing: 0.25 um\nPoints: 200\nZ [um]\n{COLUMN}\n",
    "decimal comma": f"Messpunktabstand: 0,25 µm\nHöhe [µm]\n{GERMAN}\n",
    "units in a line of their own": f"Profile export\nX,Z\nmm,um\n{ROWS}\n",
    "length and number of points": f"Scan length\t50.000 um\nNumber of points\t200\n"
    f"Height unit\tum\nHeight\n{COLUMN}\n",
    "longueur": f"Unité de hauteur : µm\nLongueur de palpage = 0,05 mm\nNombre de points = 200\n"
    f"{GERMAN}\n",
    "longueur évaluée": f"Unité de hauteur : µm\nLongueur évaluée : 0,05 mm\n"
    f"Nombre de points : 200\n{GERMAN}\n",
    "Spanish": "\n".join(["Distancia [mm];Perfil [um]", ROWS.replace(",", ";")]) + "\n",
    "a unit alone": f"Abtastabstand: 0,25 µm\nEinheit: µm\nMesswerte:\n{GERMAN}\n",
    "in inches": f"Traverse length: 0.001968503937 inch\nPoints: 200\nZ [um]\n{COLUMN}\n",
    "a table of results above": f"Name,Value,Unit\nRa,0.5,um\nRz,1.2,um\n\nX [mm],Z [um]\n{ROWS}\n",
}


def written(tmp_path, text, name="line.txt"):
    path = tmp_path / name
    path.write_bytes(text.encode("latin-1"))
    return path


@pytest.mark.parametrize("kind", DRAFTED)
def test_a_header_that_says_all_is_enough(tmp_path, kind):
    path = written(tmp_path, DRAFTED[kind])
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height[0], 1e-6 * Z, rtol=0, atol=1e-15)
    assert scan.attrs["pitch_m"] == pytest.approx(0.25e-6)
    assert scan.attrs["instrument"] == "drafted from the file"
    assert scan.attrs["to_keep_it"] == "tribolab info line.txt --write my.toml"
    target = save_draft(draft_dialect(path), tmp_path / "own.toml")  # what is kept reads the same
    kept = read_scans(path, target)
    np.testing.assert_array_equal(kept.height, scan.height)
    assert any("profile of 200 points" in line for line in file_lines(path))


def test_what_would_be_guessed_is_told_instead(tmp_path):
    path = written(tmp_path, f"Sampling interval = 0.25 um\nPoints = 200\n{COLUMN}\n")
    with pytest.raises(ReadError, match=r"column 1.*it is the height in um.*or nm, mm, m"):
        read_scans(path)
    path = written(tmp_path, f"Evaluation length = 4 mm\nZ [um]\n{COLUMN}\n")
    with pytest.raises(ReadError, match="the heights lie evenly over 'Evaluation length = 4 mm'"):
        read_scans(path)
    with pytest.raises(ReadError, match="x is in mm"):
        read_scans(written(tmp_path, f"X,Z\n{ROWS}\n"))
    with pytest.raises(ReadError, match=r"neighbouring heights, pitch = \"\(a length\)\""):
        read_scans(written(tmp_path, f"Z [um]\n{COLUMN}\n"))


def tables(*titles):
    """One table of heights below each title, each ten times as high as the one before."""
    return "\n".join(
        f"{title}\nX [mm],Z [um]\n"
        + "\n".join(f"{0.00025 * n:.5f},{10**k * z:.4f}" for n, z in enumerate(Z))
        + "\n"
        for k, title in enumerate(titles)
    )


@pytest.mark.parametrize(
    "titles",
    [("Trace 1", "Trace 2", "Trace 3"), ("", "", ""), ("Ra = 0.5 um\nLine 1", "Line 2", "Line 3")],
)
def test_several_traces_in_a_file_are_scans_of_one_surface(tmp_path, titles):
    path = written(tmp_path, tables(*titles))
    scan = read_scans(path)
    assert scan.sizes["scan"] == 3 and set(scan.file.values) == {"line.txt"}
    assert scan.attrs["traces"] == "3"
    for k in range(3):
        np.testing.assert_allclose(scan.height[k], 1e-6 * 10**k * Z, rtol=0, atol=1e-10)
    both = read_scans([path, written(tmp_path, tables("Trace 1"), "other.txt")])
    assert list(both.file.values) == ["line.txt"] * 3 + ["other.txt"]
    assert len(read_scans(path, stack=False)) == 3


@pytest.mark.parametrize("titles", [("Raw", "Filtered"), ("Primary profile", "Roughness profile")])
def test_versions_of_one_trace_are_no_scans_of_one_surface(tmp_path, titles):
    path = written(tmp_path, tables(*titles))
    with pytest.raises(ReadError, match=f"no traces of one scan.*'{titles[0]}', '{titles[1]}'"):
        read_scans(path)


def dialect(tmp_path, *lines, value=""):
    text = "\n".join(
        ['name = "own"', 'title = "own"', *lines, '[time]\nsource = "none"', "[[column]]",
         'quantity = "height"', "position = 1", 'unit = "um"', value]
    )  # fmt: skip
    path = tmp_path / "own.toml"
    path.write_text(text)
    return path


VALUE = '[[value]]\nname = "step"\npattern = \'^dx = ([\\d.]+)\'\nunit = "um"\nto = "m"\n'


@pytest.mark.parametrize(
    "words", ["Abtastabstand", "Distancia entre puntos", "Pas d'échantillonnage", "Puntafstand"]
)
def test_the_pitch_is_known_by_its_name_in_other_languages(tmp_path, words):
    file = tmp_path / "line.txt"
    heights = "".join(f"{np.sin(n / 7):.4f}\n".replace(".", ",") for n in range(100))
    file.write_text(f"{words}: 0,25 µm\nZ [µm]\n{heights}", encoding="utf-8")
    assert np.diff(read_scans(file).x.values) == pytest.approx(2.5e-7, rel=1e-6)


def test_what_is_told_of_a_compressed_scan_names_that_file(tmp_path):
    file = tmp_path / "a.csv.gz"
    file.write_bytes(gzip.compress(b'"Horizontal","3"\n"Height"\n1,2,3\n4,5,6\n'))
    with pytest.raises(ReadError) as refused:
        read_scans(file)
    assert str(file) in str(refused.value) and "tribolab-" not in str(refused.value)


def test_a_pitch_in_the_dialect_stands_for_positions(tmp_path):
    path = written(tmp_path, COLUMN + "\n")
    scan = read_scans(path, dialect(tmp_path, 'pitch = "0.5 um"'))
    np.testing.assert_allclose(np.diff(scan.x), 0.5e-6)
    assert scan.attrs["length_m"] == pytest.approx(199 * 0.5e-6)


@pytest.mark.parametrize(
    ("lines", "value", "words"),
    [
        (['pitch = "0.5 um"', 'pitch_value = "step"'], VALUE, "not all of them"),
        (['pitch_value = "step"', 'length_value = "step"'], VALUE, "not all of them"),
        (['pitch = "-1 um"'], "", "pitch"),
        (['pitch = "1 s"'], "", "pitch"),
        (['pitch_value = "step"'], "", "there is no value 'step'"),
        (['length_value = "step"'], "", "there is no value 'step'"),
        (['pitch = "1 um"'], '[[column]]\nquantity="x"\nposition=2\nunit="mm"\n', "without one"),
    ],
)
def test_a_pitch_that_cannot_be_is_refused(tmp_path, lines, value, words):
    with pytest.raises(TribolabError, match=words):
        load_dialect(dialect(tmp_path, *lines, value=value))


def test_a_pitch_that_the_file_does_not_say_is_missed(tmp_path):
    own = dialect(tmp_path, 'pitch_value = "step"', "[header]\nskip = 1", value=VALUE)
    good = read_scans(written(tmp_path, f"dx = 0.5\n{COLUMN}\n"), own)
    assert good.attrs["pitch_m"] == pytest.approx(0.5e-6) and good.attrs["step_m"] == 0.5e-6
    with pytest.raises(ReadError, match="distance of its points is not in the file"):
        read_scans(written(tmp_path, f"none\n{COLUMN}\n"), own)


@pytest.mark.parametrize(
    ("above", "pitch"),
    [
        ("Traverse length: 0.2 mm\nNumber of points: 400", 0.5e-6),
        ("Traverse length: 0.1995 mm\nNumber of points: 400", 0.5e-6),
        ("Scan Length,0.2,mm\nData points,400", 0.5e-6),
        ("Taststrecke: 0,2 mm\nPunkte: 400", 0.5e-6),
        ("Longueur de palpage = 0,1596 mm\nNombre de points = 400", 0.4e-6),
        ("Lunghezza di scansione: 0,12 mm\nNumero di punti: 400", 0.3e-6),
        ("測定長さ: 0.2 mm\nデータ点数: 400", 0.5e-6),
    ],
)
def test_the_length_of_a_traverse_and_its_points_are_a_pitch(tmp_path, above, pitch):
    heights = "".join(f"{1000 * z:.1f}\n" for z in np.sin(np.arange(400) / 9))
    path = tmp_path / "line.txt"
    path.write_bytes(f"{above}\nHeight [nm]\n{heights}".encode())
    scan = read_scans(path)
    assert scan.sizes["x"] == 400
    assert scan.attrs["pitch_m"] == pytest.approx(pitch, rel=1e-9)


def test_a_traverse_with_other_points_than_it_has_is_asked_about(tmp_path):
    heights = "".join(f"{z:.1f}\n" for z in range(400))
    above = "Traverse length: 0.2 mm\nNumber of points: 500\nHeight [nm]\n"
    with pytest.raises(ReadError, match="the heights lie evenly over 'Traverse length"):
        read_scans(written(tmp_path, above + heights))


def test_a_total_profile_is_heights_and_of_total_and_raw_one_is_asked_for(tmp_path):
    lines = [f"{n * 0.5:.1f},{n % 7}.0,{n % 5}.5\n" for n in range(60)]
    one = "".join(",".join(line.split(",")[:2]) + "\n" for line in lines)
    scan = read_scans(written(tmp_path, "Lateral (um),Total Profile (nm)\n" + one))
    assert scan.attrs["pitch_m"] == pytest.approx(0.5e-6)
    both = "Lateral (um),Total Profile (nm),Raw Profile (nm)\n" + "".join(lines)
    with pytest.raises(ReadError, match="of several columns for height"):
        read_scans(written(tmp_path, both, "both.csv"))


GAPPED = [*map(str, Z[:50]), *["{}"] * 40, *map(str, Z[90:])]  # a fifth is missing
COUNTED = "Point spacing: 0.25 um\nPoints: 200\nHeight [{}]\n{}\n"


@pytest.mark.parametrize("mark", ["***", "nan", "---", ""])
def test_a_missing_height_keeps_its_place_where_heights_are_counted(tmp_path, mark):
    column = "\n".join(GAPPED).replace("{}", mark)
    path = written(tmp_path, COUNTED.format("um", column))
    wanted = np.where((np.arange(200) >= 50) & (np.arange(200) < 90), np.nan, 1e-6 * Z)
    target = save_draft(draft_dialect(path), tmp_path / "own.toml")
    for scan in (read_scans(path), read_scans(path, target)):
        np.testing.assert_allclose(scan.height[0], wanted, rtol=0, atol=1e-15)
    assert any("40 points without a height" in line for line in file_lines(path))


@pytest.mark.parametrize("around", ["\n\n{}\n\n\n", "{}"])
def test_empty_lines_about_heights_and_after_each_are_no_heights(tmp_path, around):
    path = written(tmp_path, COUNTED.format("um", around.format(COLUMN)))
    np.testing.assert_allclose(read_scans(path).height[0], 1e-6 * Z, rtol=0, atol=1e-15)
    path = written(tmp_path, COUNTED.format("um", around.format("\n\n".join(map(str, Z)))))
    np.testing.assert_allclose(read_scans(path).height[0], 1e-6 * Z, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("said", "unit"), [("Angstrom", 1e-10), ("Ångström", 1e-10), ("Nanometres", 1e-9)]
)
def test_a_unit_that_is_written_out_is_not_guessed(tmp_path, said, unit):
    path = written(tmp_path, COUNTED.format(said, COLUMN))
    np.testing.assert_allclose(read_scans(path).height[0], unit * Z, rtol=1e-9, atol=1e-20)


def test_columns_whose_names_differ_by_a_number_are_profiles_side_by_side(tmp_path):
    names = "\t".join(f"Profile {k}" for k in (1, 2, 3))
    rows = "\n".join(f"{z}\t{2 * z:.4f}\t{'***' if k == 7 else 3 * z}" for k, z in enumerate(Z))
    head = "Data spacing: 0.25 um\nHeight unit: nm\n"
    path = written(tmp_path, f"{head}\n{names}\n{rows}\n")
    target = save_draft(draft_dialect(path), tmp_path / "own.toml")
    for scans in (read_scans(path), read_scans(path, target)):
        assert scans.sizes == {"scan": 3, "x": 200} and "columns_not_used" not in scans.attrs
        factor = np.nanmedian(scans.height / (1e-9 * Z), axis=1)
        np.testing.assert_allclose(factor, [1, 2, 3], rtol=1e-3)
        assert np.isnan(scans.height).sum(axis=1).values.tolist() == [0, 0, 1]
    # forces with numbers are none
    path = written(tmp_path, f"{head}\nForce 1 [N]\tForce 2 [N]\tForce 3 [N]\n{rows}\n")
    with pytest.raises(TribolabError):
        read_scans(path)


def test_a_unit_that_is_not_known_is_named_in_the_guess(tmp_path):
    heights = "\n".join(f"{np.sin(k / 9):.4f}" for k in range(500))
    (tmp_path / "a.txt").write_text(f"Pitch: 0.5 um\nHeight [foo]\n{heights}\n")
    with pytest.raises(TribolabError, match="height is in um, for 'foo' is no unit that is known"):
        read_scans(tmp_path / "a.txt")


def test_points_of_a_map_that_are_left_out_are_missing_heights(tmp_path):
    """Instruments leave out what they could not measure."""
    rng = np.random.default_rng(3)
    heights = rng.standard_normal((30, 40))
    left_out = rng.random(heights.shape) < 0.2
    file = tmp_path / "map.csv"
    rows = (f"{2 * j};{2 * i};{1e3 * heights[i, j]:.3f}" for i, j in np.argwhere(~left_out))
    file.write_text("x_um;y_um;z_nm\n" + "\n".join(rows) + "\n")
    scan = read_scans(file)
    assert (np.isnan(scan.height.values) == left_out).all()
    np.testing.assert_allclose(scan.height.values[~left_out], 1e-6 * heights[~left_out], atol=1e-12)
    few = "\n".join(f"{2 * j};{2 * i};1" for i, j in np.argwhere(rng.random((30, 40)) < 0.3))
    file.write_text(f"x_um;y_um;z_nm\n{few}\n")
    with pytest.raises(TribolabError, match="do not fill a grid"):
        read_scans(file)


@pytest.mark.parametrize("along", ["x", "y"])
def test_points_of_one_line_are_a_profile(along, tmp_path):
    heights = np.sin(np.arange(200) / 9)
    places = ("{0};5" if along == "x" else "5;{0}").format
    file = tmp_path / "line.csv"
    rows = "\n".join(f"{places(2 * n)};{h:.6f}" for n, h in enumerate(heights))
    file.write_text(f"X [um];Y [um];Z [um]\n{rows}\n")
    scan = read_scans(file)
    assert scan.attrs["pitch_m"] == pytest.approx(2e-6)
    np.testing.assert_allclose(scan.height.values[0], 1e-6 * heights, atol=1e-12)


def test_heights_in_counts_are_asked_about_and_never_taken_for_lengths(tmp_path):
    file = tmp_path / "counts.txt"
    heights = "\n".join(str(n % 9) for n in range(300))
    file.write_text(f"Spacing: 0.5 um\nHeight [counts]\n{heights}\n")
    with pytest.raises(TribolabError, match="how much one count of the heights is"):
        read_scans(file)
    assert not draft_dialect(file).toml


def test_a_length_in_a_sentence_is_that_of_the_profile(tmp_path):
    file = tmp_path / "line.txt"
    heights = "\n".join(str(n % 9) for n in range(300))
    file.write_text(f"Scan length 0.15 mm, 300 points\nz/nm\n{heights}\n")
    with pytest.raises(TribolabError, match="the heights lie evenly over"):
        read_scans(file)
    named = save_draft(draft_dialect(file), tmp_path / "line.toml")
    assert read_scans(file, instrument=named).attrs["pitch_m"] == pytest.approx(0.5e-6)


def test_a_sentence_right_above_the_heights_states_their_unit(tmp_path):
    heights = "\n".join(str(n % 9) for n in range(300))
    head = "punti: 300\npasso: 0,5 um\nquote in nm, senza filtro, senza livellamento\n---\n"
    (tmp_path / "anello.txt").write_text(f"{head}{heights}\n")
    scan = read_scans(tmp_path / "anello.txt")
    np.testing.assert_allclose(scan.height.values[0], [1e-9 * (n % 9) for n in range(300)])


def test_the_form_that_was_taken_off_is_named_where_it_matters(tmp_path):
    rng = np.random.default_rng(2)
    x = np.arange(800) * 1e-6
    height = 0.01e-6 * rng.standard_normal(x.size) + (x - x.mean()) ** 2 / (2 * 0.2)
    rows = "\n".join(f"{1e3 * a:.4f};{1e6 * b:.5f}" for a, b in zip(x, height, strict=True))
    [told] = [
        line
        for line in file_lines(written(tmp_path, f"X [mm];Z [um]\n{rows}\n"))
        if line.startswith("  Pq")
    ]
    assert "circle of R = 0.2 m removed" in told and "with only the tilt removed:" in told


BARE = "\n".join(f"{1000 * z:.1f}" for z in Z)
STATED = {
    "vertical": f"# stylus tip radius: 2 um\n# traverse length: 50 um\n# points: 200\n"
    f"# spacing: 0.25 um\n# vertical: nm\n{BARE}\n",
    "blanks part name and value": f"SURFACE DATA\nInstrument      stylus\nTip radius     2 um\n"
    f"Data length     0.05 mm\nNo. of points   200\nData spacing    0.25 um\nUnits           nm\n"
    f"Filter          none (raw)\nEND OF HEADER\n{BARE}\n",
    "Finnish": f"kärjen säde; 2 um\nlateral spacing; 0.25 um\nkorkeus; nm\n{BARE}\n",
    "an unknown word": f"% Rayon de la pointe = 2 µm\n% pas = 0,25 µm\n% unidades verticais = nm\n"
    f"{BARE}\n",
    "in words": f"Tastspitzenradius\t2 µm\nMesspunktabstand\t0,25 µm\n"
    f"Einheit Messwerte\tNanometer\n[Daten]\n{BARE}\n",
    "quoted": f'"Tip diameter";"4 um"\n"Spacing";"0.25 um"\n"Unit";"nm"\n"BEGIN DATA"\n{BARE}\n',
}


@pytest.mark.parametrize("kind", STATED)
def test_what_the_header_states_of_a_trace_is_kept(tmp_path, kind):
    path = written(tmp_path, STATED[kind])
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height[0], 1e-6 * Z, rtol=0, atol=1e-10)
    assert scan.attrs["pitch_m"] == pytest.approx(0.25e-6)
    assert scan.attrs["tip_radius_m"] == pytest.approx(2e-6)
    if "200" in STATED[kind].split(BARE)[0]:
        assert scan.attrs["stated_points"] == 200
        assert scan.attrs["stated_length_m"] == pytest.approx(50e-6)
        told = "\n".join(file_lines(path))
        assert "tip radius 2 um" in told and "points 200" in told and "length 0.05 mm" in told
    kept = read_scans(path, save_draft(draft_dialect(path), tmp_path / "own.toml"))
    assert kept.attrs["tip_radius_m"] == scan.attrs["tip_radius_m"]


def test_units_across_and_up_may_stand_above_the_table(tmp_path):
    path = written(tmp_path, f"horizontal: mm\nvertical: um\nX,Z\n{ROWS}\n")
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height[0], 1e-6 * Z, rtol=0, atol=1e-15)
    assert scan.attrs["pitch_m"] == pytest.approx(0.25e-6)


@pytest.mark.parametrize("said", ["# lateral: nm", "# x unit: nm", "# cut-off unit: mm", "# id: m"])
def test_a_unit_of_something_else_is_not_that_of_the_heights(tmp_path, said):
    path = written(tmp_path, f"# spacing: 0.25 um\n{said}\n{BARE}\n")
    with pytest.raises(ReadError, match=r"it is the height in nm.*or um, mm, m"):
        read_scans(path)


def test_two_units_for_the_heights_are_asked_about(tmp_path):
    path = written(tmp_path, f"# spacing: 0.25 um\n# height: nm\n# vertical: um\n{BARE}\n")
    with pytest.raises(ReadError, match="it is the height in"):
        read_scans(path)


def test_heights_as_large_as_the_scan_do_not_pass_without_objection(tmp_path):
    path = written(tmp_path, f"# spacing: 0.25 um\n# vertical: um\n{BARE}\n")
    scan = read_scans(path)
    assert "is their unit, or that of x, right?" in scan.attrs["doubtful"]
    assert any(line.startswith("  doubtful: heights reach over") for line in file_lines(path))
    fine = read_scans(written(tmp_path, f"# spacing: 0.25 um\n# vertical: nm\n{COLUMN}\n"))
    assert "doubtful" not in fine.attrs


def test_a_file_that_states_more_points_than_it_holds_is_objected_to(tmp_path):
    path = written(tmp_path, f"# spacing: 0.25 um\n# vertical: nm\n# points: 400\n{COLUMN}\n")
    found = check_scans(read_scans(path))
    assert any("states 400 points but contains 200" in row["message"] for row in found.rows)


def test_rounding_of_positions_is_not_told(tmp_path):
    told = "\n".join(file_lines(written(tmp_path, f"X [mm],Z [um]\n{ROWS}\n")))
    assert "x_unevenness" not in told


@pytest.mark.parametrize("said", ["puuttuva arvo", "no data", "manquant", "nicht gemessen"])
def test_a_number_that_the_header_states_for_no_height_is_none(tmp_path, said):
    holed = [-5000.0 if n in (20, 21, 90) else z for n, z in enumerate(Z)]
    cells = "\n".join(f"{0.00025 * n:.5f},{z}" for n, z in enumerate(holed))
    scan = read_scans(written(tmp_path, f"{said}: -5000\nX [mm],Z [um]\n{cells}\n"))
    assert np.flatnonzero(np.isnan(scan.height.values[0])).tolist() == [20, 21, 90]
    assert np.nanmin(scan.height) > -2e-6


@pytest.mark.parametrize(
    "said",
    [
        "z scale: 0.01\nunits: um",
        "vertical magnification: 5000\nunits: mm",
        "Faktor 0,1\nEinheit: µm",
        "dz = 0.1 um\nz: um",
        "0.5 nm per digit\nunits: nm",
    ],
)
def test_a_factor_that_heights_may_miss_is_asked_about(tmp_path, said):
    whole = "\n".join(str(round(1000 * z)) for z in Z)
    with pytest.raises(ReadError, match="heights are read as they stand, not times"):
        read_scans(written(tmp_path, f"spacing: 0.25 um\n{said}\n{whole}\n"))


def test_a_lens_or_a_step_of_one_unit_is_no_factor(tmp_path):
    said = "spacing: 0.25 um\nz resolution: 1 nm\nscale: 1\nunits: nm"
    whole = "\n".join(str(round(1000 * z)) for z in Z)
    scan = read_scans(written(tmp_path, f"{said}\n{whole}\n"))
    np.testing.assert_allclose(scan.height[0], 1e-6 * Z, atol=6e-10)


@pytest.mark.parametrize(
    ("said", "encoding"),
    [
        ("Шаг: 0,25 мкм\nЕдиницы: мкм\nВысота", "cp1251"),
        ("測定ピッチ,0.25,μm\n単位,μm\n測定点数,200", "cp932"),
        ("# spacing 0.25 um\n# units um", "utf-8"),
        ("krok próbkowania: 0,25 µm\nwysokość: µm", "cp1250"),
    ],
)
def test_pitch_and_unit_are_known_in_more_languages(tmp_path, said, encoding):
    path = tmp_path / "line.txt"
    text = GERMAN if "0,25" in said else COLUMN
    path.write_bytes(f"{said}\n{text}\n".encode(encoding))
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height[0], 1e-6 * Z, rtol=0, atol=1e-15)
    assert scan.attrs["pitch_m"] == pytest.approx(0.25e-6)


def test_a_length_of_the_part_or_a_range_of_the_gauge_is_not_that_of_the_trace(tmp_path):
    said = "length: 25 mm\nrange: 80 um\nspacing: 0.25 um\nZ (um)"
    assert "stated_length_m" not in read_scans(written(tmp_path, f"{said}\n{COLUMN}\n")).attrs


HEIGHTS = np.round(2 * np.sin(np.arange(400) / 9) + np.cos(np.arange(400) * 1.7), 3)


@pytest.mark.parametrize("mark", ["***", "n.v.", "---", "н/д"])
@pytest.mark.parametrize("encoding", ["utf-8", "cp1251"])
def test_marks_of_missing_heights_stand_among_decimal_commas(tmp_path, mark, encoding):
    cells = [f"{z:.3f}".replace(".", ",") for z in HEIGHTS]
    cells[50] = cells[51] = mark
    rows = "\n".join(f"{n / 4:.2f};{z}".replace(".", ",", 1) for n, z in enumerate(cells))
    text = f"Профиль детали\n\nX (um);Z (um)\n{rows}\n"
    (tmp_path / "a.txt").write_text(text, encoding)
    scan = read_scans(tmp_path / "a.txt")
    wanted = np.where(np.isin(np.arange(400), [50, 51]), np.nan, HEIGHTS)
    np.testing.assert_allclose(scan.height.values[0], 1e-6 * wanted, atol=1e-12)


def test_signals_with_decimal_commas_keep_their_numbers_beside_marks(tmp_path):
    force = [f"{3 + n % 3 / 10:.1f}".replace(".", ",") for n in range(300)]
    force[20] = "n/a"
    rows = "\n".join(f"{n / 10:.1f};5;{f};10,0".replace(".", ",") for n, f in enumerate(force))
    (tmp_path / "a.csv").write_text(f"Zeit [s];Weg [mm];Reibkraft [N];Last [N]\n{rows}\n")
    columns = draft_dialect(tmp_path / "a.csv").understood.columns
    assert columns[2].quantity == "friction_force" and not columns[2].note


def test_a_heading_of_letters_of_two_bytes_is_found(tmp_path):
    head = "測定データ\n測定ピッチ,0.5 μm\n縦軸単位,μm\n[データ]\n"
    body = "\n".join(f"{z:.3f}" for z in HEIGHTS)
    (tmp_path / "a.csv").write_text(head + body + "\n", "cp932")
    scan = read_scans(tmp_path / "a.csv")
    np.testing.assert_allclose(scan.height.values[0], 1e-6 * HEIGHTS, atol=1e-12)
    assert scan.attrs["pitch_m"] == pytest.approx(5e-7)


def test_an_image_in_one_column_of_a_force_microscope_is_a_map(tmp_path):
    head = '\\Samps/line: 20\n\\Lines: 20\n\\Scan Size: 5000 nm\n"Height_Sensor(nm)"\n'
    (tmp_path / "a.txt").write_text(head + "\n".join(f"{z:.3f}" for z in HEIGHTS) + "\n")
    scan = read_scans(tmp_path / "a.txt")
    np.testing.assert_allclose(scan.height.values.reshape(20, 20), 1e-9 * HEIGHTS.reshape(20, 20))
    np.testing.assert_allclose([scan.x[1], scan.y[1]], 2.5e-7)


def test_a_column_of_other_than_the_stated_number_of_heights_is_no_map(tmp_path):
    head = '\\Samps/line: 20\n\\Lines: 20\n\\Scan Size: 5000 nm\n"Height_Sensor(nm)"\n'
    (tmp_path / "a.txt").write_text(head + "\n".join(f"{z:.3f}" for z in HEIGHTS[:390]) + "\n")
    with pytest.raises(TribolabError):
        read_scans(tmp_path / "a.txt")


def test_traces_of_one_file_are_checked_each(tmp_path):
    path = written(tmp_path, tables("Trace 1", "Trace 2"))
    other = written(tmp_path, tables("Trace 1"), "other.txt")
    names = [one.files[0].name for one in check_files([path, other])]
    assert names == ["line.txt, trace 1", "line.txt, trace 2", "other.txt"]


@pytest.mark.parametrize(
    "name",
    [
        *("Quote in µm", "Altezze in µm", "Hauteurs en µm", "Alturas em µm", "Wysokości w µm"),
        *("Höjder i µm", "Ordonnées en µm", "Werte in µm", "Z-Werte in µm", "Valori [µm]"),
    ],
)
def test_heights_are_known_by_their_name_in_other_languages(tmp_path, name):
    path = tmp_path / "line.txt"
    path.write_text(f"Pitch: 0,5 µm\n{name}\n{GERMAN}\n", "utf-8")
    scan = read_scans(path)
    np.testing.assert_allclose(scan.height[0], 1e-6 * Z, rtol=0, atol=1e-15)


def test_a_unit_may_be_named_before_what_it_is_of(tmp_path):
    heights = "\n".join(str(round(1e3 * z)) for z in Z)
    head = "[Intestazione]\nNumeroPunti=200\nPasso=0.25\nUnitaPasso=um\nUnitaQuota=nm\n"
    scan = read_scans(written(tmp_path, f"{head}\n[Dati]\n{heights}\n", "rullo.prf"))
    np.testing.assert_allclose(scan.height[0], 1e-6 * Z, rtol=0, atol=1e-9)
    assert scan.attrs["pitch_m"] == pytest.approx(0.25e-6)


@pytest.mark.parametrize("names", ["Abscisse (mm);Altitude (µm)", "Abszisse [mm];Höhe [µm]"])
def test_abscissae_are_positions_whatever_length_is_stated(tmp_path, names):
    rows = ROWS.replace(",", ";").replace(".", ",")
    scan = read_scans(written(tmp_path, f"Longueur palpée (mm);0,05\n\n{names}\n{rows}\n"))
    np.testing.assert_allclose(scan.height[0], 1e-6 * Z, rtol=0, atol=1e-12)


@pytest.mark.parametrize("said", ["# Unidades: mm", "Units: mm", "Einheiten; mm"])
def test_one_unit_for_a_table_is_that_of_all_its_lengths(tmp_path, said):
    rows = "\n".join(f"{0.00025 * n:.5f} {z / 1000:.7f}" for n, z in enumerate(Z))
    scan = read_scans(written(tmp_path, f"{said}\n# X Z\n{rows}\n"))
    np.testing.assert_allclose(scan.height[0], 1e-6 * Z, rtol=0, atol=1e-13)
    assert scan.attrs["pitch_m"] == pytest.approx(0.25e-6)
    two = written(tmp_path, f"{said}\n# lateral resolution unit: um\n# X Z\n{rows}\n", "two.txt")
    with pytest.raises(ReadError):
        read_scans(two)


def test_a_map_without_names_is_not_metres_wide_and_y_follows_x(shared_data):
    draft = draft_dialect(shared_data / "cases/map_without_names.csv")
    assert [column.unit for column in draft.understood.columns] == ["um", "um", "um"]
    told = corrected(draft, "x", 1, "mm")
    assert [column.unit for column in told.understood.columns[:2]] == ["mm", "mm"]
    assert not told.understood.columns[1].guessed
