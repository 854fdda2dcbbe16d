"""What comes out when a page is printed as soon as it has loaded."""

import re
import zlib
from pathlib import Path
from typing import NamedTuple

_GLYPHS = re.compile(rb"/(F\d+) [\d.]+ Tf|<([0-9A-Fa-f]+)>|(?<=[\s\]>])(T[jJ]|Tm|Td)(?=\s)")
_PAINTED = re.compile(rb"\s(?:f\*?|S)\n")


class Sheet(NamedTuple):
    """A printed page: its letters without any space, and how many shapes are drawn on it."""

    text: str
    shapes: int

    def has(self, words):
        """Whether words stand on it."""
        return "".join(words.split()) in self.text


def printed(browser, address, folder):
    """Print a page as anybody may, at once and without waiting, and read the sheets."""
    file = Path(folder) / "printed.pdf"
    with browser.page(address) as page:
        page.pdf(file)
    return sheets_of(file.read_bytes())


def sheets_of(raw):
    """Return the sheets of a PDF that Chromium wrote."""
    objects = {int(n): body for n, body in re.findall(rb"\n(\d+) 0 obj\n(.*?)\nendobj", raw, re.S)}
    fonts = {}
    for body in objects.values():
        if (found := re.search(rb"/ToUnicode (\d+) 0 R", body)) is not None:
            fonts[id(body)] = _letters(_stream(objects[int(found[1])]))
    named = {number: fonts[id(body)] for number, body in objects.items() if id(body) in fonts}
    pages = [body for body in objects.values() if re.search(rb"/Type /Page\b", body)]
    return [_sheet(page, objects, named) for page in pages]


def _stream(body):
    return zlib.decompress(body[body.index(b"stream\n") + 7 :])


def _letters(table):
    """The letters of a font by their numbers."""
    letters = {}
    for part in re.findall(rb"beginbfchar\n(.*?)endbfchar", table, re.S):
        for code, letter in re.findall(rb"<(\w+)> <(\w+)>", part):
            letters[int(code, 16)] = bytes.fromhex(letter.decode()).decode("utf-16-be")
    for part in re.findall(rb"beginbfrange\n(.*?)endbfrange", table, re.S):
        for low, high, first in re.findall(rb"<(\w+)> <(\w+)> <(\w+)>", part):
            for code in range(int(low, 16), int(high, 16) + 1):
                letters[code] = chr(int(first, 16) + code - int(low, 16))
    return letters


def _sheet(page, objects, fonts):
    drawing = _stream(objects[int(re.search(rb"/Contents (\d+)", page)[1])])
    names = {name: int(number) for name, number in re.findall(rb"/(F\d+) (\d+) 0 R", page)}
    text, font = [], {}
    for name, glyphs, _ in _GLYPHS.findall(drawing):
        if name:
            font = fonts.get(names[name], {})
        elif glyphs:
            codes = (int(glyphs[k : k + 4], 16) for k in range(0, len(glyphs), 4))
            text += [font.get(code, "") for code in codes]
    letters = "".join("".join(text).split())
    for joined, parts in {"\ufb00": "ff", "\ufb01": "fi", "\ufb02": "fl", "\ufb03": "ffi"}.items():
        letters = letters.replace(joined, parts)  # a font may have one sign for them
    return Sheet(letters, len(_PAINTED.findall(drawing)))
