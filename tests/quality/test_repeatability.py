"""Components of variance: published studies, two estimators beside each other, and their limits."""

import numpy as np
import pandas as pd
import pytest
from campaigns import copied
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.campaign.settings.name_pattern import NamePattern
from tribolab.comparison.labels import labelled_segments
from tribolab.metrology.gauge_study import gauge_study
from tribolab.metrology.precision import mandel, mandel_limits
from tribolab.metrology.reml import variance_components

# AIAG, Measurement Systems Analysis: ten parts, three appraisers, three trials
AIAG = """
0.29 -0.56 1.34 0.47 -0.80 0.02 0.59 -0.31 2.26 -1.36
0.41 -0.68 1.17 0.50 -0.92 -0.11 0.75 -0.20 1.99 -1.25
0.64 -0.58 1.27 0.64 -0.84 -0.21 0.66 -0.17 2.01 -1.31
0.08 -0.47 1.19 0.01 -0.56 -0.20 0.47 -0.63 1.80 -1.68
0.25 -1.22 0.94 1.03 -1.20 0.22 0.55 0.08 2.12 -1.62
0.07 -0.68 1.34 0.20 -1.28 0.06 0.83 -0.34 2.19 -1.50
0.04 -1.38 0.88 0.14 -1.46 -0.29 0.02 -0.46 1.77 -1.49
-0.11 -1.13 1.09 0.20 -1.07 -0.67 0.01 -0.56 1.45 -1.77
-0.15 -0.96 0.67 0.11 -1.45 -0.49 0.21 -0.49 1.87 -2.16
"""


@pytest.fixture(scope="module")
def aiag():
    rows = np.array([[float(cell) for cell in row.split()] for row in AIAG.split("\n") if row])
    return rows.reshape(3, 3, 10).transpose(2, 0, 1)


def test_the_published_analysis_of_variance(aiag):
    study = gauge_study(aiag)
    assert study.pooled and study.interaction_p_value == pytest.approx(0.974, abs=5e-4)
    assert study.repeatability == pytest.approx(0.03997, abs=5e-6)
    assert study.reproducibility == pytest.approx(0.05146, abs=5e-6)
    assert study.parts == pytest.approx(1.0864, abs=5e-5)
    assert study.study_variation == pytest.approx(0.2786, abs=5e-5)
    assert study.categories == 4


def test_restricted_likelihood_is_the_analysis_of_variance_where_data_are_balanced(aiag):
    study = gauge_study(aiag)
    part, appraiser, _ = np.indices(aiag.shape)
    factors = [part.ravel(), appraiser.ravel(), (10 * part + appraiser).ravel()]
    fitted = variance_components(aiag.ravel(), factors)
    # with an interaction that would be negative the summit lies at zero: pooled
    wanted = (study.parts, study.appraisers, 0.0)
    assert fitted.factors == pytest.approx(wanted, rel=1e-4, abs=1e-6)
    assert fitted.residual == pytest.approx(study.repeatability, rel=1e-4)


def test_a_nested_design_has_its_closed_form():
    rng = np.random.default_rng(3)
    a, b, n = 12, 4, 3
    y = rng.normal(0, 2, (a, 1, 1)) + rng.normal(0, 1, (a, b, 1)) + rng.normal(0, 0.5, (a, b, n))
    cell, day = y.mean(axis=2), y.mean(axis=(1, 2))
    within = ((y - cell[:, :, None]) ** 2).sum() / (a * b * (n - 1))
    mounts = n * ((cell - day[:, None]) ** 2).sum() / (a * (b - 1))
    days = b * n * ((day - y.mean()) ** 2).sum() / (a - 1)
    i, j, _ = np.indices(y.shape)
    fitted = variance_components(y.ravel(), [i.ravel(), (i * b + j).ravel()])
    assert fitted.residual == pytest.approx(within, rel=1e-4)
    assert fitted.factors == pytest.approx(
        ((days - mounts) / (b * n), (mounts - within) / n), rel=1e-3
    )


@pytest.mark.slow
def test_unbalanced_components_are_right_on_average():
    rng = np.random.default_rng(4)
    mount = np.repeat(np.arange(8), [2, 5, 3, 2, 6, 2, 4, 3])
    fits = [
        variance_components(rng.normal(0, 0.3, 8)[mount] + rng.normal(0, 0.2, mount.size), [mount])
        for _ in range(100)
    ]
    between, within = (np.mean([f.factors[0] for f in fits]), np.mean([f.residual for f in fits]))
    assert between == pytest.approx(0.09, rel=0.2) and within == pytest.approx(0.04, rel=0.1)


def test_mandels_limits_are_those_of_the_standard():
    # ISO 5725-2, tables 6 and 7: p = 8, n = 2, at 1 % and 5 %
    assert mandel_limits(8, 2, 0.01) == pytest.approx((2.06, 2.25), abs=0.011)
    assert mandel_limits(8, 2, 0.05) == pytest.approx((1.75, 1.88), abs=0.011)
    h, k = mandel([1.0, 1.0, 1.0, 1.6], [0.1, 0.1, 0.1, 0.1])
    assert h[3] == pytest.approx(1.5) and k == pytest.approx(np.ones(4))


def measured(rng, mounts=6, runs=3, between=0.04, within=0.02):
    """Runs on mounts at two speeds, in two conditions."""
    rows = []
    for medium, mean in (("dry", 1.0), ("water", 0.4)):
        for mount in range(mounts):
            off = rng.normal(0, between)
            for run in range(runs):
                for speed in (1e-4, 1e-3):
                    mu = mean * (1 + off + rng.normal(0, within))
                    rows.append((f"{medium}{mount}{run}", medium, f"m{mount}", speed, mu))
    names = ["run", "medium", "mount", "sliding_speed_m_s", "friction_coefficient"]
    return pd.DataFrame(rows, columns=names)


def test_components_are_told_per_speed_and_pooled():
    told = tl.comparison.repeatability(
        measured(np.random.default_rng(5), mounts=40), "medium:mount"
    )
    assert told.method == "restricted maximum likelihood"
    shown = told._repr_html_()
    assert "by medium:mount" in shown and shown.count("<tr") == 1 + len(told.table)
    last = told.table.iloc[-1]
    assert told.table.speed.tolist() == ["100 µm/s", "1 mm/s", "all speeds"]
    assert last.repeatability_std == pytest.approx(0.02, rel=0.15)
    assert last["between_medium:mount_std"] == pytest.approx(0.04, rel=0.2)
    assert last.reproducibility_limit == pytest.approx(2.8 * last.reproducibility_std)
    crossed = tl.comparison.repeatability(measured(np.random.default_rng(5)), "mount")
    assert crossed.method.startswith("analysis of variance")


@pytest.mark.parametrize(
    "by, says",
    [
        ("operator", "nothing says which operator a run belongs to; write it in"),
        (
            "own",
            "every run has a level of own of its own, which cannot be separated from repeatability",
        ),
        ("mount,twin", "mount and twin change together"),
        ("rig", "the same rig: there is nothing to compare"),
    ],
)
def test_what_cannot_be_told_apart_is_refused(by, says):
    table = measured(np.random.default_rng(6))
    table = table.assign(twin=table.mount + "t", rig="a", own=table.run)
    with pytest.raises(tl.TribolabError, match=says):
        tl.comparison.repeatability(table, by)


@pytest.mark.parametrize(
    "pattern, name, labels",
    [
        ("*_{mount}_{operator}", "sb-r_dry_m2_ann", {"mount": "m2", "operator": "ann"}),
        ("{specimen}-*", "A7-x_1", {"specimen": "A7"}),
        ("{surface}_{mount}", "a_b_c", {"surface": "a_b", "mount": "c"}),
        ("{mount}_{operator}", "a", {}),
    ],
)
def test_labels_stand_in_names(pattern, name, labels):
    assert NamePattern(pattern).labels(name) == labels


def test_a_pattern_of_others_ends_in_time():
    slow = NamePattern("*" * 6 + "{a}x")
    assert slow.labels("a" * 5000) == {}
    for wrong in ("*", "{a}_{a}", "{a b}", "*" * 7 + "{a}"):
        with pytest.raises(ValueError):
            NamePattern(wrong)


def test_labels_come_from_the_campaign_file_as_it_is_now(original, tmp_path):
    file = copied(original, tmp_path)
    text = file.read_text("utf-8")
    assert labelled_segments(file).day.iloc[0][:4].isdigit(), "the day is that of the files"
    text = text.replace("[[run]]\n", '[[run]]\nlabels.batch = "7"\n')
    text = text.replace("[campaign]\n", '[campaign]\nfiles_named = "*_31N_{mount}_*"\n')
    file.write_text(text, "utf-8")
    table = labelled_segments(file)
    assert set(table.mount) == {"01", "02"} and set(table.batch) == {"7"}
    done = CliRunner().invoke(
        cli.app, ["lab", "repeatability", str(file), "--by", "mount", "-o", str(tmp_path / "out")]
    )
    assert done.exit_code == 0 and "between levels of mount" in done.stdout, done.stderr


def test_the_command_writes_a_page_and_its_tables(tmp_path, monkeypatch):
    table = measured(np.random.default_rng(7))
    monkeypatch.setattr("tribolab.comparison.repeat_study.labelled_segments", lambda place: table)
    done = CliRunner().invoke(cli.app, ["lab", "repeatability", "x", "-o", str(tmp_path / "out")])
    assert done.exit_code == 0, done.stderr
    assert "between levels of mount" in done.stdout
    page = (tmp_path / "out/repeatability.html").read_text("utf-8")
    assert "95 of 100 pairs differ by less than" in page
    assert "There were only" not in page, "six mounts are enough"
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {"repeatability.html", "repeatability.csv", "mandel.csv"}
