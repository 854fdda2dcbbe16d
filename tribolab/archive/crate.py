"""Metadata of an archive: RO-Crate, and a Frictionless data package of its tables."""

from __future__ import annotations

import datetime as dt
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any
from urllib.parse import quote

import pandas as pd

from tribolab.archive.contents import Item
from tribolab.campaign.settings.config import Campaign
from tribolab.core.untyped import Json

METADATA, PACKAGE = "ro-crate-metadata.json", "datapackage.json"
_VERSION = "1.2"
_CONTEXT = f"https://w3id.org/ro/crate/{_VERSION}/context"
_SPDX = "https://spdx.org/licenses/"
_TYPES = {"i": "integer", "f": "number", "b": "boolean"}


@dataclass(frozen=True)
class CrateFacts:
    """Size and SHA-256 of a file in the archive."""

    size: int
    sha256: str


@dataclass(frozen=True)
class People:
    """Author, publisher and licence of an archive; "" if not stated."""

    author: str = ""
    publisher: str = ""
    licence: str = ""


def crate_metadata(
    report: Json,
    campaign: Campaign,
    items: Sequence[Item],
    facts: Mapping[str, CrateFacts],
    people: People,
) -> Json:
    """Return the RO-Crate metadata of an archive, as JSON-LD.

    Parameters
    ----------
    report
        Content of ``report.json``.
    campaign
        Campaign of the results.
    items, facts
        The files, and size and checksum of each by its name in the deposit.
    people
        Author, publisher and licence.

    References
    ----------
    RO-Crate Metadata Specification 1.2. doi:10.5281/zenodo.13751027
    """
    files = [_file(item, facts[item.name]) for item in items]
    instruments = _instruments(report, campaign)
    measured = _measured(report)
    licence, author, publisher = _people(people)
    version = report["versions"]["tribolab"]
    software = {
        "@id": "#tribolab",
        "@type": "SoftwareApplication",
        "name": "tribolab",
        "version": version,
        "softwareVersion": version,
        "softwareRequirements": f"Python {report['versions']['python']}",
        "url": f"pkg:generic/tribolab@{version}",  # a package URL, valid as an identifier
        "description": "Workbench for friction experiments: raw files in, friction out.",
    }
    actions = _actions(items, instruments, author, report["made_at"])
    root = {
        "@id": "./",
        "@type": "Dataset",
        "name": report["campaign"]["name"],
        "description": _description(report, campaign),
        "datePublished": report["made_at"][:10],
        "license": _ref(licence),
        "author": _ref(author),
        "publisher": _ref(publisher),
        "hasPart": [_ref(file) for file in files],
        "mentions": [_ref(thing) for thing in (*actions, *instruments, software)],
        "variableMeasured": [_ref(value) for value in measured],
    }
    descriptor = {
        "@id": METADATA,
        "@type": "CreativeWork",
        "about": {"@id": "./"},
        "conformsTo": {"@id": f"https://w3id.org/ro/crate/{_VERSION}"},
    }
    parts = [root, *files, *instruments, software, *measured, *actions, licence, author, publisher]
    graph = [descriptor, *parts]
    unique = {entity["@id"]: entity for entity in graph}
    return {
        "@context": [_CONTEXT, {"sha256": "https://schema.org/sha256"}],
        "@graph": list(unique.values()),
    }


def data_package(
    report: Json, tables: Mapping[str, pd.DataFrame], facts: Mapping[str, CrateFacts]
) -> Json:
    """Return the Frictionless description of the tables in an archive."""
    return {
        "profile": "tabular-data-package",
        "name": "tribolab-results",
        "title": report["campaign"]["name"],
        "created": report["made_at"],
        "resources": [
            {
                "profile": "tabular-data-resource",
                "name": PurePosixPath(name).stem.replace("_", "-"),
                "path": name,
                "mediatype": "text/csv",
                "encoding": "utf-8",
                "bytes": facts[name].size,
                "hash": f"sha256:{facts[name].sha256}",
                "schema": {
                    "fields": [
                        {
                            "name": str(column),
                            "type": _TYPES.get(table[column].dtype.kind, "string"),
                        }
                        for column in table
                    ],
                    "missingValues": [""],
                },
            }
            for name, table in tables.items()
        ],
    }


def address(name: str) -> str:
    """Return the identifier of a file in the metadata: its name with escaped spaces."""
    return quote(name)


def _ref(entity: Mapping[str, Any]) -> Json:
    return {"@id": entity["@id"]}


def _file(item: Item, known: CrateFacts) -> Json:
    return {
        "@id": address(item.name),
        "@type": "File",
        "name": PurePosixPath(item.name).name,
        "description": item.description,
        "encodingFormat": item.kind,
        "contentSize": str(known.size),
        "sha256": known.sha256,
    }


def _description(report: Json, campaign: Campaign) -> str:
    parts = [f"Friction measured and analysed: {report['verdict']['text']}."]
    if campaign.campaign.note:
        parts.append(campaign.campaign.note)
    if any(item for item in report["sources"]):
        parts.append("The table of sources has the checksums of all raw files.")
    return " ".join(parts)


def _instruments(report: Json, campaign: Campaign) -> list[Json]:
    """Return the instruments, with serial number and calibration if stated."""
    stated = campaign.calibration
    due = None
    if stated.date is not None and stated.interval is not None:
        due = stated.date + dt.timedelta(seconds=stated.interval)
    known = {
        "calibrated": stated.date and stated.date.isoformat(),
        "calibration due": due and due.isoformat(),
        "certificate": stated.certificate,
    }
    made = []
    names = dict.fromkeys(str(run.get("instrument", "")) for run in report["runs"])
    for name in filter(None, names):
        entity: Json = {
            "@id": f"#instrument-{address(name)}",
            "@type": "IndividualProduct",
            "name": name,
        }
        entity["description"] = "Instrument that measured friction"
        if stated.serial:
            entity["serialNumber"] = stated.serial
        values = [
            {"@type": "PropertyValue", "name": word, "value": value}
            for word, value in known.items()
            if value
        ]
        if values:
            named = [{"@id": f"#{address(name)}-{address(v['name'])}", **v} for v in values]
            entity["additionalProperty"] = [_ref(value) for value in named]
            made += named
        made.append(entity)
    return made


def _measured(report: Json) -> list[Json]:
    """Return one metadata value for each friction coefficient of the measured curves."""
    made = []
    for curve in report["curves"]:
        for number, point in enumerate(curve["points"], start=1):
            speed, value = point["sliding_speed_m_s"], point["friction_coefficient"]
            if value is None:
                continue
            error = point.get("friction_coefficient_U95")
            where = ", ".join(filter(None, (curve["surface"], curve["medium"])))
            at = "" if speed is None else f" at {speed:.3g} m/s"
            entity: Json = {
                "@id": f"#{address(curve['name'])}-{number}",
                "@type": "PropertyValue",
                "name": f"friction coefficient{f' of {where}' if where else ''}{at}",
                "value": value,
                "unitText": "1",
            }
            if error is not None:
                entity["description"] = f"expanded uncertainty (95 % coverage) {error:.2g}"
            made.append(entity)
    return made


def _people(people: People) -> tuple[Json, Json, Json]:
    if people.licence:
        known = people.licence.startswith("http")
        address = people.licence if known else f"{_SPDX}{people.licence}"
        licence: Json = {"@id": address, "@type": "CreativeWork", "name": people.licence}
        licence["description"] = "Licence of the deposit"
    else:
        licence = {
            "@id": "#licence",
            "@type": "CreativeWork",
            "name": "No licence is stated",
            "description": "Ask the authors before you use it.",
        }
    author: Json = {"@id": "#author", "@type": "Person", "name": people.author or "not stated"}
    publisher: Json = {
        "@id": "#publisher",
        "@type": "Organization",
        "name": people.publisher or "not stated",
    }
    return licence, author, publisher


def _actions(
    items: Sequence[Item], instruments: Sequence[Json], author: Json, made_at: str
) -> list[Json]:
    """Return the measurement that created the raw files, and the analysis that gave the results."""
    raw = [item for item in items if item.description in ("A raw file", "A scan")]
    settings = [item for item in items if item.kind == "application/toml"]
    results = [item for item in items if item not in raw and item not in settings]
    sources = [item for item in results if item.name.endswith("tables/sources.csv")]
    used = [thing for thing in instruments if thing["@type"] == "IndividualProduct"]
    measurement: Json = {
        "@id": "#measurement",
        "@type": "CreateAction",
        "name": "Measurement",
        "description": "Friction was measured.",
        "agent": _ref(author),
        "result": [{"@id": address(item.name)} for item in raw or sources],
    }
    if used:
        named = [_ref(thing) for thing in used]
        measurement["instrument"] = named[0] if len(named) == 1 else named
    analysis: Json = {
        "@id": "#analysis",
        "@type": "CreateAction",
        "name": "Analysis",
        "description": "tribolab run",
        "agent": _ref(author),
        "instrument": {"@id": "#tribolab"},
        "object": [{"@id": address(item.name)} for item in (*settings, *raw)],
        "result": [{"@id": address(item.name)} for item in results],
        "endTime": made_at,
    }
    return [measurement, analysis]
