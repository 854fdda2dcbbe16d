"""Weights on a lever: what a line says of both makes the load."""

from __future__ import annotations

import re

_LONGEST = 200  # characters of a line that are looked at
_NUMBER = r"\d+(?:[.,]\d+)?"
_LEVER = re.compile(
    r"lever|hebel|levier|palanca|leva(?!l|t)|alavanca|hevel|h[äa]v(?:arm|st[åa]ng)|v[æe]gtstang|vipuvar|d[źz]wigni|p[áa]k[ay]"
    r"|kald[ıi]ra|emel[őo]|рыча|杠杆|槓桿|レバー|てこ|지렛대",
    re.IGNORECASE,
)
_ONE_TO = re.compile(rf"(?<![\d:.,])(?P<one>{_NUMBER})\s?[:/]\s?(?P<other>{_NUMBER})(?![\d:/])")
_TIMES = re.compile(
    rf"(?:ratio|[üu]bersetzung|rapport|relaci[óo]n|rapporto|[x×])\W{{0,3}}(?P<times>{_NUMBER})(?![\d:.,/]|\s?[^\W\d_]{{1,2}}\b)",
    re.IGNORECASE,
)
_WEIGHT = re.compile(rf"(?<![\d.,]){_NUMBER}\s?(?:kg|g|lbs?|oz)(?![^\W\d_]|[/·*])", re.IGNORECASE)


def weight_on_lever(line: str) -> float:
    """Return how many times a weight presses that one line states together with its lever; or 0.

    Examples
    --------
    >>> weight_on_lever("Charge: masses 5 kg, rapport de levier 10:1")
    10.0
    >>> weight_on_lever("dead weight 2 kg on lever, ratio 1:5"), weight_on_lever("Lever 1:5")
    (5.0, 0.0)
    >>> weight_on_lever("Load 20 N (lever 1:5)")
    0.0
    """
    line = line[:_LONGEST]
    if not _LEVER.search(line) or len(_WEIGHT.findall(line)) != 1:
        return 0.0
    if told := _ONE_TO.search(line):
        one, other = (float(told[key].replace(",", ".")) for key in ("one", "other"))
        return max(one, other) / min(one, other) if min(one, other) > 0 else 0.0
    times = _TIMES.search(line)
    return float(times["times"].replace(",", ".")) if times else 0.0
