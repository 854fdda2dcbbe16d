"""Collect the corpus, or compare what reading makes of it now with what it made.

cd tests
PYTHONPATH=.. python -m corpus compare            # every seen case
PYTHONPATH=.. python -m corpus compare turning    # those of tests with "turning" in the name
PYTHONPATH=.. python -m corpus show CASE FOLDER   # write the files of a case, print its digest
PYTHONPATH=.. python -m corpus held-out           # counts of the held-out fifth, nothing else
PYTHONPATH=.. python -m corpus collect [FOLDER]   # read all anew (with what was recorded there)
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections import Counter
from pathlib import Path

from corpus.comparing import CLASSES, differences, judged
from corpus.digest import read_all, read_case
from corpus.recorded import made_cases, recorded_cases, shared_cases
from corpus.references import WRONG, judge_references
from corpus.store import SHARED, Part, contents_of, load, save, write_case

TOO_SLOW = 5.0  # s of computing: no case takes longer


def collect(folder: Path | None, jobs: int) -> None:
    """Read all cases, those recorded in a folder or those that are packed, and pack them."""
    if folder is not None:
        recorded, contents, left = recorded_cases(folder)
        made, described = made_cases()
        cases = [*recorded, *shared_cases(), *made]
        contents |= described
        for why, count in left.items():
            print(f"left out: {count:5} {why}")
    else:
        parts = [load(), load(held_out=True)]
        cases = [case for part in parts for case in part.cases.values()]
        contents = {name: c for part in parts for name, c in part.contents.items()}
    if not SHARED.is_dir():
        raise SystemExit(f"the reference material ({SHARED}) is wanted to collect")
    by_key = {case.key: case for case in sorted(cases, key=lambda case: case.key)}
    read = {}
    for key, found, seconds in read_all(by_key, contents, jobs):
        if seconds > TOO_SLOW:
            print(f"left out, {seconds:.0f} s: {by_key[key].files[0][0]} of {by_key[key].test}")
            continue
        read[key] = found
    for held_out in (False, True):
        chosen = {key: by_key[key] for key in read if by_key[key].is_held_out == held_out}
        wanted = {
            name: c for case in chosen.values() for name, c in contents_of(case, contents).items()
        }
        save(Part(chosen, {key: read[key] for key in chosen}, wanted), held_out)
        counts = Counter(read[key]["outcome"] for key in chosen)
        print("held out:" if held_out else "seen:", len(chosen), dict(counts))


def compare(held_out: bool, word: str, jobs: int) -> int:
    """Print how what is read now differs; return the number of cases that do, beyond wording."""
    part = load(held_out)
    there = SHARED.is_dir()
    cases = {
        key: case
        for key, case in part.cases.items()
        if (there or not case.is_shared) and word in f"{case.test} {case.files[0][1]} {key}"
    }
    known, counts, bad, took = judged(), Counter[str](), 0, 0.0
    for key, now, seconds in read_all(cases, part.contents, jobs):
        took += seconds
        found = differences(part.read[key], now)
        counts.update({one.kind for one in found} or {"same"})
        wrong = [one for one in found if (key, one.where) not in known]
        bad += any(one.kind != CLASSES[-1] for one in wrong)
        if wrong and not held_out:
            print(f"{key} {cases[key].files[0][0]} ({cases[key].test})")
            print("".join(f"    {one}\n" for one in wrong), end="")
    print(f"{len(cases)} cases:", ", ".join(f"{counts[k]} {k}" for k in ("same", *CLASSES)))
    print(f"{bad} differ by more than wording and are not judged; {took:.0f} s of computing")
    return bad


def show(key: str, folder: Path) -> None:
    """Write the files of a seen case, and print what was and what is read."""
    part = load()
    if key not in part.cases:
        raise SystemExit(f"{key}: there is no such case among those that are seen")
    case = part.cases[key]
    folder.mkdir(parents=True, exist_ok=True)
    for path in write_case(case, part.contents, folder):
        print(path)
    for name, read in (("was", part.read[key]), ("now", read_case(case, part.contents))):
        print(name, json.dumps(read, ensure_ascii=False, indent=1))


def main() -> int:
    """Run a command."""
    os.environ["TZ"] = "UTC"
    time.tzset()
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--jobs", type=int, default=1)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("collect").add_argument("folder", type=Path, nargs="?")
    commands.add_parser("compare").add_argument("word", nargs="?", default="")
    commands.add_parser("held-out")
    commands.add_parser("references")
    shown = commands.add_parser("show")
    shown.add_argument("case")
    shown.add_argument("folder", type=Path)
    told = parser.parse_args()
    if told.command == "collect":
        collect(told.folder, told.jobs)
    elif told.command == "references":
        judged_numbers = judge_references()
        print("\n".join(f"{verdict:8} {about}" for verdict, about in judged_numbers))
        return any(verdict == WRONG for verdict, _ in judged_numbers)
    elif told.command == "show":
        show(told.case, told.folder)
    else:
        return compare(told.command == "held-out", getattr(told, "word", ""), told.jobs) > 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
