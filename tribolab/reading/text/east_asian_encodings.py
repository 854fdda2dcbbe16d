"""Which East Asian encoding the bytes of a text are in, by whether they decode to plausible text.

A text in Western letters has single bytes above 0x7f between its ASCII letters (é, µ, °, ß), or two
at a time; as Chinese, Japanese or Korean it decodes, if at all, to single rare signs in the midst
of Latin letters. Text that is in one of these scripts decodes to runs of its common signs.
"""

from __future__ import annotations

import codecs
import re
from collections.abc import Callable
from typing import NamedTuple

_COMMON = 0.9  # share of the signs that are common ones
_FEWEST = 2  # different letters that stand side by side
_KOREAN = 4  # letters from which on their range tells Korean from Chinese
_CAPITALS = 0xC0  # bytes that single-byte encodings have for letters alone
_TRAILING = 0.1  # share of Big5's letters whose second byte is ASCII
# signs that instruments write beside Latin letters: of units, brackets, marks; not of a script
_SIGNS = frozenset(
    "μ℃°×±Ωφθλ·～－：，；．。、（）［］【】「」《》％＝＋／①②③④⑤㎜㎛㎚²³→・　“”‘’–—…≥≤△Δ"
)
_OF_UNITS = re.compile(r"(?<![^\W\d_])μ(?=m(?![^\W\d_]))|℃|㎛|㎜|㎚")
_RUN = re.compile(r"[\u3040-\u30ff\u3400-\u9fff\uac00-\ud7a3]{2,}")
_LETTER = re.compile(r"[\u3040-\u30ff\u3400-\u9fff\uac00-\ud7a3\u1100-\u11ff\uff66-\uff9f]")
_ALONE = re.compile(r"(?<=[A-Za-z])[\u3400-\u9fff\uac00-\ud7a3](?=[a-z])")


class _Script(NamedTuple):
    """An encoding, and whether two of its bytes are a common letter."""

    encoding: str
    is_common: Callable[[bytes], bool]


def _gb2312(code: bytes) -> bool:
    """Whether a letter is in the first level of GB 2312, or is kana, which it holds, too."""
    return len(code) == 2 and (0xB0 <= code[0] <= 0xD7) and code[1] >= 0xA1


def _jis(code: bytes) -> bool:
    """Whether a letter is kana, or in the first level of JIS X 0208."""
    kana = len(code) == 2 and code[0] in (0x82, 0x83)
    kana = kana or code in (b"\x81\x5b", b"\x81\x58")  # long vowels, repeated signs
    return kana or (len(code) == 2 and 0x88 <= code[0] <= 0x98)


def _hangul(code: bytes) -> bool:
    """Whether a letter is one of the common syllables of KS X 1001."""
    return len(code) == 2 and 0xB0 <= code[0] <= 0xC8 and code[1] >= 0xA1


def _big5(code: bytes) -> bool:
    """Whether a letter is in the first level of Big5."""
    return len(code) == 2 and 0xA4 <= code[0] <= 0xC6


# in this order where several would do; Japanese lies apart from the others
_SCRIPTS = (
    _Script("gb18030", _gb2312),
    _Script("cp932", _jis),
    _Script("cp949", _hangul),
    _Script("big5", _big5),
)


class _Reading(NamedTuple):
    """What a text is in one encoding: its common letters as codes, or none, and the signs."""

    codes: tuple[bytes, ...]
    signs: bool


def eastern_encoding(head: bytes, *, whole: bool) -> str:
    """Return the East Asian encoding of a text that is not UTF-8; "" for any other.

    Parameters
    ----------
    head
        The beginning of a file.
    whole
        Whether this is all of it; else it may end inside a letter.

    Examples
    --------
    >>> eastern_encoding("X(mm)  Z(μm)  高度".encode("gb18030"), whole=True)
    'gb18030'
    >>> eastern_encoding("測定データ Z(μm)".encode("cp932"), whole=True)
    'cp932'
    >>> eastern_encoding("Größe [µm], été, 20 °C".encode("latin-1"), whole=True)
    ''
    """
    read = {
        script.encoding: reading
        for script in _SCRIPTS
        if (reading := _read(head, script, whole=whole)) is not None
    }
    by_letters = [name for name, reading in read.items() if reading.codes]
    if len(by_letters) > 1:
        by_letters = _told_apart(by_letters, read)
    if by_letters:
        return by_letters[0]
    by_signs = [name for name, reading in read.items() if reading.signs]
    return by_signs[0] if len(by_signs) == 1 else ""


def _read(head: bytes, script: _Script, *, whole: bool) -> _Reading | None:
    """Return what a text is in an encoding; None where it is none."""
    try:
        text = codecs.getincrementaldecoder(script.encoding)().decode(head, final=whole)
    except UnicodeDecodeError:
        return None
    signs = [sign for sign in text if not sign.isascii()]
    letters = [sign for sign in signs if _LETTER.match(sign)]
    others = [sign for sign in signs if not _LETTER.match(sign)]
    if not signs or sum(sign in _SIGNS for sign in others) < _COMMON * len(others):
        return None
    if not letters:
        return _Reading((), bool(_OF_UNITS.search(text)))
    codes = [letter.encode(script.encoding) for letter in letters]
    if sum(map(script.is_common, codes)) < _COMMON * len(codes):
        return None
    if min(min(sign.encode(script.encoding)) for sign in signs) >= _CAPITALS:
        return None  # one word of them, in Cyrillic, Greek or accented Latin letters
    beside = max((len(set(run)) for run in _RUN.findall(text)), default=0)
    if beside < _FEWEST or len(_ALONE.findall(text)) > len(letters) // 8:
        return None
    return _Reading(tuple(codes), signs=False)


def _told_apart(names: list[str], read: dict[str, _Reading]) -> list[str]:
    """Return which of several encodings is meant: each holds letters that others do not use."""
    if "big5" in names:
        codes = read["big5"].codes
        if sum(code[1] < 0x80 for code in codes) >= max(1, _TRAILING * len(codes)):
            return ["big5"]
        names = [name for name in names if name != "big5"]
    if {"gb18030", "cp949"} <= set(names):
        # half of the common Chinese letters lie behind the last Korean syllable
        korean = len(read["cp949"].codes) >= _KOREAN
        names = [name for name in names if name != ("gb18030" if korean else "cp949")]
    return names
