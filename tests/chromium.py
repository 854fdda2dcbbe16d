"""A headless Chromium that tests drive as a person would: open, click, type, look."""

import base64
import contextlib
import itertools
import json
import shutil
import subprocess
import time
from pathlib import Path

import websocket

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
BROWSER = next((found for name in NAMES if (found := shutil.which(name))), "")
KEYS = {"Tab": 9, "Enter": 13, " ": 32, "Escape": 27, "End": 35, "Home": 36}
KEYS |= {"ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}
OPTIONS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
    "--remote-allow-origins=*",
    # the tests' pages trust each other: one process draws them all, on one thread
    "--process-per-site",
    "--renderer-process-limit=1",
    "--disable-site-isolation-trials",
    "--in-process-gpu",
    "--disable-partial-raster",
    "--num-raster-threads=1",
]


@contextlib.contextmanager
def chromium(profile):
    """Start a browser of its own, and end it."""
    command = [BROWSER, *OPTIONS, f"--user-data-dir={profile}", "about:blank"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        browser = Browser(Path(profile))
        try:
            yield browser
        finally:
            browser.close()
    finally:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


class Browser:
    """One browser; `page` opens an address in a tab of its own.

    `context` is the name of what its pages remember together; not given, all of the process.
    """

    def __init__(self, profile, context=None):
        self._profile, self._context = profile, context
        self._port = _port(profile / "DevToolsActivePort")
        self._devtools = _Devtools(f"ws://127.0.0.1:{self._port[0]}{self._port[1]}")

    def close(self):
        """Let go of the browser."""
        self._devtools.close()

    @contextlib.contextmanager
    def apart(self):
        """A browser in the same process that knows nothing of what others opened and kept."""
        context = self._devtools.call("Target.createBrowserContext")["browserContextId"]
        browser = Browser(self._profile, context)
        try:
            yield browser
        finally:
            browser.close()
            self._devtools.call("Target.disposeBrowserContext", browserContextId=context)

    @contextlib.contextmanager
    def page(self, address, width=1400, height=900, dark=False, before="", touch=False):
        """Open an address, a script run before any of its own; afterwards the tab is closed."""
        where = {"browserContextId": self._context} if self._context else {}
        target = self._devtools.call("Target.createTarget", url="about:blank", **where)["targetId"]
        tab = _Devtools(f"ws://127.0.0.1:{self._port[0]}/devtools/page/{target}")
        try:
            page = Page(tab, width, height, dark, touch)
            page.before(before)
            page.go(address)
            yield page
        finally:
            tab.close()
            self._devtools.call("Target.closeTarget", targetId=target)


class Page:
    """A tab: what it logged and asked for, and how to act in it."""

    def __init__(self, tab, width, height, dark, touch):
        self._tab = tab
        for domain in ("Page", "Runtime", "Log", "Network"):
            tab.call(f"{domain}.enable")
        # a policy that stops something says so in the page too, whatever reaches the console
        self.before(
            "window.stopped = []; document.addEventListener('securitypolicyviolation',"
            "(event) => stopped.push(event.violatedDirective + ' ' + event.blockedURI))"
        )
        tab.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=touch,
        )
        if touch:
            tab.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        tab.call("Emulation.setEmulatedMedia", features=scheme)

    def go(self, address):
        """Open an address and wait until it has loaded."""
        url = address if "://" in str(address) else Path(address).as_uri()
        self._tab.call("Page.navigate", url=url)
        self.wait("document.readyState === 'complete' && location.href !== 'about:blank'")

    def before(self, script):
        """Run a script in every page that is opened from now on, before any of its own."""
        self._tab.call("Page.addScriptToEvaluateOnNewDocument", source=script)

    def run(self, script):
        """Return the value of an expression, awaited if it is a promise."""
        found = self._tab.call(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in found:
            raise AssertionError(found["exceptionDetails"]["exception"].get("description", script))
        return found["result"].get("value")

    def wait(self, condition, seconds=30):
        """Wait until an expression is true."""
        end = time.monotonic() + seconds
        while not self.run(condition):
            assert time.monotonic() < end, f"in {seconds} s it did not come true: {condition}"
            time.sleep(0.02)

    def click(self, selector, shift=False):
        """Bring an element into view, wait until it stands still, and click on its middle."""
        self.mouse([self.middle(selector)], shift)

    def middle(self, selector):
        """Bring an element into view, wait until it stands still, and return its middle [px]."""
        return self.run(
            f"(async () => {{ const e = document.querySelector({json.dumps(selector)});"
            "const middle = () => { e.scrollIntoView({block: 'center', behavior: 'instant'});"
            "const b = e.getClientRects()[0]; return [b.x + b.width / 2, b.y + b.height / 2] };"
            "let before, now = middle(), still = 0;"
            "while (still < 3) { before = now; await new Promise(requestAnimationFrame);"
            "now = middle(); still = now.join() === before.join() ? still + 1 : 0 }"
            "return now })()"
        )

    def mouse(self, points, shift=False):
        """Press at the first point, move over the others, release at the last."""
        button = {"button": "left", "clickCount": 1, "modifiers": 8 if shift else 0}
        for kind, (x, y), more in (
            ("mouseMoved", points[0], {}),
            ("mousePressed", points[0], button),
            *(("mouseMoved", point, {"button": "left", "buttons": 1}) for point in points[1:]),
            ("mouseReleased", points[-1], button),
        ):
            self._tab.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def double_click(self, point, condition, tries=10):
        """Click twice until an expression is true: a busy machine may be too slow for one pair."""
        for _ in range(tries):
            for _ in range(2):
                self.mouse([point])
            end = time.monotonic() + 2
            while time.monotonic() < end:
                if self.run(condition):
                    return
                time.sleep(0.02)
        raise AssertionError(f"after {tries} double clicks it did not come true: {condition}")

    def touch(self, *fingers):
        """Move fingers along their points, all at once, and lift them: one finger, or two."""
        steps = list(zip(*fingers, strict=True))
        for number, points in enumerate(steps):
            kind = "touchMove" if number else "touchStart"
            places = [{"x": x, "y": y, "id": finger} for finger, (x, y) in enumerate(points)]
            self._tab.call("Input.dispatchTouchEvent", type=kind, touchPoints=places)
        self._tab.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def tap(self, point):
        """Tap with a finger."""
        self._tab.call("Input.emulateTouchFromMouseEvent", **self._tapped("mousePressed", point))
        self._tab.call("Input.emulateTouchFromMouseEvent", **self._tapped("mouseReleased", point))

    @staticmethod
    def _tapped(kind, point):
        place = {"x": round(point[0]), "y": round(point[1])}
        return {"type": kind, "button": "left", "clickCount": 1} | place

    def key(self, name, text="", shift=False):
        """Press a key: a character, or the name of a key such as ArrowRight."""
        held = {"modifiers": 8 * shift}
        if name in KEYS:  # what the browser itself does with a key hangs on its number
            held["windowsVirtualKeyCode"] = KEYS[name]
        for kind in ("keyDown", "keyUp"):
            more = {"text": text} if text and kind == "keyDown" else {}
            self._tab.call("Input.dispatchKeyEvent", type=kind, key=name, **held, **more)

    def tab_to(self, selector):
        """Press Tab, or Shift and Tab where it lies behind, until an element has the focus."""
        where = f"document.querySelector({json.dumps(selector)})"
        back = f"{where}.compareDocumentPosition(document.activeElement) & 4"
        back = bool(self.run(f"document.activeElement !== document.body && {back}"))
        for _ in range(200):
            if self.run(f"document.activeElement === {where}"):
                return
            self.key("Tab", shift=back)
        raise AssertionError(f"the Tab key never came to {selector}")

    def press(self, selector, key="Enter", shift=False):
        """Go to an element by keyboard, and press a key on it."""
        self.tab_to(selector)
        self.key(key, {"Enter": "\r", " ": " "}.get(key, ""), shift)

    def type(self, text):
        """Type into what has the focus."""
        self._tab.call("Input.insertText", text=text)

    def screenshot(self, path, whole=False):
        """Save what is seen, or the whole page, as PNG."""
        answer = self._tab.call("Page.captureScreenshot", captureBeyondViewport=whole)
        Path(path).write_bytes(base64.b64decode(answer["data"]))

    def pdf(self, path):
        """Print to PDF."""
        answer = self._tab.call("Page.printToPDF", printBackground=True, preferCSSPageSize=True)
        Path(path).write_bytes(base64.b64decode(answer["data"]))

    @property
    def console(self):
        """What was said on the console: errors, warnings, what the policy stopped."""
        self.run("0")  # everything before this answer has been reported
        said = []
        for event in self._tab.events:
            if event["method"] == "Runtime.exceptionThrown":
                said.append(event["params"]["exceptionDetails"]["text"])
            elif event["method"] == "Runtime.consoleAPICalled":
                said.append(str(event["params"]["args"]))
            elif event["method"] == "Log.entryAdded":
                said.append(event["params"]["entry"]["text"])
        return said

    @property
    def stopped(self):
        """What the content security policy stopped: the directive and the address."""
        return self.run("stopped")

    @property
    def requests(self):
        """The addresses that were asked for, of files too; not what is in the page or stopped."""
        self.run("0")
        told = [(event["method"], event["params"]) for event in self._tab.events]
        stopped = {
            what["requestId"]
            for method, what in told
            if method == "Network.loadingFailed" and what.get("blockedReason") == "csp"
        }
        urls = [
            what["request"]["url"]
            for method, what in told
            if method == "Network.requestWillBeSent" and what["requestId"] not in stopped
        ]
        return [url for url in urls if not url.startswith(("data:", "blob:"))]


class _Devtools:
    """The browser's own protocol over one socket."""

    def __init__(self, address):
        self._socket = websocket.create_connection(address, timeout=60)
        self._number = itertools.count(1)
        self.events = []

    def call(self, method, **parameters):
        number = next(self._number)
        self._socket.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self._socket.recv())
            if message.get("id") == number:
                assert "error" not in message, f"{method}: {message['error']}"
                return message["result"]
            if "method" in message:
                self.events.append(message)

    def close(self):
        self._socket.close()


def _port(file, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if file.is_file() and len(lines := file.read_text().split()) == 2:
            return lines
        time.sleep(0.05)
    raise AssertionError(f"the browser did not start in {seconds} s")
