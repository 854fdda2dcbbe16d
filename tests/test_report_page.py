"""The page in a real browser: it opens offline, nothing in a name runs, everybody can read it."""

import json
import os
import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from chromium import BROWSER, chromium
from report_pages import FLAGGED, LONG, RUNS, Reader, made, page_of
from reporting import made_outcome, made_run, with_run

from tribolab.campaign.store import Catalogue
from tribolab.qc.flags import attach
from tribolab.report import page as page_module
from tribolab.report.page import data_address
from tribolab.report.results import write_report

AXE = (Path(__file__).parent / "vendor" / "axe.min.js").read_text(encoding="utf-8")
HOSTILE = [
    "<script>document.title='broken into'</script>",
    '"><img src=x onerror="document.title=\'broken into\'">',
    "'+alert(1)+' javascript:alert(1) {{ 7*7 }} {% raw %}",
    "</style></script><svg onload=\"document.title='broken into'\">",
]


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    if not BROWSER:
        message = "no chromium was found to open the report with"
        if os.environ.get("TRIBOLAB_REQUIRE_BROWSER"):
            pytest.fail(message)
        pytest.skip(message)
    with chromium(tmp_path_factory.mktemp("profile")) as started:
        yield started


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return made(tmp_path_factory.mktemp("page"))


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


def shown_runs(page):
    """The names in the table of runs, as they stand there."""
    return page.run(
        "Array.from(document.querySelectorAll('#runs-table tbody tr:not([hidden]) th'),"
        "cell => cell.textContent)"
    )


def span_of(page, run):
    """What a run's chart says of the time that it shows: from, to [s]."""
    text = page.run(f"document.querySelector('#run-{run} .state').textContent")
    return tuple(float(word) for word in re.match(r"([\d.]+) s to ([\d.]+) s", text).groups())


@pytest.mark.slow
def test_page_opens_without_a_word_and_asks_nothing_of_the_network(browser, results):
    address = (results / "report.html").as_uri()
    with browser.page(address) as page:
        page.run("document.querySelectorAll('details').forEach(one => { one.open = true })")
        page.wait("document.querySelectorAll('.plot canvas').length === 6")
        assert page.console == page.stopped == []
        assert page.requests == [address]
        assert "3 of 4 runs done; 1 failed" in page.run("document.body.textContent")
        widths = page.run(
            "Promise.all(Array.from(document.images, i => { i.loading = 'eager';"
            "return i.decode().then(() => i.naturalWidth) }))"
        )
    assert len(widths) == 2 + 1 + 5 and min(widths) > 300


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
            page.wait("document.querySelector('#run-1 .plot canvas') !== null")
            assert page.console == [], "not even an attempt that the policy had to stop"
            assert page.run("document.title").startswith(HOSTILE[0])
            assert page.run("document.querySelector('h1').textContent") == HOSTILE[0]
            assert page.run("document.querySelectorAll('[onerror],[onload]').length") == 0
            running = "Array.from(document.scripts).filter(s => !s.type).length"
            assert page.run(running) == len(page_module._SCRIPTS)
            assert page.run("document.querySelectorAll('style, link').length") == 1 + 1
            assert page.stopped == []
            # opened by themselves the figures are documents, whose scripts a browser would run
            images = "Array.from(document.images, i => { i.loading = 'eager'; return i.decode() })"
            page.run(f"Promise.all({images}).then(() => 0)")
    for figure in (hostile / "figures").glob("*.svg"):
        for element in ElementTree.parse(figure).iter():
            assert not str(element.tag).endswith(("script", "}a", "foreignObject"))
            assert not [name for name in element.attrib if name.lower().startswith("on")]


@pytest.mark.slow
def test_contents_lead_to_every_section_and_follow_the_scroll(browser, results):
    current = "document.querySelector('nav [aria-current]')?.textContent"
    with browser.page(results / "report.html") as page:
        titles = page.run(
            "Array.from(document.querySelectorAll('main > section > h2'), h => h.textContent)"
        )
        links = page.run(
            "Array.from(document.querySelectorAll('nav .contents > ul > li > a'),"
            "a => a.textContent)"
        )
        assert links == titles and len(titles) >= 6
        for section, title in (("curves", "Stribeck curves"), ("runs", "Runs")):
            page.click(f"nav a[href='#{section}']")
            page.wait(f"{current} === {json.dumps(title)}")
            top = page.run(f"document.getElementById('{section}').getBoundingClientRect().top")
            assert 0 <= top < 300


@pytest.mark.slow
def test_table_sorts_filters_and_hides(browser, results):
    with browser.page(results / "report.html") as page:
        head = "#runs-table th[data-name=slowest]"
        page.click(f"{head} button")
        assert shown_runs(page) == ["sb-r_1", "sb-s_long", "sb-s_1", "broken"]
        assert page.run(f"document.querySelector('{head}').ariaSort") == "ascending"
        page.click(f"{head} button")
        assert shown_runs(page) == ["sb-s_1", "sb-s_long", "sb-r_1", "broken"]
        page.click("input[type=search]")
        page.type("no unit")
        assert shown_runs(page) == ["broken"]
        assert page.run("document.querySelector('.filters output').textContent") == "1 of 4 runs"
        page.click(".filters [type=reset]")
        page.wait("document.querySelector('.filters output').textContent === '4 runs'")
        page.run(
            "(() => { const s = document.querySelector('select[data-column=surface]');"
            "s.value = 'Sb-S'; s.dispatchEvent(new Event('input')) })()"
        )
        assert sorted(shown_runs(page)) == ["sb-s_1", "sb-s_long"]
        width = "document.querySelector('#runs-table th[data-name=medium]').offsetWidth"
        assert page.run(width) > 0
        page.click(".columns summary")
        page.click("[data-hides=medium]")
        assert page.run(width) == 0


@pytest.mark.slow
def test_friction_stands_beside_the_name_which_stays_on_a_narrow_screen(browser, results):
    with browser.page(results / "report.html", 400) as page:
        row = json.loads(
            page.run(
                "(() => { const table = document.getElementById('runs-table');"
                "const text = (row) => Array.from(row.cells, (cell) => cell.textContent.trim());"
                "return JSON.stringify([text(table.tHead.rows[0]), text(table.tBodies[0].rows[0])])"
                "})()"
            )
        )
        cells = dict(zip(*row, strict=True))
        head = [name for name in cells if name != "Why"]
        assert head[:3] == ["Run", "Status", "µ, slowest"]
        assert cells["µ, slowest"].startswith("0.7999 ± ") and cells["Surface"] == "Sb-R"
        assert (cells["Medium"], cells["Load"]) == ("glycerol", "31 N")
        assert cells["Noise"].endswith("%") and cells["Drift"].endswith("%")
        where = (
            "['Run', 'Left out'].map((name) => Math.round(Array.from(document.querySelectorAll("
            "'#runs-table thead th')).find((th) => th.textContent.trim() === name)"
            ".getBoundingClientRect().left)).join()"
        )
        left, right = map(int, page.run(where).split(","))
        page.run("document.querySelector('#runs-table').parentNode.scrollLeft = 5000")
        assert int(page.run(where).split(",")[0]) == left < 400
        assert int(page.run(where).split(",")[1]) < 400 < right


@pytest.mark.slow
def test_a_flagged_run_is_two_clicks_away_with_its_span_marked(browser, results):
    number = FLAGGED + 1
    with browser.page(results / "report.html") as page:
        page.click(".banner a[href='#findings']")
        page.click(f"#findings a[href='#run-{number}']")
        page.wait(f"document.querySelector('#run-{number} .plot canvas') !== null")
        assert page.run(f"document.querySelector('#run-{number}').open")
        # a third click zooms to what was flagged
        page.click(f"#run-{number} .flags button")
        low, high = span_of(page, number)
        assert low < 3.0 < high and high - low < 0.1
        marked = page.run(
            f"(() => {{ const c = document.querySelector('#run-{number} .plot canvas');"
            "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
            "for (let i = 0; i < d.length; i += 4)"
            "if (d[i] === 176 && d[i + 1] === 117 && d[i + 2] === 0) return true;"
            "return false })()"
        )
        assert marked, "the flagged span has its colour in the chart"


@pytest.mark.slow
def test_trace_zooms_and_pans_by_mouse_keys_and_buttons(browser, results):
    with browser.page(f"{(results / 'report.html').as_uri()}#run-1") as page:
        page.wait("document.querySelector('#run-1 .u-over') !== null")
        whole = span_of(page, 1)
        box = page.run(
            "(() => { const e = document.querySelector('#run-1 .u-over');"
            "e.scrollIntoView({block: 'center', behavior: 'instant'});"
            "const b = e.getBoundingClientRect(); return [b.x, b.y, b.width, b.height] })()"
        )
        x, y = box[0], box[1] + box[3] / 2
        page.mouse([(x + box[2] * share, y) for share in (0.25, 0.4, 0.5)])
        page.wait("!document.querySelector('#run-1 .state').textContent.startsWith('0 s')")
        low, high = span_of(page, 1)
        assert (low / whole[1], high / whole[1]) == pytest.approx((0.25, 0.5), abs=0.01)
        page.run("document.querySelector('#run-1 .plot').focus()")
        page.key("ArrowRight")
        later = span_of(page, 1)
        assert later[0] - low == pytest.approx(0.2 * (high - low), rel=1e-3)
        page.key("+", "+")
        near = span_of(page, 1)
        assert near[1] - near[0] == pytest.approx((high - low) / 2, rel=1e-3)
        page.click("#run-1 [data-act=out]")
        assert span_of(page, 1) == pytest.approx(later, rel=1e-3)
        page.run("document.querySelector('#run-1 .plot').focus()")
        page.key("Home")
        assert span_of(page, 1) == whole
        assert page.console == []


@pytest.fixture
def alone(results, tmp_path):
    """The page as it is sent: one file in a folder of its own."""
    file = tmp_path / "sent" / "report.html"
    file.parent.mkdir()
    file.write_text(page_of(results), encoding="utf-8")
    return file


@pytest.mark.slow
def test_the_page_sent_alone_zooms_into_the_finer_trace(browser, alone):
    number = LONG[0] + 1
    state = f"document.querySelector('#run-{number} .state').textContent"
    with browser.page(f"{alone.as_uri()}#run-{number}") as page:
        page.wait(f"document.querySelector('#run-{number} .plot canvas') !== null")
        assert "extremes kept" in page.run(state)
        page.run("window.saved = []; report.save = (...file) => saved.push(file)")
        for _ in range(2):
            page.click(f"#run-{number} [data-act=in]")
        page.wait(f"{state}.includes('all 10100 samples')")
        page.click(f"#run-{number} [data-act=csv]")
        rows = page.run("saved[0][2]").splitlines()[1:]
        assert page.requests == [alone.as_uri()] and page.console == page.stopped == []
        low, high = span_of(page, number)
    # what is drawn is what was measured
    index, samples = LONG
    _, _, _, load, mu = RUNS[index]
    run, _, _ = made_run([1e-3, 1e-2], load, mu, seed=9, samples=samples)
    shown = np.array([row.split(",")[2:] for row in rows if row.startswith("friction_")], float)
    time = run.time.values
    inside = (time >= low) & (time <= high)
    assert abs(len(shown) - inside.sum()) <= 2 and len(shown) > 2000
    ratio = (run.friction_force / run.normal_force).values
    found = np.interp(shown[:, 0], time, ratio)
    np.testing.assert_allclose(shown[:, 1], found, atol=1e-3 * np.ptp(ratio))


@pytest.mark.slow
def test_a_browser_that_cannot_unpack_keeps_the_trace_it_has(browser, alone):
    number = LONG[0] + 1
    state = f"document.querySelector('#run-{number} .state').textContent"
    address = f"{alone.as_uri()}#run-{number}"
    with browser.page(address, before="delete window.DecompressionStream") as page:
        page.wait(f"document.querySelector('#run-{number} .plot canvas') !== null")
        for _ in range(2):
            page.click(f"#run-{number} [data-act=in]")
        page.wait(f"{state}.includes('cannot unpack')")
        assert "extremes kept" in page.run(state) and page.console == []


@pytest.mark.slow
def test_the_page_sent_alone_hands_out_figures_with_their_numbers(browser, results, alone):
    with browser.page(alone) as page:
        page.run("window.saved = []; report.save = (...file) => saved.push(file)")
        for kind in ("svg", "csv"):
            page.click(f"#curves a[data-copy={kind}]")
        page.wait("saved.length === 2")
        name, _, svg = page.run("saved[0]")
        assert svg.startswith("<svg") and (results / "figures" / name).is_file()
        text = page.run("new TextDecoder().decode(saved[1][2])")
        assert text == (results / "figures" / page.run("saved[1][0]")).read_bytes().decode()
        assert page.requests == [alone.as_uri()] and page.console == page.stopped == []


@pytest.mark.slow
def test_no_accessibility_fault_of_weight(browser, results):
    for width, dark in ((1400, False), (400, True)):
        with browser.page(results / "report.html", width, 900, dark) as page:
            page.run("document.querySelectorAll('details').forEach(one => { one.open = true })")
            page.wait("document.querySelectorAll('.plot canvas').length === 6")
            page.run(f"{AXE};0")
            faults = page.run(
                "axe.run(document, {resultTypes: ['violations']}).then(found => found.violations"
                ".filter(v => ['serious', 'critical'].includes(v.impact))"
                ".map(v => [v.id, v.nodes.map(n => n.html.slice(0, 200))]))"
            )
            assert faults == []


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
@pytest.mark.parametrize("width", [400, 1400])
def test_page_never_scrolls_sideways(browser, results, width):
    with browser.page(results / "report.html", width) as page:
        page.run("document.querySelectorAll('details').forEach(one => { one.open = true })")
        page.wait("document.querySelectorAll('.plot canvas').length === 6")
        assert page.run("document.documentElement.scrollWidth") <= width


@pytest.mark.slow
def test_page_prints_with_its_traces(browser, results, tmp_path):
    with browser.page(results / "report.html") as page:
        page.pdf(tmp_path / "page.pdf")
        assert page.run("document.querySelectorAll('details.run[open] canvas').length") == 6
    assert (tmp_path / "page.pdf").read_bytes().startswith(b"%PDF")


@pytest.mark.slow
def test_details_of_very_many_runs_are_unpacked_when_they_are_opened(
    browser, results, hostile, tmp_path, monkeypatch
):
    monkeypatch.setattr(page_module, "_MOST_OPEN", 1)
    for folder, rows in ((results, 6), (hostile, 2)):
        document = json.loads((folder / "report.json").read_text())
        place = tmp_path / str(rows)
        place.mkdir()
        (place / "figures").symlink_to(folder / "figures")
        runs, store = document["runs"], Catalogue.of(folder)
        file = page_module.write_page(document, place, lambda runs=runs: iter(runs), store)
        store.close()
        assert "<h3>Segments</h3>" not in file.read_text("utf-8")
        address = f"{file.as_uri()}#run-1"
        with browser.page(address) as page:
            page.wait("document.querySelector('#run-1 table') !== null")
            assert page.run("document.querySelectorAll('#run-1 tbody tr').length") == rows
            assert page.run("document.querySelectorAll('[onerror],[onload]').length") == 0
            assert page.console == page.stopped == []
            assert [url for url in page.requests if not url.endswith(".svg")] == [file.as_uri()]
        with browser.page(address, before="delete window.DecompressionStream") as page:
            page.wait("document.querySelector('#run-1').textContent.includes('report.json')")
            assert page.console == []


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
                assert re.match(r"#|tables/|figures/|report\.json$", attrs["href"]), attrs["href"]
        style = page_of(folder).split("<style>")[1].split("</style>")[0]
        assert "url(" not in style and "@import" not in style
        assert not {"iframe", "object", "embed", "base"} & {tag for tag, _ in reader.elements}


def test_every_link_leads_somewhere(results):
    reader = Reader(page_of(results))
    ids = [attrs["id"] for _, attrs in reader.elements if "id" in attrs]
    assert len(ids) == len(set(ids))
    for link in reader.all("a"):
        target = link["href"]
        assert target[1:] in ids if target.startswith("#") else (results / target).is_file()


def test_figures_and_charts_are_described_in_words_and_numbers(results):
    reader = Reader(page_of(results))
    said = [image["alt"] for image in reader.all("img")]
    said += [d["aria-label"] for d in reader.all("div") if "plot" in d.get("class", "").split()]
    assert len(said) == 3 + 2 + 1 + 5
    for words in said:
        assert re.search(r"µ (from |= )?[01]\.\d|Hz stands out|smooth sliding at \d", words) or (
            "no oscillation stands out" in words
        ), words


def test_failed_runs_are_struck_out_with_their_reason(results):
    row = re.search(r'<tr class="failed">.*?</tr>', page_of(results), re.DOTALL)[0]
    assert "<s>broken</s>" in row and "column &#39;Fx&#39; has no unit" in row


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
    for name, count in (("script-src", len(page_module._SCRIPTS)), ("style-src", 1)):
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
    text = "".join(Reader(page_of(results)).text)
    assert 'name = "Glycerol & PMMA"' in text
    assert "ab" * 32 in text and "could not be read" in text


def test_the_charting_library_comes_with_its_licence(results):
    assert "Copyright (c) 2022 Leon Sorokin" in page_of(results)


def test_data_address_needs_no_escaping_in_an_attribute():
    address = data_address('<?xml version="1.0"?>\n<svg a="1&amp;2">\n<g id="#x%"/></svg>')
    assert not set('"&<>#\n') & set(address)
    assert address.startswith("data:image/svg+xml,%3Csvg a='1%26amp;2'%3E")
