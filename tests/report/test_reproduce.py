"""The paper reproduced: every number has a status, every figure its words, the page opens."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from report_pages import BY_LOOKS, Reader, faults_of
from typer.testing import CliRunner

import tribolab
from tribolab import cli
from tribolab.app.reported import USAGE
from tribolab.core.provenance import sha256_of_file
from tribolab.paper.figures import COMPUTED, FIGURES, SIMULATED
from tribolab.paper.laboratory import Laboratory
from tribolab.paper.reproduce import reproduce
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.studies import xu2026
from tribolab.studies.tally import STUDY_STATUSES
from tribolab.studies.verdict import INCONSISTENT, MEASURED, NARROW, REPRODUCED, WIDE, room_text
from tribolab.studies.xu2026 import CITATION
from tribolab.surface.moments import rms_slope
from tribolab.surface.self_affine import tabulate

# one load, three speeds, one profile: as few as still make every figure
SMALL = Laboratory(loads=(31.0,), speeds=(4.64e-6, 1e-4, 2.15e-3), scans=1)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return reproduce(tmp_path_factory.mktemp("paper") / "out", jobs=1, laboratory=SMALL)


@pytest.fixture(scope="module")
def page(made):
    return (made.folder / "paper.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_every_published_number_has_a_status_and_a_reason_if_it_does_not_hold(made, shared):
    table = pd.read_csv(made.folder / "paper.csv", keep_default_na=False)
    targets = pd.read_csv(shared / "targets.csv")
    columns = ["quantity", "surface", "condition"]
    assert table[columns].values.tolist() == targets[columns].values.tolist()
    assert set(table.status) == set(STUDY_STATUSES)
    told = json.loads((made.folder / "paper.json").read_text())["verdict"]
    assert told["counts"] == {status: (table.status == status).sum() for status in STUDY_STATUSES}
    wide = table[table.status == WIDE].tolerance.astype(float)
    assert all(room_text(room) in told["text"] for room in wide) and wide.min() > NARROW
    unlike = table[table.status != REPRODUCED]
    assert unlike.note.str.split().str.len().min() >= 5
    computed = table[~table.status.isin([INCONSISTENT, MEASURED])]
    assert (computed.computed != "").all() and (computed.tolerance != "").all()


@pytest.mark.slow
def test_every_figure_is_there_with_its_origin_its_numbers_and_its_words(made, page):
    said = {image["alt"] for image in Reader(page).all("img")}
    records = json.loads((made.folder / "paper.json").read_text())["figures"]
    assert [one["name"] for one in records] == [one.name for one in FIGURES]
    for one in records:
        assert (made.folder / one["file"]).read_text().startswith("<?xml")
        assert len(pd.read_csv(made.folder / one["data"])) >= 2
        assert one["alt"] in said and re.search(r"\d", one["alt"].removeprefix(one["title"]))
        assert one["kinds"] and set(one["kinds"]) <= {COMPUTED, SIMULATED}


@pytest.mark.slow
def test_every_data_file_says_what_it_was_made_from(made):
    files = sorted((made.folder / "data").glob("*.nc"))
    assert {path.name.partition("_")[0] for path in files} >= {"curve", "dry", "wet", "spectrum"}
    sums = {path.name: sha256_of_file(path) for path in made.folder.glob("simulated/raw/*/*")}
    for path in files:
        attrs = read_netcdf(path).attrs
        assert len(attrs["config_sha256"]) == 64 and attrs["Conventions"] and attrs["history"]
        assert attrs["tribolab_version"] == tribolab.__version__
        if path.name.startswith(("dry_", "wet_")):  # from constants: there is no file
            assert attrs["source"] == CITATION and "source_sha256" not in attrs
        else:
            names = [Path(name).name for name in attrs["source"].split("; ")]
            assert attrs["source_sha256"].split("; ") == [sums[name] for name in names]


@pytest.mark.slow
def test_a_bound_is_met_or_not_and_has_no_percentage(made, page):
    document = json.loads((made.folder / "paper.json").read_text())
    said = {row["quantity"]: row for row in document["numbers"] if row["difference"]}
    onset = said["boundary_onset_speed"]
    assert onset["difference"] == "within the bound, or above it by a factor of 7.4"
    assert onset["status"] == WIDE
    assert said["macroscopic_work_of_adhesion"]["difference"] == "within the bound"
    assert said["viscoelastic_friction"]["difference"] == "above the bound"
    assert said["shear_stress"]["difference"] == "inconsistent with other printed numbers"
    assert all(row["relative_difference"] is None for row in said.values())
    table = page[page.index('id="numbers-table"') :].partition("</table>")[0]
    (cells,) = re.findall(r"boundary onset speed</a>.*?</tr>", table, re.S)
    assert "within the bound" in cells and "±" not in cells


@pytest.mark.slow
def test_each_number_stands_once_at_its_place(made):
    rows = json.loads((made.folder / "paper.json").read_text())["numbers"]
    claimed = [sum(figure.has(row) for figure in FIGURES) for row in rows]
    assert max(claimed) == 1
    for figure in FIGURES:
        assert any(row["figure"] == figure.name for row in rows) == bool(figure.claims)


@pytest.mark.slow
def test_exponents_above_1_are_judged_and_the_slope_they_promise_is_the_spectrum_s(made, page):
    steep = json.loads((made.folder / "paper.json").read_text())["steep_spectra"]
    assert [one["surface"] for one in steep] == list(xu2026.surfaces)
    for one in steep:
        law = xu2026.surface(one["surface"]).spectrum
        slope, longer, endless = (
            rms_slope(tabulate(replace(law, high=high), 1201))
            for high in (law.high, 2 * np.pi / one["half_slope_wavelength"], 1e6 * law.high)
        )
        assert (longer / slope) ** 2 == pytest.approx(0.5, rel=1e-3)
        gained = endless / slope - 1
        assert gained == pytest.approx(one["slope_beyond"], rel=0.1)
    text = page[page.index('id="topography"') :]
    assert text.index("not a self-affine fractal") < text.index('id="adhesion"')


@pytest.mark.slow
def test_shifted_traces_say_how_far_and_taking_it_off_gives_the_measured_friction(made):
    for file in sorted((made.folder / "figures").glob("*_wet.csv")):
        for label, drawn in pd.read_csv(file).groupby("series"):
            surface, medium, _ = label.split(", ")
            [curve] = [
                curve
                for path in (made.folder / "data").glob("curve_*.nc")
                if (curve := read_netcdf(path)).attrs["surface"] == surface
                and curve.attrs["medium"] == medium
            ]
            shift = drawn["shift"].iloc[0]
            assert shift == round(shift, 3)
            mean = (drawn.shifted - shift).mean()
            assert mean == pytest.approx(float(curve.friction_coefficient[0]), rel=0.1)


@pytest.mark.slow
def test_shear_stress_given_to_the_rig_comes_back(made):
    fits = pd.read_csv(made.folder / "data" / "shear_stress.csv")
    assert fits.surface.tolist() == ["Sb-S", "Sb-R"]
    assert fits.printed_shear_stress_Pa.between(
        fits.shear_stress_low_Pa, fits.shear_stress_high_Pa
    ).all()


@pytest.mark.slow
def test_page_asks_nothing_of_the_network_and_its_links_lead_somewhere(made, page):
    reader = Reader(page)
    ids = [attrs["id"] for _, attrs in reader.elements if "id" in attrs]
    assert len(ids) == len(set(ids))
    for tag, attrs in reader.elements:
        assert attrs.get("src", "data:").startswith("data:"), tag
    for link in reader.all("a"):
        target = link["href"]
        assert target[1:] in ids if target.startswith("#") else (made.folder / target).is_file()
    policy = next(meta for meta in reader.all("meta") if "http-equiv" in meta)["content"]
    assert "default-src 'none'" in policy and "unsafe" not in policy


@pytest.mark.slow
def test_page_opens_in_a_browser_without_a_word_or_a_fault(made, browser):
    address = (made.folder / "paper.html").as_uri()
    for width, dark, rules in ((1400, False, ""), (400, True, BY_LOOKS)):
        with browser.page(address, width, 900, dark) as page:
            sizes = page.run(
                "Promise.all(Array.from(document.images, i => { i.loading = 'eager';"
                "return i.decode().then(() => i.naturalWidth) }))"
            )
            assert len(sizes) == len(FIGURES) and min(sizes) > 200
            assert page.run("document.documentElement.scrollWidth") <= width
            assert faults_of(page, rules) == []
            page.click("#numbers-table th:nth-child(6) button")
            status = page.run(
                "Array.from(document.querySelectorAll('#numbers-table tbody tr'),"
                "row => Number(row.cells[5].dataset.sort || 'NaN')).filter(x => x === x)"
            )
            assert status == sorted(status) and len(status) > 40
            assert page.console == []
            assert page.requests == [address]


def test_a_folder_with_something_else_is_refused_before_any_work(tmp_path):
    (tmp_path / "thesis.tex").write_text("years of work")
    done = CliRunner().invoke(cli.app, ["reproduce", "-o", str(tmp_path), "-q"])
    assert done.exit_code == USAGE
    assert "thesis.tex" in done.output and "--output" in done.output
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


@pytest.mark.slow
def test_interrupted_it_leaves_what_was_there(made):
    before = {path: path.stat().st_mtime_ns for path in made.folder.rglob("*")}

    def stop(stage, done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        reproduce(made.folder, jobs=1, laboratory=SMALL, progress=stop)
    assert {path: path.stat().st_mtime_ns for path in made.folder.rglob("*")} == before
    assert [path.name for path in made.folder.parent.iterdir()] == ["out"]
