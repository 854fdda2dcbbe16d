"""Table Schemas: the files are such schemas, and every broken rule is found where it is broken."""

import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from tribolab.core.errors import ConfigError
from tribolab.reading.netcdf.table_schema import load_schema, validate
from tribolab.reading.run_files import read
from tribolab.reading.scan_files import read_scans
from tribolab.reading.schema_folder import schema_folder
from tribolab.units.quantities import QUANTITIES
from tribolab.units.stamping import stamp

ONTOLOGY = "https://www.iam.kit.edu/cms/download/TriboDataFAIR_Ontology.owl#"
# classes of the TriboDataFAIR ontology, as they stand in its OWL file
CLASSES = {
    "TimeDuration",
    "ForceMagnitude",
    "DistanceMagnitude",
    "TemperatureMagnitude",
    "VoltageMagnitude",
    "SlidingSpeedSetpoint",
    "NormalLoadSetpoint",
    "SequentialOrderPositionNumber",
}
# Table Schema specification: types, and the constraints that each of them may have
COMMON = {"required", "unique", "enum"}
ORDERED = COMMON | {"minimum", "maximum", "exclusiveMinimum", "exclusiveMaximum"}
CONSTRAINTS = {"number": ORDERED, "integer": ORDERED, "string": COMMON | {"pattern"}}


def fields(name):
    return load_schema(name)["fields"]


@pytest.mark.parametrize("name", ["run", "scan"])
def test_the_files_are_table_schemas(name):
    schema = json.loads((schema_folder() / f"{name}.schema.json").read_text(encoding="utf-8"))
    assert isinstance(schema["fields"], list) and schema["fields"]
    names = [field["name"] for field in schema["fields"]]
    assert len(set(names)) == len(names)
    assert set(schema.get("primaryKey", [])) <= set(names)
    assert schema["fieldsMatch"] in ("exact", "equal", "subset", "superset", "partial")
    assert all(isinstance(text, str) for text in schema["missingValues"])
    for field in schema["fields"]:
        for key in ("name", "title", "description", "type", "unit"):
            assert isinstance(field[key], str) and field[key], (field["name"], key)
        constraints = field.get("constraints", {})
        assert set(constraints) <= CONSTRAINTS[field["type"]]
        low, high = constraints.get("minimum", -np.inf), constraints.get("maximum", np.inf)
        assert low < high
        for flag in ("required", "unique"):
            assert isinstance(constraints.get(flag, True), bool)


@pytest.mark.parametrize("name", ["run", "scan"])
def test_names_and_units_are_those_of_the_dictionary(name):
    for field in fields(name):
        known = QUANTITIES[field["name"]]
        assert (field["unit"], field["title"]) == (known.unit, known.long_name)


def test_every_signal_of_a_run_is_described():
    """The dictionary lists the signals of a run first; `segment` is the first of what follows."""
    names = list(QUANTITIES)
    signals = {*names[: names.index("segment")], "friction_coefficient"}
    assert {field["name"] for field in fields("run")} == signals


def test_terms_stand_in_the_ontology():
    terms = {f["rdfType"] for name in ("run", "scan") for f in fields(name) if "rdfType" in f}
    assert terms == {ONTOLOGY + name for name in CLASSES}


def good(rows=50):
    """A table with every column of a run, all within its limits."""
    table = {}
    for field in fields("run"):
        limits = field.get("constraints", {})
        low, high = limits.get("minimum", -1.0), limits.get("maximum", 1.0)
        bottom = max(low, -1)
        table[field["name"]] = np.linspace(bottom, max(bottom, min(high, 1)), rows)
        if field["type"] == "integer":
            table[field["name"]] = np.arange(rows)
    return pd.DataFrame(table)


LIMITS = [
    (field["name"], key, limit)
    for field in fields("run")
    for key, limit in field.get("constraints", {}).items()
    if key in ("minimum", "maximum")
]


def test_a_good_table_breaks_no_rule():
    found = validate(good())
    assert not found and found.total == 0 and str(found) == "as the schema says"
    assert found.table().empty


@pytest.mark.parametrize(("column", "constraint", "limit"), LIMITS)
def test_every_limit_is_found_at_its_row(column, constraint, limit):
    table = good()
    beyond = np.nextafter(float(limit), -np.inf if constraint == "minimum" else np.inf)
    at = table.astype({column: float})
    at.loc[17, column] = float(limit)
    if column != "time":
        assert not validate(at)  # the limit itself is allowed
    at.loc[17, column] = beyond
    found = [one for one in validate(at).first() if one.constraint == constraint]
    assert [(one.row, one.column, one.value, one.limit) for one in found] == [
        (17, column, beyond, limit)
    ]


def test_a_missing_and_a_repeated_time_are_found():
    table = good()
    table.loc[[3, 8], "time"] = np.nan
    table.loc[30, "time"] = table.loc[29, "time"]
    rows = [(one.row, one.constraint) for one in validate(table).first()]
    assert rows == [(3, "required"), (8, "required"), (30, "unique")]
    missing = validate(table.drop(columns="time"))
    assert str(missing) == "column 'time' is missing" and missing.total == 1


def test_a_number_that_is_not_whole_and_a_text_are_found():
    table = good().astype({"step": float})
    table.loc[5, "step"] = 1.5
    assert [(v.row, v.constraint) for v in validate(table).first()] == [(5, "type")]
    table = good().astype({"temperature": object})
    table.loc[7, "temperature"] = "hot"
    [one] = validate(table).first()
    assert (one.row, one.column, one.value, one.limit) == (7, "temperature", "hot", "number")
    table.loc[7, "temperature"] = ""
    assert not validate(table)  # an empty text is a missing value


def test_another_unit_is_found_before_its_numbers_are_judged():
    run = xr.Dataset({"normal_force": ("time", [1e9, 2e9])}, {"time": [0.0, 1.0]})
    run.normal_force.attrs["units"] = "mN"
    [one] = validate(run).first()
    assert (one.row, one.constraint, one.value, one.limit) == (None, "unit", "mN", "N")
    assert [v.constraint for v in validate(stamp(run)).first()] == ["maximum", "maximum"]


def test_other_constraints_of_a_schema_of_your_own(tmp_path):
    schema = {
        "fields": [
            {"name": "medium", "type": "string", "constraints": {"enum": ["dry", "glycerol"]}},
            {"name": "sample", "type": "string", "constraints": {"pattern": "S[0-9]+"}},
            {"name": "load", "type": "number", "constraints": {"exclusiveMinimum": 0}},
            {"name": "ratio", "type": "number", "constraints": {"exclusiveMaximum": 1}},
        ]
    }
    path = tmp_path / "own.json"
    path.write_text(json.dumps(schema))
    table = pd.DataFrame(
        {
            "medium": ["dry", "oil", None],
            "sample": ["S1", "S22", "T3"],
            "load": [0.0, 1.0, 2.0],
            "ratio": [0.5, 0.9, 1.0],
        }
    )
    found = validate(table, path)
    assert [(one.column, one.row) for one in found.first()] == [
        ("medium", 1),
        ("sample", 2),
        ("load", 0),
        ("ratio", 2),
    ]


def test_a_schema_that_cannot_be_checked_is_refused():
    with pytest.raises(ConfigError, match="'run'"):
        validate(good(), "rum")
    field = {"name": "time", "constraints": {"minimun": 0}}
    with pytest.raises(ConfigError, match="did you mean 'minimum'"):
        validate(good(), {"fields": [field]})


def test_no_more_than_a_screenful_is_shown_and_the_rest_is_counted():
    table = good(20_000)
    table["normal_force"] = -1e9
    found = validate(table)
    lines = str(found).splitlines()
    assert found.total == 20_000 and len(lines) == 21
    assert lines[0] == "column 'normal_force', row 0: -1e+09, but minimum is -1000"
    assert lines[-1] == "and 19 980 more"
    assert len(found.table()) == 20_000


@given(
    bad=st.dictionaries(st.integers(0, 199), st.sampled_from([-2e6, 2e6, np.inf]), max_size=30),
    gaps=st.sets(st.integers(200, 299), max_size=10),
)
@settings(max_examples=60, deadline=None)
def test_all_that_is_broken_is_found_and_nothing_else(bad, gaps):
    force = np.zeros(300)
    force[list(bad)] = list(bad.values())
    force[list(gaps)] = np.nan  # a gap in a signal is no violation
    run = stamp(xr.Dataset({"friction_force": ("time", force)}, {"time": np.arange(300.0)}))
    table = validate(run).table()
    assert dict(zip(table["row"], table["value"], strict=True)) == bad
    frame = run.to_dataframe()  # time is the index there
    assert validate(frame).table().equals(table)


@given(values=st.lists(st.floats(-1.0, 1.0), min_size=2, max_size=40))
@settings(max_examples=40, deadline=None)
def test_what_passes_passes_again_after_a_round_trip_as_text(values):
    table = pd.DataFrame({"time": np.arange(len(values), dtype=float), "position": values})
    text = table.astype(str).astype(object)
    assert not validate(table) and not validate(text)


def test_real_runs_and_scans_are_as_the_schemas_say(shared_data):
    runs = [
        "actuator_friction_CC0/Circle_1bar.csv",
        "rock_velstep_MIT/velstep4_BRAVA_expb819_basalt.txt",
        "cetr_umt2_MIT/HT-2n-6-4 2_001.csv",
        "pcs_mtm_ehd_MIT/demo_12.txt",
        "pcs_mtm_ehd_MIT/demo_5.txt",
        "pcs_mtm_ehd_MIT/trios_demo.txt",
        "stickslip_paper_CeCILL-B/k168Nm_v4300.mat",
    ]
    for file in runs:
        assert str(validate(read(shared_data / file))) == "as the schema says", file
    for file in ("bearing_profiles_MIT/NU206-RE-1.txt", "surfacetopography_MIT/dektak-1.csv"):
        assert str(validate(read_scans(shared_data / file), "scan")) == "as the schema says", file
    taken_for_metres = read_scans(shared_data / "bearing_profiles_MIT/NU206-RE-1.txt") * 1e6
    assert validate(taken_for_metres, "scan").total > 7000
