"""The campaign file: what is right is read in SI, what is wrong is met with line, key and cure."""

import inspect
import json
import re

import pytest

from tribolab.campaign.settings.config import CAMPAIGN_SCHEMA_FILE, Campaign, campaign_schema
from tribolab.campaign.settings.load import load_campaign
from tribolab.campaign.settings.moved_keys import move_keys
from tribolab.campaign.settings.page import CAMPAIGN_PAGE, campaign_page
from tribolab.campaign.settings.plan import plan_runs
from tribolab.campaign.settings.toml_lines import line_of
from tribolab.core.errors import ConfigError
from tribolab.friction.segments.find import find_segments
from tribolab.friction.segments.limits import DETECTION
from tribolab.reading.dialect.find import known_dialects, load_dialect
from tribolab.reading.schema_folder import schema_folder

WHOLE = """\
[campaign]
name = "PMMA on PDMS in glycerol"
raw = "raw"

[contact]
radius = "7 cm"
length = "10 cm"
youngs_modulus = "1.5 MPa"
poisson_ratio = 0.5

[medium.glycerol]
viscosity = "1.4 Pa s"
work_of_adhesion = "51 mJ/m^2"
temperature = "20 °C"
[medium.dry]

[segments]
trim = 0.15
position_range = ["5 mm", "32 mm"]

[[surface]]
name = "Sb-R"
scans = "profiles/sb-r_*.csv"

[[run]]
files = "friction/sb-r_glycerol_31N_*.csv"
surface = "Sb-R"
medium = "glycerol"
normal_force = "31 N"
instrument = "linear_slider"

[[run]]
files = ["friction/cycle_*.csv"]
cycles = true
[run.segments]
trim = "20 %"

[qc]
fail_on = "suspect"
"""


@pytest.fixture
def folder(tmp_path):
    for name in (
        "friction/sb-r_glycerol_31N_01_force.csv",
        "friction/sb-r_glycerol_31N_01_motion.csv",
        "friction/sb-r_glycerol_31N_02_force.csv",
        "friction/sb-r_glycerol_31N_02_motion.csv",
        "friction/cycle_10.csv",
        "friction/cycle_9.csv",
        "profiles/sb-r_1.csv",
    ):
        path = tmp_path / "raw" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("never read here\n")
    return tmp_path


def load(folder, text):
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    return load_campaign(folder / "campaign.toml")


def complaint(folder, text):
    with pytest.raises(ConfigError) as caught:
        load(folder, text)
    return str(caught.value)


def test_quantities_become_si(folder):
    campaign = load(folder, WHOLE)
    assert campaign.contact.radius == 0.07
    assert campaign.contact.youngs_modulus == 1.5e6
    assert campaign.medium["glycerol"].work_of_adhesion == 0.051
    assert campaign.medium["glycerol"].temperature == 293.15
    assert campaign.segments.position_range == (0.005, 0.032)
    assert campaign.run[0].normal_force == 31.0
    assert campaign.output == folder / "results"


@pytest.mark.parametrize(
    ("after", "name", "inside", "outside"),
    [
        ("viscosity = ", "viscosity_range", '["1.2 Pa s", "1.6 Pa s"]', '["1.5 Pa s", "2 Pa s"]'),
        ("youngs_modulus = ", "youngs_modulus_range", '["1.4 MPa", "1.6 MPa"]', '["1 Pa", "2 Pa"]'),
        (
            "work_of_adhesion = ",
            "work_of_adhesion_range",
            '["5 mJ/m^2", "1 J/m^2"]',
            '["1 mJ/m^2", "2 mJ/m^2"]',
        ),
    ],
)
def test_a_range_lies_about_what_it_is_the_range_of(folder, after, name, inside, outside):
    def given(value):
        return re.sub(rf"^({after}.*)$", rf"\1\n{name} = {value}", WHOLE, count=1, flags=re.M)

    campaign = load(folder, given(inside))
    table = campaign.contact if "modulus" in name else campaign.medium["glycerol"]
    low, high = getattr(table, name)
    assert low < high
    assert f"{name}: must go from below to above" in complaint(folder, given(outside))


def test_a_clock_shift_may_be_negative_and_wants_its_unit(folder):
    def given(shift):
        return WHOLE.replace('"31 N"\n', f'"31 N"\nclock_shift = {shift}\n')

    assert [run.clock_shift for run in plan_runs(load(folder, given('"-420 ms"'))).runs] == [
        -0.42,
        -0.42,
        None,
    ]
    assert "run 1, clock_shift" in complaint(folder, given("0.42"))


def test_files_become_runs_with_names_and_settings(folder):
    runs, _ = plan_runs(load(folder, WHOLE))
    assert [run.name for run in runs] == ["sb-r_glycerol_31N_01", "sb-r_glycerol_31N_02", "cycle"]
    assert [file.name for file in runs[0].files] == [
        "sb-r_glycerol_31N_01_force.csv",
        "sb-r_glycerol_31N_01_motion.csv",
    ]
    assert [file.name for file in runs[2].files] == ["cycle_9.csv", "cycle_10.csv"]
    assert runs[0].labels[0] == "raw/friction/sb-r_glycerol_31N_01_force.csv"
    assert (runs[0].surface, runs[2].surface, runs[2].normal_force) == ("Sb-R", "", None)
    assert runs[0].segments == {"trim": 0.15, "position_range": (0.005, 0.032)}
    assert runs[2].segments == {"trim": 0.2, "position_range": (0.005, 0.032)}


def test_what_is_not_known_may_be_left_out(folder):
    text = '[campaign]\nname = "rock"\n[[run]]\nfiles = "friction/cycle_9.csv"\n'
    campaign = load(folder, text)
    assert campaign.contact.radius is None
    assert campaign.surface == ()
    assert plan_runs(campaign).runs[0].segments == {"trim": 0.10}


def test_the_settings_of_a_run_and_no_others_change_its_checksum(folder):
    def sums(text):
        return [run.config_sha256 for run in plan_runs(load(folder, text)).runs]

    before = sums(WHOLE)
    assert sums(WHOLE.replace("PMMA on PDMS", "Another title")) == before
    after = sums(WHOLE.replace('trim = "20 %"\n', "trim = 0.3\n"))
    assert (after[0] == before[0], after[2] == before[2]) == (True, False)
    after = sums(WHOLE.replace('"31 N"', '"32 N"'))
    assert (after[0] == before[0], after[2] == before[2]) == (False, True)


WRONG = {
    "unknown key": (
        "viscosity =",
        "viscosty =",
        12,
        "medium.glycerol.viscosty",
        "mean 'viscosity' or",
    ),
    "unknown table": ("[contact]", "[contakt]", 5, "contakt", "did you mean 'contact'?"),
    "unknown key of a run": ("cycles = true", "cycle = true", 34, "run 2, cycle", "'cycles'?"),
    "key in a run's own table": ('trim = "20 %"', "trimm = 0.2", 36, "segments.trimm", "'trim'?"),
    "unknown surface": ('surface = "Sb-R"', 'surface = "Sb-S"', 27, "run 1, surface", "'Sb-R'?"),
    "unknown medium": ('medium = "glycerol"', 'medium = "glycerin"', 28, "medium", "'glycerol'?"),
    "unknown instrument": (
        '"linear_slider"',
        '"linear_slidr"',
        30,
        "instrument",
        "'linear_slider'",
    ),
    "no such dialect file": ('"linear_slider"', '"my.toml"', 30, "instrument", "no such dialect"),
    "wrong unit": ('"31 N"', '"31 kg"', 29, "run 1, normal_force", "'kg' cannot be turned"),
    "no unit": ('"7 cm"', '"7"', 6, "contact.radius", "has no unit; write e.g."),
    "a bare number": ('"7 cm"', "7", 6, "contact.radius", "has no unit; write e.g. '7 cm'"),
    "a unit within a list": ('"32 mm"', '"32 s"', 19, "segments.position_range", "'s' cannot"),
    "negative radius": ('"7 cm"', '"-7 cm"', 6, "contact.radius", "not greater than zero"),
    "trim in mm": ("trim = 0.15", 'trim = "5 mm"', 18, "segments.trim", "0.1 or '10 %'"),
    "too much trim": ("trim = 0.15", "trim = 0.6", 18, "segments.trim", "less than 0.5; got 0.6"),
    "unknown choice": ('"suspect"', '"suspekt"', 39, "qc.fail_on", "did you mean 'suspect'?"),
    "a table instead of a value": ("[qc]", "[qc.fail_on]", 38, "qc.fail_on", ""),
    "nothing matches": ("sb-r_glycerol_31N_*", "sb-r_water_*", 26, "files", "cycle_10.csv"),
    "no such scans": (
        "profiles/sb-r_*",
        "scans/sb-r_*",
        23,
        "surface 1, scans",
        "friction/, profiles/",
    ),
    "the raw folder again": (
        "friction/cycle",
        "raw/friction/cycle",
        33,
        "run 2, files",
        "patterns are relative to raw/: leave 'raw/' out",
    ),
    "no raw folder": ('raw = "raw"', 'raw = "rawdata"', 3, "campaign.raw", "there is no folder"),
    "no name": ('name = "PMMA on PDMS in glycerol"', "", 1, "campaign.name", "is missing"),
    "not TOML": ('viscosity = "1.4 Pa s"', "viscosity = 1.4 Pa s", 12, "", "1.4 Pa s"),
}


@pytest.mark.parametrize(("right", "wrong", "line", "key", "cure"), WRONG.values(), ids=WRONG)
def test_a_mistake_is_met_with_file_line_key_and_cure(folder, right, wrong, line, key, cure):
    assert right in WHOLE
    said = complaint(folder, WHOLE.replace(right, wrong, 1))
    assert said.startswith(str(folder / "campaign.toml"))
    assert f"line {line}:" in said
    assert key in said
    assert cure in said


def test_all_mistakes_are_told_at_once_in_the_order_of_the_file(folder):
    said = complaint(folder, WHOLE.replace('"31 N"', '"31"').replace('"7 cm"', '"7"'))
    assert [line.split(": ")[1] for line in said.splitlines()] == [
        "contact.radius",
        "run 1, normal_force",
    ]


def test_a_file_in_two_runs_is_named_with_both(folder):
    said = complaint(folder, WHOLE.replace('"friction/cycle_*.csv"', '"friction/*_01_force.csv"'))
    assert "line 33: run 2, files" in said
    assert "raw/friction/sb-r_glycerol_31N_01_force.csv belongs to run 1 already" in said


def test_a_surface_declared_twice_is_an_error(folder):
    said = complaint(folder, WHOLE.replace("[qc]", '[[surface]]\nname = "Sb-R"\n[qc]'))
    assert "line 39: surface 2, name: 'Sb-R'" in said


def test_a_campaign_without_runs_says_so(folder):
    assert "run: is missing" in complaint(folder, '[campaign]\nname = "empty"\n')


def test_a_file_that_is_not_there_points_at_the_demo(tmp_path):
    with pytest.raises(ConfigError, match="tribolab demo"):
        load_campaign(tmp_path / "none.toml")


def test_a_file_in_another_encoding_is_one_clear_error(tmp_path):
    (tmp_path / "campaign.toml").write_bytes(b'[campaign]\nname = "\xb5m"\n')
    with pytest.raises(ConfigError, match="UTF-8"):
        load_campaign(tmp_path)


def test_brackets_in_a_real_name_are_no_wildcards(folder):
    (folder / "raw" / "run [1].csv").write_text("x")
    campaign = load(folder, '[campaign]\nname = "a"\n[[run]]\nfiles = "run [1].csv"\n')
    assert [run.name for run in plan_runs(campaign).runs] == ["run_1"]


def test_the_same_name_in_two_folders_gives_two_data_files(folder):
    for place in ("monday", "tuesday", "tuesday/Monday"):
        (folder / "raw" / place).mkdir()
        (folder / "raw" / place / "curve_µ.csv").write_text("x")
    campaign = load(folder, '[campaign]\nname = "a"\n[[run]]\nfiles = "**/curve_*.csv"\n')
    names = [run.name for run in plan_runs(campaign).runs]
    assert names == ["monday_run_curve_u", "Monday_run_curve_u_2", "tuesday_run_curve_u"]


def test_a_name_that_is_not_declared_is_told_how_to_declare_it(folder):
    name, run = '[campaign]\nname = "a"\n', '[[run]]\nfiles = "friction/*"\n'
    said = complaint(folder, name + run + 'surface = "basalt"\n')
    assert said.endswith('add [[surface]] with name = "basalt" (its scans may be left out)')
    said = complaint(folder, name + run + 'medium = "sea water"\n')
    assert said.endswith('add [medium."sea water"] (its keys may be left out)')
    load(folder, name + run + 'medium = "sea water"\n[medium."sea water"]\n')
    assert 'add [campaign] with name = "' in complaint(folder, run)
    assert "add [[run]] with files" in complaint(folder, name)


def test_a_mistake_in_the_only_run_is_one_mistake(folder):
    said = complaint(folder, '[campaign]\nname = "a"\n[[run]]\nfiles = "*"\nnormal_force = 2\n')
    assert len(said.splitlines()) == 1 and "run 1, normal_force: 2 has no unit" in said
    assert "add [[run]] with files" in complaint(folder, 'run = []\n[campaign]\nname = "a"\n')


def test_nothing_can_be_changed_after_reading(folder):
    campaign = load(folder, WHOLE)
    with pytest.raises(ValueError, match="frozen"):
        campaign.contact.radius = 1.0


def test_the_published_schema_is_the_models():
    published = json.loads((schema_folder() / CAMPAIGN_SCHEMA_FILE).read_text(encoding="utf-8"))
    assert published == campaign_schema()


def test_the_published_page_has_every_key_quantity_and_default():
    page = (schema_folder() / CAMPAIGN_PAGE).read_text(encoding="utf-8")
    assert page == campaign_page()
    assert '| `radius` | Radius of the cylinder or ball. | m | `"7 cm"` |  |' in page
    assert '| `fastest` | Highest sliding speed. | m/s | `"10 cm/s"` | `0.1` |' in page
    dialects = [load_dialect(path) for path in known_dialects().values()]
    named = {column.quantity for dialect in dialects for column in dialect.column}
    for quantity in named - {None}:  # without a quantity a column has a symbol, for formulas
        assert f"\n| `{quantity}` | " in page


def test_python_may_give_plain_numbers_in_si():
    campaign = Campaign.model_validate(
        {"campaign": {"name": "a"}, "contact": {"radius": 0.07}, "run": [{"files": "x"}]}
    )
    assert campaign.contact.radius == 0.07


@pytest.mark.parametrize(
    ("where", "line"),
    [
        (("a", "b"), 2),
        (("a", "c", "d"), 4),
        (("t", 0, "k"), 9),
        (("t", 1, "s", "k"), 13),
        (("t", 1, "absent"), 10),
        (("quoted key",), 14),
        (("absent",), None),
    ],
)
def test_keys_are_found_in_every_place_that_toml_has_for_them(where, line):
    text = (
        '[a]\nb = 1\n[a.c]\nd = """\n[t]\nk = 0\n"""\n'
        '[[t]] # first\nk = 1\n[[t]]\nk = 2\n[t.s]\nk = 3\n"quoted key" = 1\n'
    )
    if where == ("quoted key",):
        text = text.replace("[t.s]\nk = 3\n", "").replace("[[t]]\nk = 2\n", "")
        where, line = ("t", 0, "quoted key"), 10
    assert line_of(text, where) == line


MEDIUM = """[campaign]
name = "named media"
[medium.glycerol]
temperature = "23 °C"
water_content = "1 %"
[medium.oil]
liquid = "silicone oil 1000 cSt"
temperature = "25 °C"
[medium.thick]
viscosity = "1.4 Pa s"
[uncertainty.temperature]
value = "0.5 K"
as = "half-width"
[uncertainty.water_content]
value = "1 %"
as = "half-width"
[[run]]
files = "friction/*.csv"
"""


def test_a_medium_is_known_by_name_at_its_temperature(folder):
    campaign = load(folder, MEDIUM)
    glycerol = campaign.viscosity_of("glycerol")
    assert glycerol.value == pytest.approx(0.872, abs=5e-4)
    assert glycerol.error == pytest.approx(0.124, abs=0.003)
    assert glycerol.bounds[0] < 0.8 * glycerol.value and glycerol.bounds[1] > 1.2 * glycerol.value
    assert campaign.viscosity_of("oil").value == pytest.approx(0.970)
    assert campaign.viscosity_of("thick") == (1.4, 0.0, None)
    assert campaign.viscosity_of("dry") is None


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (('"23 °C"', '"230 °C"'), r"line 4: medium.glycerol.temperature: .* from 0 to 100 °C"),
        (("silicone oil 1000 cSt", "silikone oil"), "medium.oil.liquid: no liquid"),
        (("uncertainty.temperature", "uncertainty.temprature"), "did you mean 'temperature'"),
        (('"0.5 K"', '"0.5 N"'), "a value in K is wanted"),
        (('as = "half-width"', 'as = "halfwidth"'), "did you mean 'half-width'"),
    ],
)
def test_what_is_wrong_with_media_and_uncertainties_is_said(folder, change, words):
    with pytest.raises(ConfigError, match=words):
        load(folder, MEDIUM.replace(*change))


def test_true_is_no_number(folder):
    """Python takes it for 1: the middle of each stroke became all of it."""
    text = WHOLE.replace("trim = 0.15", "trim = 0.15\nstroke_middle = true")
    (folder / "campaign.toml").write_text(text)
    with pytest.raises(ConfigError, match="stroke_middle: true stands where a number or a text"):
        load_campaign(folder / "campaign.toml")


OLD = '[joint]\ncompute = "never"\ndry = "dry"\n'


def test_keys_of_the_last_release_are_moved_with_one_warning_each(folder):
    old = WHOLE.replace("[contact]\n", '[contact]\narea = "corrected"\nnormal_forces = ["9 N"]\n')
    old = old.replace("cycles = true", 'cycles = true\nmount = "2"')
    old = old.replace("trim = 0.15", 'trim = 0.15\nmin_duration = "2 s"')
    with pytest.warns(FutureWarning, match="in the next release: write") as said:
        before = load(folder, (old + OLD).replace("dry]", 'dry]\nwork_of_adhesion = "1 mJ/m^2"'))
    where = [str(one.message).partition(": ")[2].split(" will be")[0] for one in said]
    assert sorted(where) == [
        "[[run]] mount",
        "[contact] area",
        "[contact] normal_forces",
        "[joint] compute",
        "[joint] dry",
        "[segments] min_duration",
    ]
    assert before.segment_options(before.run[0])["min_duration"] == "2 s"
    assert (before.model.area, before.model.normal_forces) == ("corrected", (9.0,))
    assert (before.model.joint, before.model.dry_medium) == (False, "dry")
    assert before.run[-1].labels == {"mount": "2"}


def test_a_key_of_all_runs_moves_to_the_campaign_and_one_of_a_single_run_does_not():
    named = {"files": "a", "labels_in_name": "*_{mount}_*", "segments": {"drift": 0.2}}
    content = {"run": [dict(named), named | {"segments": {"trim": 0.1}}]}
    assert len(move_keys(content)) == 1
    assert content["campaign"] == {"files_named": "*_{mount}_*"}
    assert content["run"][0]["segments"] == {"drift": 0.2}


def test_the_limits_of_detection_are_the_defaults_of_the_function():
    parameters = inspect.signature(find_segments).parameters
    assert {name: limit.value for name, limit in DETECTION.items()} == {
        name: parameters[name].default or 0.0 for name in DETECTION
    }


def test_an_old_key_that_contradicts_the_new_one_is_refused(folder):
    text = WHOLE.replace("[contact]\n", '[contact]\narea = "corrected"\n')
    assert "line 6: contact.area: unknown key" in complaint(
        folder, f'{text}[model]\narea = "persson"\n'
    )
