"""The schema of report.json is that of the records: no field more or less, of the same types."""

import dataclasses
import json
from pathlib import Path

import pytest
from pydantic import TypeAdapter

import tribolab
from tribolab.records.mode_record import EvidenceRow, ModeRecord
from tribolab.records.part_records import FigureRecord
from tribolab.records.parts import FlaggedSpan, ModelOutcome, RunOutcome, SurfaceOutcome
from tribolab.records.run_record import (
    CheckRow,
    DecisionRow,
    Highlight,
    LeftOut,
    RunFacts,
    Waveform,
)
from tribolab.records.surface_rows import ADHESION, CONTACT, ROUGHNESS
from tribolab.report.document import SCHEMA_VERSION

SCHEMA = json.loads(
    (Path(tribolab.__file__).parents[1] / "raw_data_schema/report.schema.json").read_text("utf-8")
)
DEFS = SCHEMA["$defs"]
RUN, SURFACE, MODE = (DEFS[name]["properties"] for name in ("run", "surface", "sliding_mode"))
NOTHING = frozenset()
# A record, where the schema has it, fields that only the program needs, and what is put beside
RECORDS = [
    (RunFacts, RUN, NOTHING, {f.name for f in dataclasses.fields(RunOutcome)}
     | {"nominal_normal_force_N", "segments_found"}),
    (RunOutcome, RUN, {"normal_force", "segments"}, set(RUN)),
    (Highlight, RUN["highlights"]["items"]["properties"], NOTHING, NOTHING),
    (LeftOut, RUN["omitted"]["items"]["properties"], NOTHING, NOTHING),
    (CheckRow, RUN["checks"]["items"]["properties"], NOTHING, NOTHING),
    (DecisionRow, RUN["decisions"]["items"]["properties"], NOTHING, NOTHING),
    (FlaggedSpan, RUN["flagged"]["items"]["properties"], NOTHING, NOTHING),
    (Waveform, RUN["stick_slip"]["properties"], {"class_"}, {"class"}),
    (FigureRecord, DEFS["figure"]["properties"], NOTHING, NOTHING),
    (SurfaceOutcome, SURFACE, {"parts", "findings"},
     {"roughness", "contact", "adhesion", "modulus", "validity"}),
    (ModelOutcome, DEFS["model"]["properties"], {"parts", "findings", "normal_force"},
     {"normal_force_N", "fit", "sensitivity", "not_varied", "validity"}),
    (ModeRecord, MODE, {"moves"}, {"surface", "medium", "nominal_normal_force_N"}),
    (EvidenceRow, MODE["evidence"]["items"]["properties"], NOTHING, NOTHING),
]  # fmt: skip


@pytest.mark.parametrize(("record", "stated", "own", "beside"), RECORDS)
def test_every_field_of_a_record_is_in_the_schema_with_its_type(record, stated, own, beside):
    generated = TypeAdapter(record).json_schema()
    fields = generated["properties"]
    assert set(fields) - set(own) <= set(stated)
    assert set(stated) - set(fields) <= set(beside)
    for name in set(fields) & set(stated) - set(own):
        assert kinds(stated[name], SCHEMA) == kinds(fields[name], generated), name


def kinds(part, whole):
    """The types of JSON that a part of a schema allows."""
    if "$ref" in part:
        _, _, name = part["$ref"].rpartition("/")
        return kinds(whole["$defs"][name], whole)
    for several in ("anyOf", "oneOf"):
        if several in part:
            return set().union(*(kinds(one, whole) for one in part[several]))
    if "enum" in part:
        names = {str: "string", int: "integer", type(None): "null"}
        return {names[type(value)] for value in part["enum"]}
    stated = part["type"]
    return {stated} if isinstance(stated, str) else set(stated)


def test_every_object_of_the_schema_is_closed_and_says_what_it_requires():
    assert SCHEMA["properties"]["schema_version"] == {"const": SCHEMA_VERSION}
    assert set(SCHEMA["required"]) == set(SCHEMA["properties"])
    for name, part in DEFS.items():
        assert part["additionalProperties"] is False and part["required"], name
    for name in ("run", "surface", "model", "sliding_mode", "figure"):
        assert set(DEFS[name]["required"]) == set(DEFS[name]["properties"]), name


def test_the_rows_of_a_surface_are_the_columns_of_its_tables():
    for name, columns in (("roughness", ROUGHNESS), ("contact", CONTACT), ("adhesion", ADHESION)):
        assert set(DEFS[name]["properties"]) == set(columns), name
