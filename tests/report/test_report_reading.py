"""The page as a person reads it: by mouse, by keyboard alone, by finger, and on paper."""

import pytest
from printed import printed
from report_pages import SAVING, SHOWN, drawn, figures_of, names, page_of
from reporting import made_outcome

from tribolab.report.results import write_report

LOADS = ["31 N", "91 N"]
SYSTEMS = ["Sb-R, glycerol", "Sb-S, dry"]
ADDRESS = "decodeURIComponent(location.hash)"
ROWS = "Array.from(document.querySelectorAll('#runs-table tr[data-run]'), row => row.dataset.run)"
CHIP = "Array.from(document.querySelectorAll('#{} .loads [aria-pressed=true]'), b => b.textContent)"
SPAN = "document.querySelector('#card-1 .plot')._fullLayout.xaxis.range.map(Number)"


@pytest.fixture(scope="module")
def whole(repeated_results):
    """Results of two conditions, the first at two loads and with repeats."""
    return repeated_results


@pytest.fixture
def page(browser, results):
    """The page, asked afterwards whether it complained or wanted anything."""
    with browser.page(results / "report.html") as opened:
        opened.run(SAVING)
        yield opened
        assert opened.console == opened.stopped == []
        assert [url.split("#")[0] for url in opened.requests] == [
            (results / "report.html").as_uri()
        ]


def by_mouse(page, selector, shift=False):
    page.click(selector, shift)


def by_keyboard(page, selector, shift=False):
    page.press(selector, shift=shift)


WAYS = by_mouse, by_keyboard


@pytest.mark.slow
def test_the_load_that_is_chosen_on_a_card_holds_for_all_figures_and_sentences(page):
    figures = "card-1", "curves-compared"
    for figure in figures:
        drawn(page, figure)
        assert page.run(CHIP.format(figure)) == ["31 N"]
    numbers = "report.cells(document.querySelector('table.numbers')).slice(1).map(row => row[1])"
    for act, place, load in zip(WAYS, ("last", "first"), reversed(LOADS), strict=True):
        act(page, f"#curves-compared .loads button:{place}-child")
        assert [page.run(CHIP.format(figure)) for figure in figures] == [[load]] * 2
        assert page.run(ADDRESS) == f"#load={load.replace(' ', '')}"
        assert set(page.run(numbers)) == {load}


@pytest.mark.slow
def test_figures_switch_axes_hand_themselves_out_and_lead_to_runs(page):
    drawn(page)
    for act, scale in zip(WAYS, ("linear", "log"), strict=True):
        for axis in "xy":
            act(page, f"#card-1 [data-scale={axis}]")
            kind = f"document.querySelector('#card-1 .plot')._fullLayout.{axis}axis.type"
            assert page.run(kind) == scale
            said = page.run(f"document.querySelector('#card-1 [data-scale={axis}]').textContent")
            assert scale in said
        for kind in ("csv", "svg", "png"):
            act(page, f"#card-1 [data-act={kind}]")
            page.wait(f"saved.some(file => file[0] === 'card-1.{kind}')")
        act(page, "#runs-table tr[data-run=a1] a")
        page.wait("document.querySelector('#run-1').open && location.hash === '#run-1'")
        page.run("saved.length = 0; history.back(); 0")
        page.wait("location.hash === '' && document.getElementById('alongside').hidden")


@pytest.mark.slow
def test_a_figure_fills_the_screen_and_comes_back(page):
    drawn(page)
    size = "['width', 'height'].map(s => document.querySelector('#card-1 .plot')._fullLayout[s])"
    before = page.run(size)
    for act in WAYS:
        act(page, "#card-1 [data-act=full]")
        page.wait("document.fullscreenElement?.id === 'card-1'")
        page.wait(f"{size}[1] > {before[1]}")
        act(page, "#card-1 [data-act=full]")
        page.wait("document.fullscreenElement === null")
        page.wait(f"{size}.join() === '{before[0]},{before[1]}'")


@pytest.mark.slow
def test_the_legend_switches_and_isolates_what_a_figure_shows(page):
    drawn(page, "curves-runs")
    assert names(page, "curves-runs") == [SYSTEMS[0]] * 2 + [SYSTEMS[1]] * 2
    page.click("#curves-runs .legendtoggle")
    page.wait(f"{SHOWN.format('curves-runs')}.length === 2")
    assert names(page, "curves-runs") == [SYSTEMS[1]] * 2


@pytest.mark.slow
def test_a_figure_zooms_by_mouse_and_by_key_and_shows_all_again(page):
    drawn(page)
    first = page.run(SPAN)
    x, y = page.middle("#card-1 .nsewdrag")
    page.mouse([(x - 40, y), (x, y), (x + 40, y)])
    page.wait(f"{SPAN}[0] > {first[0]}")
    page.click("#card-1 [data-act=whole]")
    assert page.run(SPAN) == pytest.approx(first)
    page.tab_to("#card-1 .plot")
    page.key("+", "+")
    near = page.run(SPAN)
    assert near[1] - near[0] == pytest.approx((first[1] - first[0]) / 2)
    page.key("ArrowRight")
    assert page.run(SPAN)[0] == pytest.approx(near[0] + 0.2 * (near[1] - near[0]))
    page.key("Home")
    assert page.run(SPAN) == pytest.approx(first)


@pytest.mark.slow
def test_tables_sort_by_two_columns_and_are_taken_along(page):
    head = "#runs-table th[data-name={}] button"
    page.run("document.execCommand = () => true; navigator.clipboard.writeText = async t => {"
             "window.copied = t }; 0")  # fmt: skip
    page.click("#runs [data-every]")
    for act in WAYS:
        act(page, head.format("load"))
        act(page, head.format("load"))
        act(page, head.format("surface"), shift=True)
        assert page.run(ROWS) == ["b1", "a1", "a2", "c1", "c2"]
        act(page, "#runs [data-out=copy]")
        page.wait("window.copied !== undefined")
        lines = page.run("copied").splitlines()
        assert lines[0].startswith("Run\tState\t") and len(lines) == 1 + 5
        assert [line.split("\t")[0] for line in lines[1:]] == ["b1", "a1", "a2", "c1", "c2"]
        for kind in ("csv", "xlsx"):
            act(page, f"#runs [data-out={kind}]")
            page.wait(f"saved.some(file => file[0] === 'runs.{kind}')")
        page.run("saved.length = 0; delete window.copied; 0")
        act(page, head.format("run"))
        assert page.run(ROWS) == ["a1", "a2", "b1", "c1", "c2"]


@pytest.mark.slow
def test_columns_that_do_not_fit_come_when_asked_for_and_are_taken_along_anyway(page):
    names = "report.cells(document.getElementById('runs-table'))[0]"
    every = page.run(names)
    assert {"Surface", "Medium", "Segments", "Left out"} < set(every)
    surface = "document.querySelector('#runs-table [data-name=surface]').offsetWidth"
    for act in WAYS:
        for seen in (True, False):
            act(page, "#runs [data-every]")
            assert (page.run(surface) > 0) == seen
    assert page.run(names) == every


@pytest.mark.slow
def test_what_is_looked_at_is_chosen_by_keyboard_alone_and_stands_in_the_address(page):
    drawn(page, "curves-runs")
    page.press("#answer [data-view=surface]", "ArrowDown")
    page.wait(f"{ADDRESS} === '#surface=Sb-R'")
    assert set(page.run(ROWS)) == {"a1", "a2", "b1"}
    assert set(names(page, "curves-runs")) == {SYSTEMS[0]}
    page.tab_to("#answer [data-view=mark]")
    page.type("a2")
    page.click("#runs [data-every]")
    page.press("#runs-table tr[data-run=a1] input[data-hide]", " ")
    assert page.run(ADDRESS) == "#surface=Sb-R&mark=a2&hide=a1"
    page.press("#answer .found [type=reset]")
    assert set(page.run(ROWS)) == {"a1", "a2", "b1", "c1", "c2"}


@pytest.mark.slow
def test_a_finger_reads_a_point_goes_to_its_run_pans_and_zooms(browser, results):
    with browser.page(results / "report.html", 400, 800, touch=True) as page:
        drawn(page)
        point = page.middle("#card-1 .points .point")
        page.tap(point)
        page.wait("document.querySelector('#card-1 .told') !== null")
        assert "v = 1 µm/s" in page.run("document.querySelector('#card-1 .told').textContent")
        assert page.run("location.hash") == "", "who cannot hover reads first"
        page.tap(point)
        page.wait("location.hash === '#run-1' && document.querySelector('#run-1 .nsewdrag')")
        page.run("document.querySelector('[data-run-act=close]').click()")
        first = page.run(SPAN)
        x, y = page.middle("#card-1 .nsewdrag")
        page.touch([(x + step, y) for step in (0, -15, -30, -60)])
        page.wait(f"{SPAN}[0] > {first[0]}")
        moved = page.run(SPAN)
        assert moved[1] - moved[0] == pytest.approx(first[1] - first[0])
        steps = (20, 30, 45, 60)
        page.touch([(x - step, y) for step in steps], [(x + step, y) for step in steps])
        page.wait(f"{SPAN}[1] - {SPAN}[0] < {0.6 * (first[1] - first[0])}")
        # up and down the page scrolls, and no figure is in the way
        before = page.run("scrollY")
        page.touch([(x, y + step) for step in (0, -30, -60, -120, -180)])
        page.wait(f"scrollY > {before}")
        assert page.run("document.documentElement.scrollWidth") <= 400
        assert page.console == page.stopped == []


@pytest.mark.slow
def test_printed_at_once_the_page_has_its_figures_and_tables(browser, results, tmp_path):
    address = (results / "report.html").as_uri()
    sheets = printed(browser, address, tmp_path)
    first = sheets[0].text
    assert first.count("frictioncoefficientµ") == 2, "a figure on each card"
    assert [sheet for sheet in sheets if len(sheet.text) < 40] == [], "none is blank"
    text = "".join(sheet.text for sheet in sheets)
    figures = figures_of(results).values()
    shown = [one for one in figures if one["section"] not in ("view-load", "view-time")]
    assert len(shown) > 2 and all(one["title"].replace(" ", "") in text for one in shown)
    assert all(name in text for name in ("a1", "a2", "b1", "c1", "c2")), "the table of runs"
    assert "velocity(m/s)" not in text
    everything = printed(browser, f"{address}?print=all", tmp_path)
    text = "".join(sheet.text for sheet in everything)
    assert len(everything) > len(sheets)
    assert text.count("velocity(m/s)") == 5, "a trace of every run"


@pytest.mark.slow
def test_the_answer_of_many_conditions_fits_on_two_sheets(browser, tmp_path):
    systems = [(surface, medium) for surface in "ABCDEF" for medium in ("oil", "water", "dry")]
    runs = [(f"{s}{m}{load:g}", s, m, load, 0.8) for s, m in systems for load in (31.0, 91.0)]
    outcome = made_outcome(tmp_path, runs, "Many", speeds=[1e-6, 1e-2], samples=40)
    write_report(outcome, figures="none")
    sheets = printed(browser, (outcome.folder / "report.html").as_uri(), tmp_path)
    text = "".join(sheet.text for sheet in sheets[:2])
    assert text.count("frictioncoefficientµ") == len(systems)
    # a figure of very many rows is made to fit, with its heading above it
    [rows] = [sheet for sheet in sheets if sheet.has("Steady sliding or stick-slip")]
    assert all(rows.has(f"{s}, {m}, {load} N") for s, m in systems for load in (31, 91))


@pytest.mark.slow
def test_heads_of_tables_are_repeated_on_every_sheet(browser, whole, tmp_path):
    row = r"<tr><td>cell</td></tr>" * 150
    table = f"<div class='scroll'><table><thead><tr><th>Head here</th></tr></thead>{row}</table>"
    file = tmp_path / "long.html"
    file.write_text(
        page_of(whole).replace('<div class="tabled"', f'{table}</div><div class="tabled"', 1)
    )
    sheets = printed(browser, file.as_uri(), tmp_path)
    with_rows = [sheet for sheet in sheets if sheet.has("cell" * 5)]
    assert len(with_rows) > 1 and all(sheet.has("Head here") for sheet in with_rows)


@pytest.mark.slow
def test_the_first_screen_has_its_figures_before_any_script_is_done(browser, results):
    with browser.page(results / "report.html", before="delete window.DecompressionStream") as page:
        page.wait("document.querySelector('#card-1').textContent.includes('too old')")
        pictures = page.run(
            "Array.from(document.querySelectorAll('.view:not([hidden]) .still'), one => ["
            "one.querySelectorAll('.full, .open').length, one.getBoundingClientRect().height])"
        )
        assert len(pictures) == len(SYSTEMS)
        assert all(marks > 0 and height > 150 for marks, height in pictures)


@pytest.mark.slow
def test_no_two_figures_show_the_same_numbers(whole, two_runs):
    for folder in (whole, two_runs.parent / "results"):
        seen = {}
        for name, figure in figures_of(folder).items():
            for one in figure["series"]:
                if len(one["y"]) > 2:
                    seen.setdefault((str(one["x"]), str(one["y"])), set()).add(name)
        assert len(seen) > 4
        assert [names for names in seen.values() if len(names) > 1] == []
