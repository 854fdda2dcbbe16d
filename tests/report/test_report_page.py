"""The page in a real browser: it opens offline, nothing in a name runs, everybody can read it."""

import json
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
from report_pages import (
    BY_LOOKS,
    DRAW_ALL,
    OPEN_ALL,
    Reader,
    details_of,
    faults_of,
    figures_of,
    folded_of,
    page_of,
)
from reporting import made_outcome, made_run, with_run

from tribolab.qc.flags import attach
from tribolab.report.page.templating import _DRAWING, _SCRIPTS, data_address
from tribolab.report.results import write_report

SCRIPTS = _SCRIPTS + _DRAWING
HOSTILE = [
    "<script>document.title='broken into'</script>",
    '"><img src=x onerror="document.title=\'broken into\'">',
    "'+alert(1)+' javascript:alert(1) {{ 7*7 }} {% raw %}",
    "</style></script><svg onload=\"document.title='broken into'\">",
]


@pytest.fixture(scope="module")
def results(flagged_results):
    return flagged_results


@pytest.fixture(scope="module")
def hostile(tmp_path_factory):
    """Every text that comes from a file: names, notes, messages, columns, reasons."""
    runs = [(HOSTILE[1], HOSTILE[2], HOSTILE[0], 31.0, 0.8)]
    failed = [(HOSTILE[3], HOSTILE[1])]
    folder = tmp_path_factory.mktemp("hostile")
    outcome = made_outcome(folder, runs, HOSTILE[0], failed, [1e-3], 50, note=HOSTILE[1])
    run, segments, friction = made_run([1e-3], samples=50)
    words = dict.fromkeys(("check", "variable", "message", "cure", "unit"), HOSTILE[3])
    run = attach(run, "friction_force", {"spikes": np.full(run.sizes["time"], 3)}, {"spikes": 14})
    run.attrs |= {
        "instrument": HOSTILE[3],
        "recorded_at": HOSTILE[0],
        "clock_shift_s": 0.1,
        "clock_shift_source": HOSTILE[1],
        "columns_not_used": "; ".join(HOSTILE),
        "quality": "suspect",
        "findings": [words | {"status": "suspect", "value": 1.0}],
    }
    segments["omitted_reason"] = ("omitted", np.array(HOSTILE[:3], dtype=object))
    friction.attrs |= {"offset": HOSTILE[3], "velocity_source": HOSTILE[1]}
    parts = run, segments, friction
    outcome = with_run(outcome, 0, parts, files=tuple(HOSTILE), kept=HOSTILE[0])
    write_report(replace(outcome, sources=tuple((name, "", 0) for name in HOSTILE)))
    return outcome.folder


@pytest.mark.slow
def test_page_opens_without_a_word_and_asks_nothing_of_the_network(browser, results):
    address = (results / "report.html").as_uri()
    with browser.page(address) as page:
        page.run(OPEN_ALL)
        assert page.run(DRAW_ALL) == len(figures_of(results)) + 3
        assert page.console == page.stopped == []
        assert page.requests == [address]
        assert "3 of 4 runs usable (1 suspect); 1 failed" in page.run("document.body.textContent")


@pytest.mark.slow
def test_the_browser_reports_errors_and_what_the_policy_stopped(browser, results, tmp_path):
    trouble = "<script>throw 1</script><img src='http://localhost:9/x.png'></body>"
    path = tmp_path / "trouble.html"
    path.write_text(page_of(results).replace("</body>", trouble), encoding="utf-8")
    with browser.page(path) as page:
        assert len(page.console) == 2
        assert "Content Security Policy" in page.console[0]


@pytest.mark.slow
def test_nothing_in_a_name_runs(browser, hostile, tmp_path):
    # without the policy too: escaping alone has to do
    bare = tmp_path / "bare.html"
    bare.write_text(
        re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", page_of(hostile))
    )
    for path in (hostile / "report.html", bare):
        with browser.page(f"{path.as_uri()}#run-1") as page:
            page.run(OPEN_ALL)
            assert page.run(DRAW_ALL) >= 4
            page.wait("document.querySelector('#run-1 .js-plotly-plot') !== null")
            assert page.console == [], "not even an attempt that the policy had to stop"
            assert page.run("document.title").startswith(HOSTILE[0])
            assert page.run("document.querySelector('h1').textContent") == HOSTILE[0]
            assert page.run("document.querySelectorAll('[onerror],[onload]').length") == 0
            running = "Array.from(document.scripts).filter(s => !s.type && !s.src).length"
            assert page.run(running) == len(SCRIPTS) + 1  # the library
            # which makes a style, empty
            assert page.run("document.querySelectorAll('style, link').length") == 1 + 1 + 1
            assert page.run("document.querySelectorAll('.plot a, .plot script').length") == 0
            assert page.stopped == []
    # opened by themselves figures are documents, whose scripts a browser would run
    for figure in (hostile / "figures").glob("*.svg"):
        for element in ElementTree.parse(figure).iter():
            assert not str(element.tag).endswith(("script", "}a", "foreignObject"))
            assert not [name for name in element.attrib if name.lower().startswith("on")]


@pytest.mark.slow
def test_contents_lead_to_every_section_and_follow_the_scroll(browser, results):
    current = "document.querySelector('nav [aria-current]')?.textContent"
    with browser.page(results / "report.html") as page:
        titles = page.run(
            "Array.from(document.querySelectorAll('main section:not(.stored) > h2'),"
            "h => h.textContent)"
        )
        links = page.run(
            "Array.from(document.querySelectorAll('nav .contents > ul > li > a'),"
            "a => a.textContent)"
        )
        assert links == ["Result", *titles] and len(titles) >= 6
        for section, title in (("curves", "Curves"), ("findings", "Findings")):
            page.click(f"nav a[href='#{section}']")
            page.wait(f"{current} === {json.dumps(title)}")
            top = page.run(f"document.getElementById('{section}').getBoundingClientRect().top")
            assert 0 <= top < 300


@pytest.fixture
def alone(results, tmp_path):
    """The page as it is sent: one file in a folder of its own."""
    file = tmp_path / "sent" / "report.html"
    file.parent.mkdir()
    file.write_text(page_of(results), encoding="utf-8")
    return file


@pytest.mark.slow
def test_no_accessibility_fault_of_weight_and_no_scrolling_sideways(browser, results):
    for width, dark, rules in ((1400, False, ""), (400, True, BY_LOOKS)):
        with browser.page(results / "report.html", width, 900, dark) as page:
            page.run(OPEN_ALL)
            page.run(DRAW_ALL)
            assert page.run("document.documentElement.scrollWidth") <= width
            assert faults_of(page, rules) == []


@pytest.mark.slow
def test_appearance_follows_the_reader_or_the_button(browser, results):
    ground = "getComputedStyle(document.body).backgroundColor"
    with browser.page(results / "report.html", dark=True) as page:
        dark = page.run(ground)
        page.click("#theme")
        assert page.run(ground) == "rgb(255, 255, 255)" != dark
        page.click("#theme")
        assert page.run(ground) == dark
        page.click("#theme")


@pytest.mark.slow
def test_where_there_is_room_tables_need_not_scroll(browser, results):
    with browser.page(results / "report.html", 1280) as page:
        page.run(OPEN_ALL)
        page.run(DRAW_ALL)
        assert page.run("document.documentElement.scrollWidth") <= 1280
        beyond = "one => one.parentNode.scrollWidth - one.parentNode.clientWidth"
        tables = page.run(f"Array.from(document.querySelectorAll('table'), {beyond})")
        assert max(tables) <= 0


def test_page_points_only_to_itself_and_to_what_lies_beside_it(results, hostile):
    for folder in (results, hostile):
        reader = Reader(page_of(folder))
        for tag, attrs in reader.elements:
            for name in ("src", "srcset", "action", "data", "poster", "background"):
                beside = attrs.get(name, "data:").startswith(("data:", "figures/"))
                assert beside, (tag, attrs)
            if tag == "link":
                assert attrs["href"] == "data:,"
            if "href" in attrs and tag == "a":
                # a page that is sent alone has nothing beside it
                assert attrs["href"].startswith("#"), attrs["href"]
        style = page_of(folder).split("<style>")[1].split("</style>")[0]
        assert "url(" not in style and "@import" not in style
        assert not {"iframe", "object", "embed", "base"} & {tag for tag, _ in reader.elements}


def test_every_link_leads_somewhere(results):
    reader = Reader(page_of(results))
    ids = [attrs["id"] for _, attrs in reader.elements if "id" in attrs]
    assert len(ids) == len(set(ids))
    for link in reader.all("a"):
        target = link["href"]
        assert target[1:] in ids


def test_figures_are_described_in_words_and_numbers(results):
    reader = Reader(page_of(results) + "".join(details_of(results)))
    said = [d["aria-label"] for d in reader.all("div") if "plot" in d.get("class", "").split()]
    assert len(said) == len(set(said)) == len(figures_of(results)) + 3
    assert sum(bool(re.search(r"µ [01]\.\d", words)) for words in said) == 3 + 3


def test_failed_runs_are_struck_out_with_their_reason(results):
    row = re.search(r'<tr[^>]* class="failed">.*?</tr>', page_of(results), re.DOTALL)[0]
    assert "<s>broken</s>" in row and "column &#39;Fx&#39; has no unit" in row


@pytest.mark.slow
def test_what_uncertainties_leave_out_is_said_once_for_all_that_it_holds_for(two_runs):
    text = "".join(Reader(page_of(two_runs.parent / "results")).text)
    assert text.count("All curves: calibration not stated: statistical only") == 1
    assert text.count("calibration not stated: statistical only") == 1


def test_policy_allows_the_page_and_nothing_else(results):
    policy = next(
        attrs["content"]
        for attrs in Reader(page_of(results)).all("meta")
        if attrs.get("http-equiv") == "Content-Security-Policy"
    )
    assert "unsafe" not in policy and "http" not in policy
    allowed = {name: rest for name, *rest in (part.split() for part in policy.split(";"))}
    for name in ("default-src", "connect-src", "base-uri", "form-action"):
        assert allowed[name] == ["'none'"]
    # the library is unpacked in the page, and makes an empty style element
    for name, count in (("script-src", len(SCRIPTS) + 1), ("style-src", 1 + 1)):
        assert len(allowed[name]) == count
        assert all(re.fullmatch(r"'sha256-[\w+/]{43}='", source) for source in allowed[name])


@pytest.mark.slow
def test_no_script_is_taken_from_beside_the_page(browser, alone):
    (alone.parent / "beside.js").write_text("document.title = 'broken into'")
    with browser.page(alone) as page:
        title = page.run("document.title")
        page.run(
            "new Promise(done => { const s = document.createElement('script');"
            "s.onload = s.onerror = () => done(0); s.src = 'beside.js'; document.head.append(s) })"
        )
        page.run("fetch('beside.js').then(() => 0, () => 0)")
        assert page.run("document.title") == title
        assert [word.split()[0] for word in page.stopped] == ["script-src-elem", "connect-src"]
        assert page.requests == [alone.as_uri()]


def test_campaign_file_and_checksums_stand_on_the_page(results):
    text = "".join(Reader(page_of(results)).text) + "".join(folded_of(results))
    assert 'name = "Glycerol & PMMA"' in text
    assert "ab" * 32 in text and "could not be read" in text


def test_data_address_needs_no_escaping_in_an_attribute():
    address = data_address('<?xml version="1.0"?>\n<svg a="1&amp;2">\n<g id="#x%"/></svg>')
    assert not set('"&<>#\n') & set(address)
    assert address.startswith("data:image/svg+xml,%3Csvg a='1%26amp;2'%3E")
