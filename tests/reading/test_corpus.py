"""What reading makes of many files stays as it was, but for differences that were judged right."""

import random

import pytest
from corpus.comparing import MEANING, NUMBER, OUTCOME, WORDING, differences, judged
from corpus.digest import read_case
from corpus.store import load

SAMPLE = 150


@pytest.fixture(scope="module")
def corpus():
    return load()


@pytest.mark.slow
def test_a_sample_of_the_corpus_is_read_as_before(corpus):
    packed = [key for key, case in corpus.cases.items() if not case.is_shared]
    known, wrong = judged(), []
    for key in random.Random(42).sample(packed, SAMPLE):
        case = corpus.cases[key]
        for found in differences(corpus.read[key], read_case(case, corpus.contents)):
            if found.kind != WORDING and (key, found.where) not in known:
                wrong.append(f"{key} {case.files[0][0]} ({case.test}): {found}")
    assert not wrong, "\n".join(wrong)


def test_what_is_judged_is_a_case_of_the_corpus_and_says_why(corpus):
    for (key, _), why in judged().items():
        assert key in corpus.cases and why


def test_a_number_a_unit_and_an_outcome_that_change_are_told_apart():
    numbers = [50, 0, 1.0, 2.0, 3.0, 4.0]
    was = {"outcome": "run", "signals": {"normal_force": ["N", *numbers]}}
    rounded = {"outcome": "run", "signals": {"normal_force": ["N", *numbers[:-1], 4.0 + 1e-9]}}
    assert differences(was, rounded) == []
    off = {"outcome": "run", "signals": {"normal_force": ["N", *numbers[:-1], 4.0 + 1e-8]}}
    assert [found.kind for found in differences(was, off)] == [NUMBER]
    other = {"outcome": "run", "signals": {"normal_force": ["Pa", *numbers]}}
    assert [found.kind for found in differences(was, other)] == [MEANING]
    asked = {"outcome": "asked", "why": {"run": "GuessedError: no"}}
    assert [found.kind for found in differences(was, asked)] == [OUTCOME]


def test_a_setting_under_another_name_is_a_matter_of_wording():
    was = {"outcome": "run", "settings": {"reibradius_m": 0.015}}
    now = {"outcome": "run", "settings": {"track_radius_m": 0.015}}
    assert [found.kind for found in differences(was, now)] == [WORDING]
