"""The words of files, as data: which concept a name stands for, whatever the language.

The lists are the TOML files beside this module; here they are loaded, and looked up.
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
LONGEST_NAME = 1000  # characters of a name that are looked at
_SPELT = {
    **{"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "ø": "oe", "ł": "l", "ı": "i"},
    **{"\u00b5": "mu", "\u03bc": "mu", "\u03c4": "tau", "\u03c9": "omega", "\u03b7": "eta"},
    **{"\u03b8": "theta", "\u03d1": "theta", "\u03c3": "sigma"},
}
_LETTERS = str.maketrans(_SPELT)
_ACCENTS = re.compile("[\u0300-\u036f]")  # not the marks that make one kana of another
_TOKENS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[^\W\d_A-Z]+")
CLAUSE_END = r"[;:,=|()\[\]：；，（）、。]|\.\s+(?=[^\W\d_a-zа-яё])"  # a capital begins a sentence
_CLAUSE = re.compile(CLAUSE_END)
_SIGNS = re.compile(r"[^\w;]+|_")
UNPARTED = "\u3040-\u30ff\u4e00-\u9fff\uac00-\ud7a3"  # letters of which two make a word
_FIRST_UNPARTED = "\u2e80"  # of the letters of languages that put no blanks between words
_NO_LANGUAGE = ("of", "symbols", "stems", "vague")


class Word(NamedTuple):
    """A concept and its names, all but `terms` normalised by `normalise_label`.

    Symbols are whole names; of two for one concept the first is the better. Stems may stand
    anywhere in a name. A vague stem is shared with other concepts: it is always a guess.
    """

    quantity: str
    of: Literal["run", "scan", "setting", "modulus"]
    symbols: tuple[str, ...]
    stems: tuple[str, ...]
    vague: tuple[str, ...]
    terms: Mapping[str, tuple[str, ...]]  # by language, as they are written


@functools.lru_cache(maxsize=8192)
def normalise_label(name: str) -> str:
    """Return a name without blanks, signs, capitals, umlauts and accents, of its beginning.

    >>> normalise_label("# Höhe_1"), normalise_label("Déplacement (x)")
    ('hoehe1', 'deplacementx')
    """
    text = unicodedata.normalize("NFKC", name[:LONGEST_NAME]).lower().translate(_LETTERS)
    text = _ACCENTS.sub("", unicodedata.normalize("NFD", text))
    return "".join(filter(str.isalnum, unicodedata.normalize("NFC", text)))


@functools.cache
def known_words(of: str = "") -> tuple[Word, ...]:
    """Return the concepts of runs, of scans, or of both and of settings, in the lexicon's order."""
    known = [_word(name, block) for name, block in _toml("words").items() if name != "reviewed"]
    return tuple(word for word in known if not of or word.of == of)


@functools.cache
def names(concept: str) -> frozenset[str]:
    """Return the whole names that languages have for a concept, normalised."""
    found = (word.terms.values() for word in known_words() if word.quantity == concept)
    return frozenset(normalise_label(t) for terms in found for line in terms for t in line)


@functools.cache
def eastern_words() -> frozenset[str]:
    """Return the stems in letters beyond Latin: by which a file's encoding is told.

    A single sign is none: it may stand in any wrong reading of other letters.
    """
    stems = (stem for word in known_words() for stem in (*word.stems, *word.vague))
    return frozenset(stem for stem in stems if len(stem) > 1 and not stem.isascii())


@functools.cache
def key_pattern(concept: str) -> re.Pattern[str]:
    """Return a pattern for normalised names that mean a concept of settings.toml.

    Parameters
    ----------
    concept
        Its forms and the terms of words.toml for it fit.

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
    """Return a pattern for one part of settings.toml, wherever it stands in a normalised name."""
    return re.compile(_part(name))


def plain_text(text: str) -> str:
    """Return the words of a text as `normalise_label` does, with one blank between and around them.

    A semicolon stands where a clause ends.

    >>> plain_text("Nullpunkt-korrigiert; Prüfkraft: 20 N")
    ' nullpunkt korrigiert ; pruefkraft ; 20 n '
    """
    words = _SIGNS.split(_CLAUSE.sub(" ; ", text[:LONGEST_NAME]))
    return f" {' '.join(filter(None, (w if w == ';' else normalise_label(w) for w in words)))} "


@functools.cache
def text_pattern(name: str) -> re.Pattern[str]:
    """Return a pattern for what `plain_text` gives, of the words and forms in sentences.toml.

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
    """Whether a text holds one of the words or forms that sentences.toml has under a name.

    >>> [mentions("zero_word", text) for text in ("zero force", "zeroed force")]
    [True, False]
    """
    return text_pattern(name).search(plain_text(text)) is not None


def _text_part(part: str) -> str:
    name, maybe = (part[:-1], "?") if part.endswith("?") else (part, "")
    return f"(?:{'|'.join(_stems(_toml('sentences')['part'][name]))}){maybe}"


def _stems(block: Mapping[str, Any]) -> list[str]:
    """Return patterns of words: of languages that part them each begins one, and may go on."""
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
    """Return the words under a name in sentences.toml, normalised."""
    return frozenset(normalise_label(w) for line in _toml("sentences")[name].values() for w in line)


@functools.cache
def alternatives(name: str) -> str:
    """Return a group of the words under a name in sentences.toml, for text as it is written.

    A word that ends in ``~`` may go on by nine letters.
    """
    words = dict.fromkeys(word for line in _toml("sentences")[name].values() for word in line)
    parts = (
        re.escape(word.rstrip("~")) + (r"\w{0,9}" if word.endswith("~") else "")
        for word in sorted(words, key=len, reverse=True)
    )
    return f"(?:{'|'.join(parts)})"


@functools.cache
def pairs_of_bodies() -> tuple[tuple[re.Pattern[str], re.Pattern[str]], ...]:
    """Return patterns for normalised names of one and of the other of two bodies that touch."""
    return tuple(
        (re.compile("|".join(pair["one"])), re.compile("|".join(pair["other"])))
        for pair in _toml("roles")["bodies"]
    )


@functools.cache
def keys_of(kind: Literal["unit", "name", "value", "count"]) -> tuple[str, ...]:
    """Return what files call a unit, a name, a value, or the counts of a converter."""
    return tuple(_toml("roles")["key"][kind])


def words_of(name: str) -> list[str]:
    """Return the words of a name in small letters; a capital begins one.

    >>> words_of("PixelSizeX"), words_of("Step size (X)"), words_of("dx")
    (['pixel', 'size', 'x'], ['step', 'size', 'x'], ['dx'])
    """
    return [word.lower() for word in _TOKENS.findall(name[:LONGEST_NAME])]


def role_of(name: str) -> Role:
    """Tell by a column's name how its numbers came about.

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
    """Return a name without the words that say that its numbers were set or measured.

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
    """Return the regular expression of a form, such as `part? * other+`."""
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
