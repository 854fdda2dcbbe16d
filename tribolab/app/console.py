"""Console for tables on standard output, which escapes control characters."""

from __future__ import annotations

from rich.console import Console, ConsoleOptions, ConsoleRenderable, RenderHook, RenderResult
from rich.segment import Segment

from tribolab.core.errors import harmless

_PIPED_WIDTH = 120


def console() -> Console:
    """Return a console on stdout with escaped control characters; a pipe has a fixed width."""
    out = Console(highlight=False)
    if not out.is_terminal:
        out = Console(highlight=False, width=_PIPED_WIDTH)
    out.push_render_hook(_Harmless())
    return out


class _Harmless(RenderHook):
    """Render hook that escapes control characters in all printed text except console styles."""

    def process_renderables(self, renderables: list[ConsoleRenderable]) -> list[ConsoleRenderable]:
        return [_Cleaned(part) for part in renderables]


class _Cleaned:
    def __init__(self, inner: ConsoleRenderable) -> None:
        self.inner = inner

    def __rich_console__(self, out: Console, options: ConsoleOptions) -> RenderResult:
        for segment in out.render(self.inner, options):
            text = segment.text if segment.control else harmless(segment.text)
            yield Segment(text, segment.style, segment.control)
