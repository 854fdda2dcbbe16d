"""Lookup of the concept that a name in a file means, in any language.

The word lists are the TOML files next to this module.
"""

from __future__ import annotations

import functools
import re
import tomllib
import unicodedata
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, NamedTuple

Role = Literal["", "set", "measured", "derived", "extreme"]
LONGEST_NAME = 1000  # characters of a name that are inspected
_SPELT = {
    **{"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "ø": "oe", "ł": "l", "ı": "i"},
    **{"\u00b5": "mu", "\u03bc": "mu", "\u03c4": "tau", "\u03c9": "omega", "\u03b7": "eta"},
    **{"\u03b8": "theta", "\u03d1": "theta", "\u03c3": "sigma"},
}
_LETTERS = str.maketrans(_SPELT)
_ACCENTS = re.compile("[\u0300-\u036f]")  # not Japanese voicing marks: they change the letter
_TOKENS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[^\W\d_A-Z]+")
CLAUSE_END = r"[;:,=|()\[\]：；，（）、。]|\.\s+(?=[^\W\d_a-zа-яё])"  # a capital begins a sentence
_CLAUSE = re.compile(CLAUSE_END)
_SIGNS = re.compile(r"[^\w;]+|_")
UNPARTED = "\u3040-\u30ff\u4e00-\u9fff\uac00-\ud7a3"  # Japanese, Chinese and Korean letters
_FIRST_UNPARTED = "\u2e80"  # first letter of the scripts that put no blanks between words
_NO_LANGUAGE = ("of", "symbols", "stems", "vague")


class Word(NamedTuple):
    """A concept, such as a quantity, and its names; all but `terms` are normalised.

    Symbols are whole names, the best first. Stems may occur anywhere in a name. Vague stems are
    shared with other concepts, so that their meaning is always a guess.
    """

    quantity: str
    of: Literal["run", "scan", "setting", "modulus"]
    symbols: tuple[str, ...]
    stems: tuple[str, ...]
    vague: tuple[str, ...]
    terms: Mapping[str, tuple[str, ...]]  # by language, as written, not normalised


@functools.lru_cache(maxsize=8192)
def normalise_label(name: str) -> str:
    """Return a name in lower case without blanks, signs, accents and umlauts, cut if very long.

    >>> normalise_label("# Höhe_1"), normalise_label("Déplacement (x)")
    ('hoehe1', 'deplacementx')
    """
    text = unicodedata.normalize("NFKC", name[:LONGEST_NAME]).lower().translate(_LETTERS)
    text = _ACCENTS.sub("", unicodedata.normalize("NFD", text))
    return "".join(filter(str.isalnum, unicodedata.normalize("NFC", text)))


@functools.cache
def known_words(of: str = "") -> tuple[Word, ...]:
    """Return all concepts of the lexicon, or those of one kind such as "run" or "scan"."""
    known = [_word(name, block) for name, block in _toml("words").items() if name != "reviewed"]
    return tuple(word for word in known if not of or word.of == of)


@functools.cache
def names(concept: str) -> frozenset[str]:
    """Return the normalised terms for a concept in all languages."""
    found = (word.terms.values() for word in known_words() if word.quantity == concept)
    return frozenset(normalise_label(t) for terms in found for line in terms for t in line)


@functools.cache
def eastern_words() -> frozenset[str]:
    """Return the stems in non-Latin letters, from which the encoding of a file is recognised.

    Stems of one letter are left out: any text decoded with the wrong encoding may contain them.
    """
    stems = (stem for word in known_words() for stem in (*word.stems, *word.vague))
    return frozenset(stem for stem in stems if len(stem) > 1 and not stem.isascii())


@functools.cache
def key_pattern(concept: str) -> re.Pattern[str]:
    """Return a pattern that matches normalised names of a concept of settings.toml.

    Parameters
    ----------
    concept
        Name of the concept. The pattern matches its forms, and its terms in words.toml.

    Examples
    --------
    >>> bool(key_pattern("stroke").search(normalise_label("Slaglängd")))
    True
    """
    block = _toml("settings")[concept]
    forms = [_form(form) for form in block["forms"]]
    terms = block.get("terms", concept)
    for other in [terms] if isinstance(terms, str) else terms:
        forms += sorted(map(re.escape, names(other)))
    barred = "|".join(_form(form) for form in block.get("not", ()))
    return re.compile(rf"^{f'(?!(?:{barred})$)' if barred else ''}(?:{'|'.join(forms)})$")


@functools.cache
def part_pattern(name: str) -> re.Pattern[str]:
    """Return a pattern that finds the words of one part of settings.toml in a normalised name."""
    return re.compile(_part(name))


def plain_text(text: str) -> str:
    """Return the normalised words of a text, with a blank before and after each word.

    A semicolon marks the end of a clause.

    >>> plain_text("Nullpunkt-korrigiert; Prüfkraft: 20 N")
    ' nullpunkt korrigiert ; pruefkraft ; 20 n '
    """
    words = _SIGNS.split(_CLAUSE.sub(" ; ", text[:LONGEST_NAME]))
    return f" {' '.join(filter(None, (w if w == ';' else normalise_label(w) for w in words)))} "


@functools.cache
def text_pattern(name: str) -> re.Pattern[str]:
    """Return a pattern that finds an entry of sentences.toml in the result of `plain_text`.

    Examples
    --------
    >>> bool(text_pattern("slides_on_rim").search(plain_text("Block-on-Ring test")))
    True
    """
    block = _toml("sentences")[name]
    forms = [
        r"\w{0,3} ?".join(_text_part(part) for part in form.split())
        for form in block.get("forms", ())
    ]
    return re.compile("|".join([*forms, *_stems(block)]))


@functools.lru_cache(maxsize=4096)
def mentions(name: str, text: str) -> bool:
    """Whether a text contains any word or form of an entry of sentences.toml.

    >>> [mentions("zero_word", text) for text in ("zero force", "zeroed force")]
    [True, False]
    """
    return text_pattern(name).search(plain_text(text)) is not None


def _text_part(part: str) -> str:
    name, maybe = (part[:-1], "?") if part.endswith("?") else (part, "")
    return f"(?:{'|'.join(_stems(_toml('sentences')['part'][name]))}){maybe}"


def _stems(block: Mapping[str, Any]) -> list[str]:
    """Return patterns for the words of an entry; each matches at the start of a word.

    A word with "*" matches anywhere, one with a final blank only whole words. In scripts without
    blanks between words, all match anywhere.
    """
    words = [word for key, line in block.items() if key != "forms" for word in line]
    return [
        (r"\b" if "*" not in word and plain[0] < _FIRST_UNPARTED else "")
        + re.escape(plain)
        + (r"\b" if word.endswith(" ") else "")
        for word in sorted(dict.fromkeys(words), key=len, reverse=True)
        if (plain := plain_text(word.strip()).strip())
    ]


@functools.cache
def plain_words(name: str) -> frozenset[str]:
    """Return the normalised words of an entry of sentences.toml."""
    return frozenset(normalise_label(w) for line in _toml("sentences")[name].values() for w in line)


@functools.cache
def alternatives(name: str) -> str:
    """Return a regular expression that finds any word of an entry of sentences.toml in raw text.

    A word that ends in ``~`` may have up to nine more letters.
    """
    words = dict.fromkeys(word for line in _toml("sentences")[name].values() for word in line)
    parts = (
        re.escape(word.rstrip("~")) + (r"\w{0,9}" if word.endswith("~") else "")
        for word in sorted(words, key=len, reverse=True)
    )
    return f"(?:{'|'.join(parts)})"


@functools.cache
def pairs_of_bodies() -> tuple[tuple[re.Pattern[str], re.Pattern[str]], ...]:
    """Return pairs of patterns for the normalised names of two bodies in contact: disc and ball."""
    return tuple(
        (re.compile("|".join(pair["one"])), re.compile("|".join(pair["other"])))
        for pair in _toml("roles")["bodies"]
    )


@functools.cache
def keys_of(kind: Literal["unit", "name", "value", "count"]) -> tuple[str, ...]:
    """Return the words that files use for "unit", "name", "value", or for raw counts."""
    return tuple(_toml("roles")["key"][kind])


def words_of(name: str) -> list[str]:
    """Split a name into words in lower case; a capital letter begins a new word.

    >>> words_of("PixelSizeX"), words_of("Step size (X)"), words_of("dx")
    (['pixel', 'size', 'x'], ['step', 'size', 'x'], ['dx'])
    """
    return [word.lower() for word in _TOKENS.findall(name[:LONGEST_NAME])]


def role_of(name: str) -> Role:
    """Return whether a column name means set, measured, derived or extreme values; else "".

    >>> role_of("Velocity setpoint"), role_of("ActualSpeed"), role_of("Mean COF"), role_of("Offset")
    ('set', 'measured', 'derived', '')
    >>> role_of("Peak force"), role_of("Sollkraft"), role_of("Istwert")
    ('extreme', 'set', 'measured')
    """
    tokens = [token.lower() for token in _TOKENS.findall(name)]
    for role, pattern in _roles().items():
        if any(pattern.search(token) for token in tokens):
            return role
    return ""


def without_role(name: str) -> str:
    """Return a column name without words for "set" or "measured".

    >>> without_role("Actual velocity"), without_role("Set Speed"), without_role("Offset")
    ('velocity', 'Speed', 'Offset')
    """
    roles = [_toml("roles")["role"][role] for role in ("set", "measured")]
    whole = {word for role in roles for word in role["words"]}
    inside = "|".join(part for role in roles for part in role["anywhere"])
    kept = [re.sub(inside, "", t) for t in _TOKENS.findall(name) if t.lower() not in whole]
    return " ".join(token for token in kept if token) or name


@functools.cache
def _roles() -> dict[Role, re.Pattern[str]]:
    result: dict[Role, re.Pattern[str]] = {}
    for role, block in _toml("roles")["role"].items():
        begins = (f"^{word}" for word in block.get("begins", ()))
        options = (*(f"^{word}$" for word in block["words"]), *begins, *block.get("anywhere", ()))
        result[role] = re.compile("|".join(options))
    return result


def _word(name: str, block: Mapping[str, Any]) -> Word:
    terms = {language: tuple(t) for language, t in block.items() if language not in _NO_LANGUAGE}
    symbols, stems, vague = (tuple(block.get(kind, ())) for kind in ("symbols", "stems", "vague"))
    return Word(name, block["of"], symbols, stems, vague, terms)


def _form(form: str) -> str:
    """Return the regular expression of a form of settings.toml, such as `part? * other+`."""
    items = form.split()
    result = []
    for place, item in enumerate(items):
        if item.startswith("*"):
            most = f"{{0,{item[1:]}}}" if item[1:] else "*"
            result.append(("." if place in (0, len(items) - 1) else r"\w") + most)
            continue
        name, times = (item[:-1], item[-1]) if item[-1] in "?+" else (item, "")
        result.append(_part(name) + times)
    return "".join(result)


def _part(name: str) -> str:
    lines = _toml("settings")["part"][name].values()
    known = sorted((word for line in lines for word in line), key=len, reverse=True)
    return f"(?:{'|'.join(map(re.escape, dict.fromkeys(known)))})"


@functools.cache
def _toml(name: str) -> dict[str, Any]:
    return tomllib.loads(Path(__file__).with_name(f"{name}.toml").read_text(encoding="utf-8"))
