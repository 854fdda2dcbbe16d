"""What messages may hold and say, and what a page may load."""

from __future__ import annotations

from hostile.base import FORCE, LONG, TRIBOLAB, UNREADABLE, USAGE, Command, campaign, case, run

PYTHON = r"\b(instrument|clock_shift|x_unit|height_unit)=|\bread_?\w*\(\)"

for _what, _text in {
    "a name of a column": FORCE.replace("Fx [N]", "F\x1b[31m" + "x" * 5000),
    "a unit": FORCE.replace("Fx [N]", "Fx [\x1b[2J\x07N]"),
    "a cell": FORCE.replace("\n5.0,", "\n5.0\x1b]0;title\x07,"),
    "the first line": "\x1b[31m" * 500 + FORCE,
}.items():
    for _command in ("info", "check", "dialect"):

        @case(f"words 11: {_command}, ESC in {_what}", *(_command, _text), codes=(0, 1, 2, 3))
        def _(folder, command: str, text: str) -> Command:
            (folder / "a.csv").write_text(text)
            return [*TRIBOLAB, command, "a.csv"]


for _command in ("info", "check"):

    @case(
        f"words 12 and 13: {_command} of an unknown file",
        _command,
        says=r"tribolab info odd\.txt --write",
        never=f"{PYTHON}|linear_slider",
    )
    def _(folder, command: str) -> Command:
        (folder / "odd.txt").write_text("Lunch is at noon.\n" * 30)
        return [*TRIBOLAB, command, "odd.txt"]


@case("words 12: of a campaign", codes=(UNREADABLE,), never=PYTHON, says="sb-r", **LONG)
def _(folder) -> Command:
    file = campaign(folder)
    for path in (folder / "c/raw").rglob("*.csv"):
        path.write_text("Lunch is at noon.\n")
    return run(file)


@case("words 12: two instruments fit", codes=(0, USAGE, UNREADABLE), never=PYTHON)
def _(folder) -> Command:
    (folder / "a.csv").write_text("1,2,3\n" * 100)
    return [*TRIBOLAB, "check", "a.csv"]


def _policy(folder) -> str:
    import html
    import re

    page = (folder / "c/results/report.html").read_text("utf-8")
    found = re.search(r'Content-Security-Policy" content="([^"]*)"', page)
    scripts = re.search(r"script-src ([^;]*)", html.unescape(found[1]) if found else "")
    if scripts is None:
        return "the page has no policy for scripts"
    # a blob is what the page itself has unpacked
    loose = [s for s in scripts[1].split() if not s.startswith("'sha256-") and s != "blob:"]
    return f"scripts may come from {loose}" if loose else ""


@case("page 16: scripts of the page alone", codes=(0, 1), after=_policy, **LONG)
def _(folder) -> Command:
    return run(campaign(folder))
