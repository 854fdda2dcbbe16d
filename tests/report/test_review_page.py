"""Reviewing on the report page: what is clicked or typed there is what the campaign computes."""

import datetime as dt
import re
from dataclasses import replace

import numpy as np
import pytest
from campaigns import copied
from report_pages import AXE, Reader
from reviews import FROZEN, LATE, SLIP, SLIPPED, SOUND, rows_of

from tribolab.app.run import run_campaign
from tribolab.campaign.settings.review import REVIEW_FILE, load_review
from tribolab.friction.coefficient.coefficient import friction_coefficient
from tribolab.friction.decisions.decided_segments import decide
from tribolab.friction.decisions.decision import Decision
from tribolab.friction.segments.find import find_segments
from tribolab.reading.runs.read_run import read_run
from tribolab.report.page.reviewing import decision_texts

NUMBERS = {name: number for number, name in enumerate((FROZEN, SLIPPED, LATE, SOUND), start=1)}
SAVING = "window.saved = []; report.save = (...file) => saved.push(file); 0"
UNKNOWN = "report.book.author = ''"  # a reader whom this browser does not know yet
TODAY = dt.date.today()  # a reader's day
BAR = "document.getElementById('review-bar').textContent"


def page_of(browser, campaign, run, **how):
    """The page of a campaign at one of its runs."""
    page = (campaign.parent / "results/report.html").as_uri()
    return browser.page(f"{page}#run-{NUMBERS[run]}", **how)


def drawn(page, run):
    """Wait until a run's trace is drawn; returns the selector of all that belongs to the run."""
    here = f"#run-{NUMBERS[run]}"
    page.wait(f"(document.querySelector('{here} .state')?.textContent ?? '') !== ''")
    page.run(SAVING)
    return here


def on_trace(page, here, time):
    """Where in the window a time of a run's trace lies, in the middle of its first panel [px]."""
    return page.run(
        f"(() => {{ const plot = document.querySelector('{here} .plot'), layout = plot._fullLayout;"
        "plot.scrollIntoView({block: 'center', behavior: 'instant'});"
        "const box = plot.getBoundingClientRect();"
        f"return [box.left + layout.xaxis._offset + layout.xaxis.d2p({time}),"
        "box.top + layout.yaxis._offset + layout.yaxis._length / 2] })()"
    )


def said_why(page, here, reason):
    """Type a reason, and decide."""
    page.wait(f"document.activeElement === document.querySelector('{here} [name=reason]')")
    page.type(reason)
    page.key("Enter", "\r")
    page.wait(f"document.querySelector('{here} .review form').hidden")


def downloaded(page, campaign, number=0):
    """Put what was downloaded beside the campaign file, and read it."""
    page.wait(f"saved.length > {number}")
    name, _, text = page.run(f"saved[{number}]")
    assert name == REVIEW_FILE
    (campaign.parent / name).write_text(text, "utf-8")
    return text, load_review(campaign.parent)


def bounds_of(results, run, place):
    """Beginning and end of a segment as the page has them [s]."""
    row = rows_of(results, run).iloc[place]
    return tuple(float(f"{row[name]:.9g}") for name in ("start_s", "stop_s"))


@pytest.mark.slow
def test_what_is_clicked_is_what_the_campaign_computes(browser, reviewed, tmp_path):
    campaign = copied(reviewed[0], tmp_path)
    results = campaign.parent / "results"
    before, earlier = (campaign.parent / REVIEW_FILE).read_text(), load_review(campaign.parent)
    second, third = (bounds_of(results, SOUND, place) for place in (1, 2))
    reason = 'it "slid" \\ off: 3 µm, <b>'
    with page_of(browser, campaign, SOUND) as page:
        here = drawn(page, SOUND)
        page.run(UNKNOWN)
        page.mouse([on_trace(page, here, sum(second) / 2)])
        page.click(f"{here} .review [data-review=reject]")
        page.type("B. Reader")  # asked for once
        page.run(f"document.querySelector('{here} [name=reason]').focus()")
        said_why(page, here, reason)
        # the beginning of the third is dragged to a third of it
        page.mouse([on_trace(page, here, sum(third) / 2)])
        x, y = on_trace(page, here, third[0])
        aim, _ = on_trace(page, here, third[0] + (third[1] - third[0]) / 3)
        page.mouse([(x, y), ((x + aim) / 2, y), (aim, y)])
        begin = float(page.run(f"document.querySelector('{here} .bound.start').ariaValueNow"))
        assert begin == pytest.approx(third[0] + (third[1] - third[0]) / 3, abs=1.0)
        page.run(f"document.querySelector('{here} [name=reason]').focus()")
        said_why(page, here, "came late")
        assert "2 decisions not yet downloaded" in page.run(BAR)
        marks = "document.querySelector('{} .plot').layout.shapes.filter(s => s.type === 'path')"
        assert page.run(f"{marks.format(here)}.length") == 2, "hatched in both panels"
        # what the file says of another run is seen there, and taken back, too
        page.run(f"report.goToRun('{SLIPPED}')")
        other = drawn(page, SLIPPED)
        page.wait(f"document.querySelector('{other} .plot').layout !== undefined")
        assert page.run(f"{marks.format(other)}.length") == 2
        inside = sum(bounds_of(results, SLIPPED, SLIP)) / 2
        page.mouse([on_trace(page, other, inside)])
        hover = f"report.charts.chartOf(document.querySelector('{other} .trace')).where({inside})"
        assert "rejected by A. Person: slipped off (2026-11-20)" in page.run(hover)
        page.click(f"{other} .decided [data-review=take]")
        page.click("#review-bar [data-review=download]")
        text, review = downloaded(page, campaign)
        assert "3 decisions downloaded" in page.run(BAR)
        assert page.console == page.stopped == []
    # the file: as it was, to the letter, without what was taken back, and then what is new
    first, rest = before.index("[[decision]]"), before.index(f'[[decision]]\nrun = "{FROZEN}"')
    assert text.startswith(before[:first] + before[rest:])
    day = review[SOUND][0].date
    assert abs(dt.date.fromisoformat(day) - TODAY) <= dt.timedelta(days=1)
    reject = Decision("reject", reason, "B. Reader", day, *second)
    bounds = Decision("bounds", "came late", "B. Reader", day, *third, new_start=begin)
    made = {SOUND: (reject, bounds)}
    assert review == {name: earlier[name] for name in (FROZEN, LATE)} | made
    # the campaign with the file: the numbers of a notebook with these decisions
    outcome = run_campaign(campaign, jobs=1, figures="none")
    assert [run.reused for run in outcome.runs] == [True, False, True, False]
    for name in (SLIPPED, SOUND):
        logs = [campaign.parent / f"raw/friction/{name}_{log}.csv" for log in ("force", "motion")]
        run = read_run(logs, "linear_slider")
        friction = friction_coefficient(run, decide(find_segments(run), made.get(name, ()), run))
        rows = rows_of(outcome.folder, name)
        for column in ("friction_coefficient", "friction_coefficient_sem", "start_s"):
            expected = friction[column.removesuffix("_s")].values
            np.testing.assert_array_equal(rows[column].values, expected)
    # what the results have by now is pending no more
    with page_of(browser, campaign, SOUND) as page:
        here = drawn(page, SOUND)
        assert page.run("document.getElementById('review-bar').hidden")
        kinds = f"Array.from(document.querySelectorAll('{here} .decided li'), li => li.className)"
        assert page.run(kinds) == ["applied reject", "applied bounds"]


@pytest.mark.slow
def test_a_campaign_is_reviewed_by_keyboard_alone(browser, original, tmp_path):
    campaign = copied(original, tmp_path)
    results = campaign.parent / "results"
    page_file = (results / "report.html").as_uri()
    with browser.page(page_file) as page:
        page.run(f"{UNKNOWN}; {SAVING}")
        page.key("d", "d")  # the first of two runs in doubt
        here = drawn(page, FROZEN)
        page.key("a", "a")
        page.wait("document.activeElement.name === 'author'")
        page.type("B. Reader")
        page.key("Enter", "\r")  # no reason: that is asked for, and nothing is decided
        page.wait("document.activeElement.name === 'reason'")
        assert "State the reason" in page.run(f"document.querySelector('{here}').textContent")
        said_why(page, here, "the logger's buffer")
        page.key("s", "s")
        page.key("n", "n")
        said_why(page, here, "a door")
        page.key("b", "b")
        page.wait("document.activeElement.className === 'bound start'")
        page.key("ArrowRight")
        page.key("ArrowRight")
        begin = float(page.run("document.activeElement.ariaValueNow"))
        page.key("Enter", "\r")
        said_why(page, here, "began late")
        for _ in range(2):
            page.key("s", "s")
        page.key("r", "r")
        said_why(page, here, "a slip")
        assert "4 decisions not yet downloaded" in page.run(BAR)
        page.key("u", "u")
        assert "3 decisions not yet downloaded" in page.run(BAR)
        page.key("d", "d")  # the second: one stroke slipped, so its coefficients are not known
        there = drawn(page, SLIPPED)
        page.key("a", "a")
        said_why(page, there, "the other strokes are sound")
        page.key("d", "d")
        page.wait(f"{BAR}.includes('No run is suspect or failed')")
        # closed and opened again, nothing is lost
        page.go(f"{page_file}?again#run-{NUMBERS[FROZEN]}")
        here = drawn(page, FROZEN)
        assert "4 decisions not yet downloaded" in page.run(BAR)
        page.key("l", "l")
        text, review = downloaded(page, campaign)
        found = bounds_of(results, FROZEN, 0)
        assert begin > found[0] and text.count("[[decision]]") == 4
        plain = [replace(one, date=str(TODAY)) for one in review[FROZEN]]
        who = {"author": "B. Reader", "date": str(TODAY)}
        assert plain == [
            Decision("accept", "the logger's buffer", **who),
            Decision("note", "a door", **who, start=found[0], stop=found[1]),
            Decision("bounds", "began late", **who, start=found[0], stop=found[1], new_start=begin),
        ]
        # to accept what is rejected takes the rejection's place; both at once would be refused
        page.key("w", "w")
        page.key("r", "r")
        said_why(page, here, "after all")
        page.key("l", "l")
        _, review = downloaded(page, campaign, 1)
        assert [one.action for one in review[FROZEN]] == ["note", "bounds", "reject"]
        page.key("r", "r")  # everybody can use the form, too
        page.run(AXE)
        parts = f"{{include: [['{here}'], ['#review-bar']]}}"
        found = page.run(f"axe.run({parts}, {{resultTypes: ['violations']}})")
        assert [(one["id"], one["nodes"][0]["html"]) for one in found["violations"]] == []
        assert page.console == page.stopped == []


@pytest.mark.slow
def test_where_nothing_can_be_kept_the_page_says_so_and_asks_before_it_closes(browser, original):
    none = "Object.defineProperty(window, 'localStorage', {get() { throw new Error('forbidden') }})"
    asks = "!dispatchEvent(new Event('beforeunload', {cancelable: true}))"
    with page_of(browser, original, SLIPPED, before=none, width=400) as page:
        here = drawn(page, SLIPPED)
        assert not page.run(asks)
        page.key("r", "r")
        page.type("B. Reader")
        page.run(f"document.querySelector('{here} [name=reason]').focus()")
        said_why(page, here, "wrong sample")
        assert "lost when you close the page" in page.run(BAR)
        assert page.run(asks)
        assert page.run("document.documentElement.scrollWidth") == 400
        page.key("l", "l")
        page.wait("saved.length === 1")
        assert not page.run(asks)
        assert page.console == page.stopped == []


@pytest.mark.slow
def test_the_page_says_when_it_was_made_and_which_decisions_it_holds(original, reviewed):
    banner = re.compile(r'<p class="note">(Made .*?)</p>', re.DOTALL)
    held = re.compile(r'<details id="decisions-held">(.*?)</details>', re.DOTALL)
    page = (reviewed[0].parent / "results/report.html").read_text("utf-8")
    said = Reader(banner.search(page)[1]).text
    assert re.match(r"Made 20\d\d-\d\d-\d\d .* UTC by tribolab", said[0])
    assert "4 decisions in review.toml" in page
    rows = held.search(page)[1].replace("<wbr>", "")
    for words in (SLIPPED, FROZEN, LATE, "slipped off", "A. Person", "2026-11-20", "humid day"):
        assert words in rows
    assert rows.count("<tr>") == 1 + 4
    page = (original.parent / "results/report.html").read_text("utf-8")
    assert not held.search(page)


ONE = '[[decision]]\nrun = "a"\n'
FILES = {
    "empty": ("", 0),
    "comments": (f"# Mine\n\n# late\n{ONE}# torn\n\n  [[ decision ]] # b\nrun = 'b'", 2),
    "inline": ('# Mine\ndecision = [{run = "a"}]\n', None),
    "header in a text": (f'{ONE}reason = """\n[[decision]]\n"""\n', None),
}


@pytest.mark.parametrize(("text", "count"), FILES.values(), ids=FILES)
def test_a_review_file_is_cut_into_decisions_and_nothing_of_it_is_lost(text, count):
    head, texts = decision_texts(text)
    if count is None:
        assert (head, texts) == ("", [])
    else:
        assert head + "".join(texts) == text and len(texts) == count
