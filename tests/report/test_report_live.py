"""What a reader does with the page: choose, hide, sort, zoom, take along, print."""

import base64
import io
import json
import re
import zipfile

import numpy as np
import openpyxl
import pytest
from report_pages import (
    FLAGGED,
    LONG,
    RUNS,
    SAVING,
    drawn,
    figures_of,
    names,
    page_of,
)
from reporting import made_run

from tribolab.campaign.store.catalogue import Catalogue
from tribolab.report.page import page as page_module

PANEL = (
    "(() => { const e = document.querySelector('#run-1 .nsewdrag');"
    "e.scrollIntoView({block: 'center', behavior: 'instant'});"
    "const b = e.getBoundingClientRect(); return [b.x, b.y, b.width, b.height] })()"
)
SYSTEMS = ["Sb-R, glycerol", "Sb-S, dry", "Sb-S, glycerol"]
HALF = "half the maximum"  # the line to read it at


@pytest.fixture(scope="module")
def whole(flagged_results):
    """All results."""
    return flagged_results


@pytest.fixture(scope="module")
def alone(results):
    return results / "report.html"


def rows(page):
    """Return the names in the table of runs, as they stand there."""
    return page.run(
        "Array.from(document.querySelectorAll('#runs-table tbody tr[data-run]:not([hidden])'),"
        "row => row.dataset.run)"
    )


def span_of(page, run):
    """Return what a run's trace says of the time that it shows: from, to [s]."""
    text = page.run(f"document.querySelector('#run-{run} .state').textContent")
    return tuple(float(word) for word in re.match(r"([\d.]+) s to ([\d.]+) s", text).groups())


@pytest.mark.slow
def test_the_first_screen_is_the_answer(browser, results):
    with browser.page(results / "report.html", 1400, 900) as page:
        assert drawn(page, "card-1") == ["measured"]
        seen = page.run(
            "Array.from(document.querySelectorAll('.answer'), card => ({"
            "bottom: card.getBoundingClientRect().bottom,"
            "name: card.querySelector('h3').textContent}))"
        )
        assert [card["name"] for card in seen] == SYSTEMS
        assert all(0 < card["bottom"] < 900 for card in seen)
        head = page.run("document.querySelector('.banner').textContent")
        assert "CHECK partly usable: 3 of 4 runs usable" in head and "broken: left out" in head
        numbers = page.run("report.cells(document.querySelector('table.numbers'))")
        assert numbers[1][:3] == [SYSTEMS[0], "31 N", "0.800 ± 0.016 at 1 µm/s"]
        assert rows(page) == ["broken", "sb-s_1", "sb-r_1", "sb-s_long"]
        page.click("#runs-table tr[data-run=sb-s_1] .spark")
        page.wait("document.querySelector('#alongside #run-2[open] .js-plotly-plot') !== null")
        box = page.run("document.querySelector('#run-2 .plot').getBoundingClientRect().toJSON()")
        assert 0 < box["top"] < 700 and box["right"] < 1000, "next to the list"
        page.click("[data-run-act=close]")
        page.wait(
            "document.getElementById('alongside').hidden && !document.querySelector('.view').hidden"
        )


@pytest.mark.slow
def test_points_say_what_their_error_holds_and_lead_to_their_run(browser, results):
    series = figures_of(results)["card-1"]["series"][0]
    words = series["hover"][0]
    assert "(U95, between runs)" in words and "U95 within one run: " in words
    # only the uncertainty of the mean has a ±
    assert "mean of 3 runs\n" in words and words.count("±") == 1
    assert "scatter of the runs: 0.016" in words
    assert re.search(r"\d+ independent samples\nsb-r_1$", series["hover"][0])
    with browser.page(results / "report.html") as page:
        drawn(page, "card-1")
        page.run(
            "(() => { const point = document.querySelector('#card-1 .point')"
            ".getBoundingClientRect(), at = { clientX: point.x + point.width / 2,"
            " clientY: point.y + point.height / 2 };"
            " document.querySelector('#card-1 .nsewdrag').dispatchEvent("
            "new MouseEvent('mousemove', { ...at, bubbles: true })) })()"
        )
        page.wait("document.querySelector('#card-1 .told') !== null")
        words, apart = page.run(
            "(() => { const told = document.querySelector('#card-1 .told'), of = one =>"
            " one.getBoundingClientRect(), point = of(document.querySelector('#card-1 .point'));"
            " return [told.textContent, of(told).bottom < point.top || of(told).top > point.bottom]"
            " })()"
        )
        assert words == series["hover"][0] and apart
        page.click("#card-1 .points .point")
        page.wait("document.querySelector('#run-1').open && location.hash === '#run-1'")


@pytest.mark.slow
def test_what_is_looked_at_stands_in_the_address_and_rules_tables_and_figures(browser, results):
    address = (results / "report.html").as_uri()
    with browser.page(f"{address}#surface=Sb-S&medium=dry&load=31N") as page:
        assert rows(page) == ["sb-s_1"]
        shown = (
            "Array.from(document.querySelectorAll('.answer:not([hidden]) h3'), h => h.textContent)"
        )
        assert page.run(shown) == ["Sb-S, dry"]
        assert drawn(page, "curves-compared") == ["Sb-S, dry", HALF]
        # a link to a section keeps it
        page.click("nav a[href='#curves']")
        page.wait("location.hash === '#curves&surface=Sb-S&medium=dry&load=31N'")
        page.click(".filters [type=reset]")
        page.wait("document.querySelectorAll('.answer:not([hidden])').length === 3")
        assert names(page, "curves-compared") == [*SYSTEMS, HALF]
        # hidden by its box in the table, a run goes from the figures too
        page.click("#runs [data-every]")
        page.click("input[data-hide=sb-r_1]")
        assert page.run("location.hash").endswith("&hide=sb-r_1")
        assert "sb-r_1" not in rows(page)
        assert names(page, "curves-compared") == [*SYSTEMS[1:], HALF]
        assert "1 hidden" in page.run("document.querySelector('#runs output').textContent")
        assert page.console == page.stopped == []


@pytest.mark.slow
def test_what_the_address_asks_for_and_no_run_has_is_said_and_hides_nothing(browser, alone):
    said = "document.querySelector('.asked').textContent"
    every = ["broken", "sb-s_1", "sb-r_1", "sb-s_long"]
    asked = [
        ("#load=92N", "no run at 92 N (shown: 31 N)", every),
        ("#surface=Sb-X", "no surface “Sb-X” (all are shown; available: Sb-R and Sb-S)", every),
        ("#medium=oil", "no medium “oil” (all are shown; available: glycerol and dry)", every),
        ("#hide=sb-r_7", "no run “sb-r_7” to hide", every),
        ("#mark=sb-r_7", "nothing named “sb-r_7” to highlight", every),
        ("#surface=sb-s&run-99", "no section “run-99”", ["sb-s_1", "sb-s_long"]),
        ("#load=31N&medium=dry", "", ["sb-s_1"]),
    ]
    with browser.page(f"{alone.as_uri()}#medium=dry") as page:
        for address, words, left in asked:
            page.run(f"location.hash = {json.dumps(address)}")
            shown = words and f"The link refers to something that is not on this page: {words}."
            page.wait(f"{said} === {json.dumps(shown)}")
            assert rows(page) == left, address
        assert page.run("document.querySelector('.asked').hidden")


@pytest.mark.slow
def test_a_highlighted_run_stands_out(browser, results):
    with browser.page(f"{(results / 'report.html').as_uri()}#mark=sb-s_long") as page:
        marked = "Array.from(document.querySelectorAll('tr.marked'), row => row.dataset.run)"
        assert page.run(marked) == ["sb-s_long"]
        drawn(page, "curves-compared")
        faded = page.run(
            "document.querySelector('#curves-compared .plot')._fullData.map(o => o.opacity)"
        )
        assert faded == [0.15, 0.15, 1, 0.15]


@pytest.mark.slow
def test_tables_sort_by_several_columns_and_filter(browser, results):
    with browser.page(results / "report.html") as page:
        page.click("#runs [data-every]")
        head = "#runs-table th[data-name={}]"
        page.click(f"{head.format('surface')} button")
        page.click(f"{head.format('µ')} button", shift=True)
        page.click(f"{head.format('µ')} button", shift=True)
        assert rows(page) == ["sb-r_1", "sb-s_1", "sb-s_long", "broken"]
        orders = "['surface', 'µ'].map(name => document.querySelector("
        orders += "`#runs-table th[data-name=${name}]`)).map(head => head.ariaSort)"
        assert page.run(orders) == ["ascending", "descending"]
        page.click("#runs input[type=search]")
        page.type("no unit")
        assert rows(page) == ["broken"]
        assert page.run("document.querySelector('#runs output').textContent") == "1 of 4 runs"
        page.click(".found [type=reset]")
        assert rows(page) == ["broken", "sb-s_1", "sb-r_1", "sb-s_long"]


@pytest.mark.slow
def test_heads_of_columns_explain_themselves_on_hover_and_focus(browser, results):
    tip = "document.getElementById('tip').hidden ? '' : document.getElementById('tip').textContent"
    with browser.page(results / "report.html") as page:
        page.click("#runs [data-every]")
        page.run("document.querySelector('[data-name=noise] button').focus()")
        assert page.run(tip).startswith("Standard deviation of friction along a segment")
        page.key("Escape")
        assert page.run(tip) == ""
        x, y = page.run(
            "(() => { const e = document.querySelector('[data-name=drift]');"
            "e.scrollIntoView({block: 'center', behavior: 'instant'});"
            "const b = e.getBoundingClientRect(); return [b.x + 5, b.y + 5] })()"
        )
        page.mouse([(x, y)])
        assert "significant change" in page.run(tip)


@pytest.mark.slow
def test_the_page_sent_alone_hands_out_tables_and_figures(browser, alone):
    with browser.page(alone) as page:
        page.run(SAVING)
        for kind in ("csv", "xlsx"):
            page.click(f"#runs [data-out={kind}]")
        name, _, text = page.run("saved[0]")
        assert name == "runs.csv"
        assert text.splitlines()[3].startswith("sb-r_1,ok,0.8,") and "sb-s_long" in text
        book = page.run(
            "saved[1][2].arrayBuffer().then(b => btoa(String.fromCharCode(...new Uint8Array(b))))"
        )
        raw = io.BytesIO(base64.b64decode(book))
        assert zipfile.ZipFile(raw).testzip() is None
        sheet = openpyxl.load_workbook(raw).active
        assert [cell.value for cell in sheet[1]][:2] == ["Run", "State"]
        assert sheet["C4"].value == 0.8 and sheet.max_row == 1 + 4
        drawn(page, "card-1")
        for kind in ("csv", "svg", "png"):
            page.click(f"#card-1 [data-act={kind}]")
            page.wait(f"saved.some(file => file[0] === 'card-1.{kind}')")
        files = page.run("Object.fromEntries(saved.map(f => [f[0], f[2].length ?? 0]))")
        assert files["card-1.png"] > 5000
        svg = page.run("saved.find(f => f[0] === 'card-1.svg')[2]")
        assert svg.startswith("<svg") and "friction coefficient" in svg
        table = page.run("saved.find(f => f[0] === 'card-1.csv')[2]").splitlines()
        assert len(table) == 1 + len(figures_of(alone.parent)["card-1"]["series"][0]["x"])
        cells = page.run("['=1+1', '-3.5', '@x', 'Sb-R'].map(report.harmless)")
        assert cells == ["'=1+1", "-3.5", "'@x", "Sb-R"], "a spreadsheet would compute them"
        assert page.requests == [alone.as_uri()] and page.console == page.stopped == []


@pytest.mark.slow
def test_a_flagged_run_is_two_clicks_away_with_its_span_marked(browser, results):
    number = FLAGGED + 1
    with browser.page(results / "report.html") as page:
        page.click("nav a[href='#findings']")
        page.click(f"#findings a[href='#run-{number}']")
        page.wait(f"document.querySelector('#run-{number} .js-plotly-plot') !== null")
        page.wait(f"document.querySelector('#run-{number} .state').textContent !== ''")
        # a third click zooms to what was flagged
        page.click(f"#run-{number} .flags button")
        page.wait(f"!document.querySelector('#run-{number} .state').textContent.startsWith('0 s')")
        low, high = span_of(page, number)
        assert low < 3.0 < high and high - low < 0.1
        shapes = page.run(
            f"document.querySelector('#run-{number} .plot').layout.shapes.map(s => s.fillcolor)"
        )
        assert "#b07500" in shapes, "the flagged span has its colour in the trace"


@pytest.mark.slow
def test_trace_zooms_and_pans_by_mouse_keys_and_buttons(browser, results):
    state = "document.querySelector('#run-1 .state').textContent"
    with browser.page(f"{(results / 'report.html').as_uri()}#run-1") as page:
        page.wait("document.querySelector('#run-1 .nsewdrag') !== null")
        whole = span_of(page, 1)
        box = page.run(PANEL)
        x, y = box[0], box[1] + box[3] / 2
        page.mouse([(x + box[2] * share, y) for share in (0.25, 0.4, 0.5)])
        page.wait(f"!{state}.startsWith('0 s')")
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
        page.key("+", "+")
        assert span_of(page, 1) != whole
        box = page.run(PANEL)
        middle = box[0] + box[2] / 2, box[1] + box[3] / 2
        page.double_click(middle, f"{state}.startsWith('0 s')")
        assert span_of(page, 1) == whole
        assert page.console == []


@pytest.mark.slow
def test_the_page_sent_alone_zooms_into_the_finer_trace(browser, alone):
    number = LONG[0] + 1
    state = f"document.querySelector('#run-{number} .state').textContent"
    with browser.page(f"{alone.as_uri()}#run-{number}") as page:
        page.wait(f"document.querySelector('#run-{number} .js-plotly-plot') !== null")
        page.wait(f"{state}.includes('extremes kept')")
        page.run(SAVING)
        for _ in range(2):
            page.click(f"#run-{number} [data-act=in]")
        page.wait(f"{state}.includes('all 10100 samples')")
        page.click(f"#run-{number} [data-act=csv]")
        page.wait("saved.length === 1")
        table = page.run("saved[0][2]").splitlines()[1:]
        assert page.requests == [alone.as_uri()] and page.console == page.stopped == []
        low, high = span_of(page, number)
    # what is handed out is what was measured
    index, samples = LONG
    _, _, _, load, mu = RUNS[index]
    run, _, _ = made_run([1e-3, 1e-2], load, mu, seed=9, samples=samples)
    shown = np.array([row.split(",")[2:] for row in table if row.startswith("friction_")], float)
    time = run.time.values
    inside = (time >= low) & (time <= high)
    assert abs(len(shown) - inside.sum()) <= 2 and len(shown) > 2000
    ratio = (run.friction_force / run.normal_force).values
    found = np.interp(shown[:, 0], time, ratio)
    np.testing.assert_allclose(shown[:, 1], found, atol=1e-3 * np.ptp(ratio))


@pytest.mark.slow
def test_a_browser_that_cannot_unpack_says_so_and_keeps_tables_and_sentences(browser, alone):
    with browser.page(alone, before="delete window.DecompressionStream") as page:
        page.wait("document.querySelector('#card-1').textContent.includes('too old')")
        assert page.run("document.querySelectorAll('#card-1 .still .full').length") > 0
        assert len(rows(page)) == 4
        assert "Highest µ" in page.run("document.querySelector('.view').textContent")
        page.click("#runs-table tr[data-run=sb-r_1] a")
        page.wait("document.querySelector('#run-1').textContent.includes('report.json')")
        assert page.console == []


@pytest.mark.slow
def test_on_a_narrow_screen_only_tables_move_and_their_first_column_stays(browser, results):
    where = (
        "['run', 'trace'].map(name => Math.round(document.querySelector("
        "`#runs-table th[data-name=${name}]`).getBoundingClientRect().left))"
    )
    with browser.page(results / "report.html", 400) as page:
        left, right = page.run(where)
        page.run("document.querySelector('#runs-table').parentNode.scrollLeft = 5000")
        stays, comes = page.run(where)
        assert stays == left and comes < right


@pytest.mark.slow
def test_every_figure_is_drawn_again_when_the_light_changes(browser, results):
    ink = (
        "Array.from(document.querySelectorAll('.js-plotly-plot')).filter(p => p.clientWidth)"
        ".map(p => p.layout.font.color)"
    )
    with browser.page(f"{(results / 'report.html').as_uri()}#run-1") as page:
        page.wait("document.querySelector('#run-1 .nsewdrag') !== null")
        drawn(page, "curves-compared")
        light = page.run(ink)
        for _ in range(2):
            page.click("#theme")
        assert page.run("document.documentElement.dataset.theme") == "dark"
        dark = page.run(ink)
        assert len(dark) >= 2 and not set(dark) & set(light)
        page.click("#theme")  # which the browser would remember for the next page


@pytest.mark.slow
def test_rows_of_very_many_runs_are_packed_and_all_of_them_sorted(
    browser, whole, tmp_path, monkeypatch
):
    monkeypatch.setattr(page_module, "_MAX_ROWS", 2)
    document = json.loads((whole / "report.json").read_text("utf-8"))
    store = Catalogue.of(whole)
    file = page_module.write_page(document, tmp_path, lambda: iter(document["runs"]), store)
    store.close()
    assert file.read_text("utf-8").count("<tr data-run=") == 2
    with browser.page(file) as page:
        page.wait("document.querySelectorAll('#runs-table tr[data-run]').length === 4")
        assert rows(page) == ["broken", "sb-s_1", "sb-r_1", "sb-s_long"]
        for _ in range(2):
            page.click("#runs-table th[data-name=run] button")
        assert rows(page) == ["sb-s_long", "sb-s_1", "sb-r_1", "broken"]
        page.click("#runs input[type=search]")
        page.type("no unit")
        assert rows(page) == ["broken"]
        assert page.console == page.stopped == []


def test_the_library_comes_with_its_licence(results):
    assert "Copyright (c) 2016-2024 Plotly Technologies Inc." in page_of(results)
