"""Words of languages stand in the lexicon, where a reader of the language can review them."""

from pathlib import Path

import pytest

import tribolab.reading

READING = Path(tribolab.reading.__file__).parent
LAST_OF_LATIN = "\u024f"
MODULES = [p for p in sorted(READING.rglob("*.py")) if p.parent.name != "lexicon"]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(READING)))
def test_no_module_of_reading_but_the_lexicon_holds_letters_beyond_latin(path):
    lines = path.read_text("utf-8").splitlines()
    found = [
        f"{number}: {line.strip()}"
        for number, line in enumerate(lines, 1)
        if any(sign > LAST_OF_LATIN and sign.isalpha() for sign in line)
    ]
    assert not found
