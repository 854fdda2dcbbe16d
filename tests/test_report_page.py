"""The page in a real browser: it opens offline, nothing in a name runs, everybody can read it."""

import json
import os
import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pytest
from reporting import made_outcome

from tribolab.report.page import data_address
from tribolab.report.results import write_report

BROWSER = next(
    (
        found
        for name in ("chromium", "chromium-browser", "google-chrome", "chrome")
        if (found := shutil.which(name))
    ),
    "",
)
HOSTILE = [
    "<script>document.title='broken into'</script>",
    '"><img src=x onerror="document.title=\'broken into\'">',
    "'+alert(1)+' javascript:alert(1) {{ 7*7 }} {% raw %}",
    "</style></script><svg onload=\"document.title='broken into'\">",
]
RUNS = [("sb-r_1", "Sb-R", "glycerol", 31.0, 0.8), ("sb-s_1", "Sb-S", "glycerol", 31.0, 1.1)]


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    if not BROWSER:
        message = "no chromium was found to open the report with"
        if os.environ.get("TRIBOLAB_REQUIRE_BROWSER"):
            pytest.fail(message)
        pytest.skip(message)

    def run(page, *options):
        profile = tmp_path_factory.mktemp("profile")
        command = [
            BROWSER,
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--enable-logging=stderr",
            "--v=0",
            f"--user-data-dir={profile}",
            *options,
            str(page) if "://" in str(page) else Path(page).as_uri(),
        ]
        done = subprocess.run(command, capture_output=True, text=True, timeout=90, check=True)
        console = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
        return done.stdout, console

    return run


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    failed = [("broken", "bad.csv: column 'Fx' has no unit")]
    made = made_outcome(tmp_path_factory.mktemp("page"), RUNS, "Glycerol & PMMA", failed)
    write_report(made)
    return made.folder


@pytest.fixture(scope="module")
def hostile(tmp_path_factory):
    runs = [(HOSTILE[1], HOSTILE[2], HOSTILE[0], 31.0, 0.8)]
    failed = [(HOSTILE[3], HOSTILE[1])]
    folder = tmp_path_factory.mktemp("hostile")
    made = made_outcome(folder, runs, HOSTILE[0], failed, speeds=[1e-3], samples=50)
    write_report(made)
    return made.folder


class Reader(HTMLParser):
    """Collects the elements of a page, and checks that they are closed in order."""

    VOID = {"meta", "link", "img", "br", "input", "hr", "wbr"}

    def __init__(self, text):
        super().__init__()
        self.elements, self.open, self.text = [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text.append(data)

    def all(self, tag):
        return [attrs for name, attrs in self.elements if name == tag]


def page_of(folder):
    return (folder / "report.html").read_text(encoding="utf-8")


def with_probe(folder, tmp_path, script):
    """Return a copy of the page, without its policy, that runs a script and shows its answer."""
    text = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", page_of(folder))
    probe = f"<script>document.title = 'answer:' + JSON.stringify((() => {{{script}}})())</script>"
    path = tmp_path / "probed.html"
    path.write_text(text.replace("</body>", probe + "</body>"), encoding="utf-8")
    return path


def answer(dom):
    found = re.search(r"<title>answer:(.*?)</title>", dom)
    assert found, "the page's title was not set by the probe"
    return json.loads(found[1].replace("&amp;", "&").replace("&lt;", "<").replace("&gt;", ">"))


@pytest.mark.slow
def test_page_opens_without_a_word_on_the_console(browser, results):
    dom, console = browser(results / "report.html", "--dump-dom")
    assert console == []
    assert "2 of 3 runs done; 1 failed" in dom
    assert "<title>Glycerol &amp; PMMA" in dom
    # its script ran under its own policy: headers became buttons
    assert dom.count('<th scope="col"><button') > 10


@pytest.mark.slow
def test_the_browser_reports_errors_and_what_the_policy_stopped(browser, results, tmp_path):
    trouble = "<script>throw 1</script><img src='http://localhost:9/x.png'></body>"
    path = tmp_path / "trouble.html"
    path.write_text(page_of(results).replace("</body>", trouble), encoding="utf-8")
    assert len(browser(path, "--dump-dom")[1]) == 2


@pytest.mark.slow
def test_every_figure_on_the_page_can_be_drawn(browser, results, tmp_path):
    sizes = (
        "<script>addEventListener('load', async () => {"
        "for (const d of document.querySelectorAll('details')) d.open = true;"
        "const all = Array.from(document.images);"
        "await Promise.all(all.map(i => {i.loading = 'eager'; return i.decode()}));"
        "document.title = 'answer:' + JSON.stringify(all.map(i => i.naturalWidth))})</script>"
    )
    text = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", page_of(results))
    path = tmp_path / "drawn.html"
    path.write_text(text.replace("</body>", sizes + "</body>"), encoding="utf-8")
    dom, _ = browser(path, "--dump-dom", "--virtual-time-budget=20000")
    widths = answer(dom)
    assert len(widths) == 2 * 2 + 2 + 1
    assert min(widths) > 300


@pytest.mark.slow
def test_nothing_in_a_name_runs(browser, hostile, tmp_path):
    dom, console = browser(hostile / "report.html", "--dump-dom")
    assert "<title>broken into" not in dom
    assert console == [], "not even an attempt that the policy had to stop"
    script = (
        "return [document.querySelectorAll('script').length,"
        "document.querySelectorAll('[onerror],[onload]').length,"
        "document.querySelector('h1').textContent]"
    )
    # without the policy too: escaping alone has to do
    assert answer(browser(with_probe(hostile, tmp_path, script), "--dump-dom")[0]) == [
        page_of(hostile).count("<script>") + 1,
        0,
        HOSTILE[0],
    ]


@pytest.mark.slow
def test_headers_sort_by_value_and_back(browser, results, tmp_path):
    script = (
        "const table = document.querySelector('table.runs');"
        "const names = () => Array.from(table.tBodies[0].rows, r => r.cells[0].textContent);"
        "const head = table.tHead.rows[0].cells[6];"
        "head.firstChild.click(); const up = [names(), head.getAttribute('aria-sort')];"
        "head.firstChild.click(); return [up, names(), head.getAttribute('aria-sort')]"
    )
    (up, word), down, back = answer(browser(with_probe(results, tmp_path, script), "--dump-dom")[0])
    assert (word, back) == ("ascending", "descending")
    assert up[:2] == ["sb-r_1", "sb-s_1"] and down[:2] == ["sb-s_1", "sb-r_1"]


@pytest.mark.slow
def test_a_link_opens_the_run_it_points_to(browser, results):
    address = (results / "report.html").as_uri() + "#run-2"
    dom, _ = browser(address, "--dump-dom")
    assert re.findall(r'<details class="run[^"]*" id="(run-\d)" open', dom) == ["run-2"]


@pytest.mark.slow
@pytest.mark.parametrize("width", [400, 1400])
def test_page_never_scrolls_sideways(browser, results, tmp_path, width):
    # a frame of that width, because a headless window has a least width of its own
    text = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", page_of(results))
    (tmp_path / "inner.html").write_text(
        text.replace("<details", "<details open"), encoding="utf-8"
    )
    outer = (
        f"<iframe id=f src=inner.html width={width} height=900></iframe><script>"
        "addEventListener('load', () => { const e = document.getElementById('f')"
        ".contentDocument.documentElement;"
        "document.title = 'answer:' + JSON.stringify([e.scrollWidth, e.clientWidth])})</script>"
    )
    (tmp_path / "outer.html").write_text(outer)
    dom, _ = browser(tmp_path / "outer.html", "--dump-dom", "--allow-file-access-from-files")
    wide, seen = answer(dom)
    assert seen <= width and wide <= seen


def test_page_asks_nothing_of_the_network(results, hostile):
    for folder in (results, hostile):
        reader = Reader(page_of(folder))
        for tag, attrs in reader.elements:
            for name in ("src", "srcset", "action", "data", "poster", "background"):
                assert attrs.get(name, "data:").startswith("data:"), (tag, attrs)
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


def test_figures_are_described_in_words_and_numbers(results):
    images = Reader(page_of(results)).all("img")
    assert len(images) == 7
    for image in images:
        assert re.search(r"µ from 0\.\d|µ from 1\.\d", image["alt"]), image["alt"]


def test_failed_runs_are_struck_out_with_their_reason(results):
    row = re.search(r'<tr class="failed">.*?</tr>', page_of(results), re.DOTALL)[0]
    assert "<s>broken</s>" in row and "column &#39;Fx&#39; has no unit" in row


def test_policy_allows_the_page_and_nothing_else(results):
    policy = next(
        attrs["content"]
        for attrs in Reader(page_of(results)).all("meta")
        if attrs.get("http-equiv") == "Content-Security-Policy"
    )
    assert "default-src 'none'" in policy and "unsafe" not in policy and "http" not in policy


def test_campaign_file_and_checksums_stand_on_the_page(results):
    text = "".join(Reader(page_of(results)).text)
    assert 'name = "Glycerol & PMMA"' in text
    assert "ab" * 32 in text and "could not be read" in text


def test_data_address_needs_no_escaping_in_an_attribute():
    address = data_address('<?xml version="1.0"?>\n<svg a="1&amp;2">\n<g id="#x%"/></svg>')
    assert not set('"&<>#\n') & set(address)
    assert address.startswith("data:image/svg+xml,%3Csvg a='1%26amp;2'%3E")
