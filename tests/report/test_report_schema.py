"""The published schema of report.json is generated from the types that it is made of."""

import json

from tribolab.reading.schema_folder import schema_folder
from tribolab.records.surfaces.surface_rows import ADHESION, CONTACT, ROUGHNESS
from tribolab.report.document.models import SHEAR_STRESS
from tribolab.report.document.schema import REPORT_SCHEMA_FILE, report_schema

SCHEMA = json.loads((schema_folder() / REPORT_SCHEMA_FILE).read_text("utf-8"))
DEFS = SCHEMA["$defs"]


def objects(part):
    """Every object in a part of a schema whose fields are named."""
    if isinstance(part, dict):
        if "properties" in part:
            yield part
        part = list(part.values())
    if isinstance(part, list):
        for inner in part:
            yield from objects(inner)


def test_the_published_schema_is_the_types():
    assert report_schema() == SCHEMA


def test_every_object_is_closed_and_has_all_its_fields():
    for name, part in DEFS.items():
        assert part["additionalProperties"] is False, name
        assert set(part["required"]) == set(part["properties"]), name
        assert part["description"], name
    assert set(SCHEMA["required"]) == set(SCHEMA["properties"])
    assert all(part["required"] for part in objects(SCHEMA))


def test_rows_have_the_columns_of_their_tables():
    surface = DEFS["ReportedSurface"]["properties"]
    [roughness] = objects(surface["roughness"])
    assert list(roughness["properties"]) == ROUGHNESS
    for name, columns in (("contact", CONTACT), ("adhesion", ADHESION)):
        assert list(surface[name]["items"]["properties"]) == columns
    [fit] = objects(DEFS["ReportedModel"]["properties"]["fit"])
    assert set(fit["properties"]) > set(SHEAR_STRESS[4:])
    assert len(SHEAR_STRESS) == 14


def test_every_error_says_what_it_holds():
    told = [
        (name, value.get("description", ""))
        for part in objects(SCHEMA)
        for name, value in part["properties"].items()
        if name == "sem" or name.endswith("friction_coefficient_sem")
    ]
    assert len(told) >= 4
    assert [name for name, words in told if "within the run" not in words] == []
