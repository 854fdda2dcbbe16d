"""What users do without meaning to is answered in one clear sentence; the quick part of it.

All cases, with limits on time and memory: ``tests/benchmarks/break_it.py``.
"""

import os
import re
import subprocess

import pytest
from hostile_cases import CASES

_QUICK = re.compile(
    r"units 6: campaign '1 9|large 8: dialect, (5000 columns, names True, clock True|xlsx.*5000000)"
    r"|names 10: dialect, a name with not UTF-8, POSIX|netcdf 10: read, (text time|2D|array)"
    r"|sdf 10: read_scans, scales 0 and 0|quotes 10: dialect, open mark 1|toml 10: (an empty key"
    r"|lists a thousand|20 000)|secrets 15: (as nanovea_map|parted|run|tl.read_modulus)"
)
QUICK = [case for case in CASES if _QUICK.match(case.name) and not case.large]


def test_the_quick_cases_are_some_of_all():
    assert 12 <= len(QUICK) < 30


@pytest.mark.slow
@pytest.mark.parametrize("case", QUICK, ids=lambda case: case.name)
def test_it_does_not_break(case, tmp_path):
    command = case.prepare(tmp_path)
    env = {**os.environ, **case.settings}
    done = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, check=False)
    said = (done.stdout + done.stderr).decode(errors="replace")
    assert done.returncode in case.codes, said
    assert re.search(case.says, said)
    assert not re.search(r"Traceback|crashed with|Warning|[\x00-\x08\x0e-\x1f]", said), said
    assert not (case.never and re.search(case.never, said)), said
