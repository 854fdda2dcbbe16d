"""What a line states is found by concept and unit, whatever the language."""

import tomllib
from pathlib import Path

import pytest

from tribolab.reading.interpret.settings import amounts_of
from tribolab.reading.lexicon import lexicon
from tribolab.reading.lexicon.lexicon import key_pattern, mentions, text_pattern
from tribolab.reading.numbers import numbers_in

FOLDER = Path(lexicon.__file__).parent


def blocks(name):
    return tomllib.loads((FOLDER / f"{name}.toml").read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("name", "pattern"), [("settings", key_pattern), ("sentences", text_pattern)]
)
def test_every_form_is_made_of_parts_that_exist(name, pattern):
    known = blocks(name)
    parts = known.pop("part")
    forms = [
        form
        for block in known.values()
        for form in (*block.get("forms", ()), *block.get("not", ()))
    ]
    used = {part.rstrip("?+") for form in forms for part in form.split() if part[0] != "*"}
    assert used <= set(parts)
    for concept in known:
        pattern(concept)


@pytest.mark.parametrize(
    ("concept", "unit", "size", "line"),
    [
        ("track_radius", "m", 0.0215, "Laufbahnradius: 21,5 mm"),
        ("track_radius", "m", 0.0215, "ring on disc, mean track radius 21.5 mm"),
        ("load", "N", 19.6133, "Load,2,kg"),
        ("load", "N", 19.6133, "Charge : 2 kg"),
        ("pitch", "m", 2.5e-7, "采样间距 0.25 µm"),
        ("stroke", "m", 8e-3, "stroke_mm=8"),
        ("frequency", "Hz", 2.0, "stroke 5 mm at 2 Hz"),
        ("sampling_rate", "Hz", 200.0, "Abtastrate = 200 Hz"),
        ("arm", "m", 0.1, "Lever arm (mm): 100"),
    ],
)
def test_an_amount_is_found_by_concept_and_unit(concept, unit, size, line):
    assert amounts_of((line,), 12).only(concept, unit=unit).si(unit) == pytest.approx(size)


@pytest.mark.parametrize(
    "line", ["Started 12:30:05", "Step 0 = head lifted", "Load: none", "Date: 3.4.2026"]
)
def test_a_line_without_an_amount_states_none_with_a_unit(line):
    assert not [amount for amount in amounts_of((line,), 12) if amount.unit]


@pytest.mark.parametrize(
    ("name", "yes", "no"),
    [
        ("slides_on_rim", "Klotz auf Ring", "ring on disc"),
        ("slides_on_rim", "ブロックオンリング試験", "ボールオンディスク"),
        ("zero_not_taken_off", "Nullpunkt nicht korrigiert", "Nullpunkt korrigiert"),
        ("zero_not_taken_off", "offset not yet subtracted", "offset was subtracted"),
        ("zero_taken_off", "0.12 N (soustrait)", "0.12 N"),
        ("factor", "Gain", "Again"),
        ("lever", "leva 1:5", "level 5"),
        ("on_return", "lifted on the way back", "lifted on the way out"),
    ],
)
def test_words_of_a_sentence_say_one_thing_and_not_its_contrary(name, yes, no):
    assert mentions(name, yes)
    assert not mentions(name, no)


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("4213 counts = 1 N", [(4213.0, "counts"), (1.0, "N")]),
        ("2 mN per digit", [(2.0, "mN/digit")]),
        ("v2.1, run_3, 1,5", [(1.5, "")]),
        ("-4.2e-3 m/s", [(-4.2e-3, "m/s")]),
    ],
)
def test_a_number_looks_the_same_everywhere(text, values):
    assert [(number.value, number.unit) for number in numbers_in(text)] == values
