"""What users do without meaning to is answered in one clear sentence; the quick part of it.

All cases, each in a process of its own and with limits: ``tests/robustness/break_it.py``.
"""

import re

import numpy as np
import pytest
from hostile import CASES
from hostile.base import TRIBOLAB
from mutations import MADE
from typer.testing import CliRunner

from tribolab.cli import app
from tribolab.core.errors import TribolabError
from tribolab.reading.run_files import read
from tribolab.reading.scan_files import read_scans
from tribolab.reading.unknown.proposal.draft import draft_dialect

_QUICK = re.compile(
    r"units 6: (header|campaign)|patterns 7: \(a|large 8: dialect, (5000.*True, clock True)"
    r"|large 8: info, xlsx with 100000|large 8: info, 300 000 times ('\(|' ).* in (a row|the h)"
    r"|netcdf 10: check|sdf 10: check, scales (0|1e-6) and 0|quotes 10|links 10: \w+ of"
    r"|names 10: a dialect|toml 10|secrets 15: (as|parted|run|info)"
)
QUICK = [
    pytest.param(case, id=case.name, marks=[pytest.mark.slow] if "5000 col" in case.name else [])
    for case in CASES
    if _QUICK.match(case.name) and not case.large
]


@pytest.mark.slow
@pytest.mark.parametrize("case", QUICK)
def test_it_does_not_break(case, tmp_path, monkeypatch):
    command = case.prepare(tmp_path)
    assert command[:3] == TRIBOLAB
    monkeypatch.chdir(tmp_path)
    answer = CliRunner().invoke(app, [_text(part) for part in command[3:]])
    assert answer.exit_code in case.codes, answer.output
    assert re.search(case.says, answer.output)
    assert not re.search(r"Traceback|crashed with|Warning|\x1b", answer.output), answer.output
    assert not (case.never and re.search(case.never, answer.output)), answer.output


def _text(part):
    return part.decode("utf-8", "surrogateescape") if isinstance(part, bytes) else part


@pytest.mark.slow
@pytest.mark.parametrize("kind", MADE, ids=lambda kind: kind.__name__)
def test_a_file_of_an_unusual_kind_is_data_or_one_error(kind, tmp_path):
    for seed in (1, 2):
        path = tmp_path / "made.csv"
        path.write_bytes(kind(np.random.default_rng(seed)))
        for reader in (read, read_scans, draft_dialect):
            try:
                reader(path)
            except TribolabError as error:
                assert "made" in str(error) and len(str(error)) < 1500
