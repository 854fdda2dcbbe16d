"""Decisions in the review file as data, so that a reader of the page can edit them."""

from __future__ import annotations

import hashlib
import re
import tomllib
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribolab.campaign.settings.review import REVIEW_FILE, load_entries
from tribolab.campaign.settings.toml_file import text_of
from tribolab.core.provenance import as_text
from tribolab.core.untyped import Json

if TYPE_CHECKING:
    from tribolab.campaign.settings.config import Campaign

_HEADER = re.compile(r"^[ \t]*\[\[[ \t]*decision[ \t]*\]\]", re.MULTILINE)
_ABOVE = re.compile(r"(?:^[ \t]*#[^\n]*\n)+\Z", re.MULTILINE)  # comments before a decision


def review_data(campaign: Campaign, runs: Sequence[Mapping[str, Any]]) -> Json:
    """Return the decisions on a campaign as data for the page.

    Parameters
    ----------
    campaign
        The campaign.
    runs
        As in report.json, with the segments that each decision affected.

    Returns
    -------
    dict
        ``key`` identifies this campaign, ``files`` are the names of campaign and review file,
        ``head`` is the text before the first decision, and ``entries`` are the decisions in order:
        times [s], numbers of their ``segments``, from 1, whether they were ``applied``, and their
        ``text`` as a person wrote it, "" if it is not a separate table.
    """
    file = Path(campaign.file)
    name = f"{as_text(file.parent.absolute())}\n{as_text(file.name)}\n{campaign.name}"
    data: Json = {
        "key": hashlib.sha256(name.encode()).hexdigest()[:24],
        "files": [as_text(file.name), REVIEW_FILE],
        "head": "",
        "entries": [],
    }
    path = file.parent / REVIEW_FILE
    if not path.exists():
        return data
    head, texts = decision_texts(text_of(path, ""))
    entries = load_entries(path)
    touched = {run["name"]: list(run["decisions"]) for run in runs}
    rows = []
    for place, entry in enumerate(entries):
        plain = {"run": entry.run} | entry.decision.plain()
        known = next((row for row in touched.get(entry.run, ()) if _same(row, plain)), None)
        rows.append(
            plain
            | {
                "segments": [] if known is None else list(known["segments"]),
                "applied": known is not None and not known["effect"].startswith("not applied"),
                "text": texts[place] if texts else "",
            }
        )
    return data | {"head": head, "entries": rows}


def _same(row: Mapping[str, Any], plain: Mapping[str, Any]) -> bool:
    return all(row[key] == value for key, value in plain.items() if key != "run")


def decision_texts(text: str) -> tuple[str, list[str]]:
    r"""Split the text of a review file into the part before its decisions and each decision.

    A decision includes the comment lines directly above it. If decisions are not separate tables,
    both are empty: then only their content can be kept.

    Examples
    --------
    >>> decision_texts('# Mine\n\n# late\n[[decision]]\nrun = "a"\n\n[[decision]]\nrun = "b"\n')
    ('# Mine\n\n', ['# late\n[[decision]]\nrun = "a"\n\n', '[[decision]]\nrun = "b"\n'])
    >>> decision_texts('decision = [{run = "a"}]')
    ('', [])
    """
    cuts = []
    for header in _HEADER.finditer(text):
        comment = _ABOVE.search(text, 0, header.start())
        cuts.append(comment.start() if comment else header.start())
    head = text[: cuts[0]] if cuts else text
    texts = [text[low:high] for low, high in pairwise([*cuts, len(text)])] if cuts else []
    try:
        decided = [tomllib.loads(toml)["decision"] for toml in texts]
        whole = tomllib.loads(text).get("decision", [])
        if [entry for entries in decided for entry in entries] == whole and not tomllib.loads(head):
            return head, texts
    except tomllib.TOMLDecodeError:  # what looks like a header is inside a string
        pass
    return "", []
