"""The files of the corpus and what was read of them, packed."""

from __future__ import annotations

import hashlib
import io
import json
import lzma
import tarfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from layouts import write_kind

HERE = Path(__file__).parent
SHARED = HERE.parents[2] / "shared" / "data"
RIG = "rig:"
SEED = 100  # of the noise in files that the rig writes
Read = dict[str, Any]  # what reading makes of a case, as JSON


class Case(NamedTuple):
    """What is read at once: a file or the files of a run, and what lies beside them.

    Files are pairs of a name and a checksum of the content. Two kinds are not packed: one of the
    reference material beside the project has its path within that for a checksum, and one that the
    rig writes is "rig:" and the kind of file. `instrument` is a name, or the checksum of a
    description; `said` what else reading is told; `ways` by which of its functions the file was
    read: run, scan, draft, modulus, results.
    """

    files: tuple[tuple[str, str], ...]
    beside: tuple[tuple[str, str], ...] = ()
    instrument: str | None = None
    said: tuple[tuple[str, Any], ...] = ()
    ways: tuple[str, ...] = ()
    test: str = ""

    @property
    def key(self) -> str:
        """What the case is called: the same wherever it is recorded."""
        return checksum(json.dumps([self.files, self.instrument, self.said]).encode())[:12]

    @property
    def is_shared(self) -> bool:
        """Whether it is a file of the reference material."""
        return "/" in self.files[0][1]

    @property
    def is_made(self) -> bool:
        """Whether it is a file that the rig writes anew."""
        return self.files[0][1].startswith(RIG)

    @property
    def is_held_out(self) -> bool:
        """Whether it is of the fifth that nobody who writes rules looks at."""
        if self.is_shared or self.is_made:
            return False  # everybody knows them
        return int(self.files[0][1][:8], 16) % 5 == 0

    def plain(self) -> dict[str, Any]:
        """Return it as JSON has it, without what is empty."""
        return {name: value for name, value in self._asdict().items() if value}


def case_of(plain: Mapping[str, Any]) -> Case:
    """Return a case from JSON."""

    def frozen(value: Any) -> Any:
        return tuple(map(frozen, value)) if isinstance(value, list) else value

    return Case(**{name: frozen(value) for name, value in plain.items()})


class Part(NamedTuple):
    """The seen or the held-out cases, what was read of each, and the contents of their files."""

    cases: dict[str, Case]
    read: dict[str, Read]
    contents: dict[str, bytes]


def checksum(content: bytes) -> str:
    """Return the name of a content: its BLAKE2 checksum."""
    return hashlib.blake2b(content, digest_size=16).hexdigest()


def _archive(held_out: bool) -> Path:
    return HERE / ("held_out.tar.xz" if held_out else "seen.tar.xz")


def _digests(held_out: bool) -> Path:
    return HERE / ("held_out.jsonl.xz" if held_out else "seen.jsonl")


def save(part: Part, held_out: bool) -> None:
    """Pack a part: the same bytes for the same cases."""
    pairs = [pair for case in part.cases.values() for pair in (*case.files, *case.beside)]
    kinds = {content: Path(name).suffix for name, content in sorted(pairs)}
    order = sorted(part.contents, key=lambda name: (kinds.get(name, ""), name))
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for name in order:
            entry = tarfile.TarInfo(name)
            entry.size = len(part.contents[name])
            archive.addfile(entry, io.BytesIO(part.contents[name]))
    _archive(held_out).write_bytes(lzma.compress(packed.getvalue(), preset=9 | lzma.PRESET_EXTREME))
    lines = "".join(_lines(part)).encode()
    _digests(held_out).write_bytes(lzma.compress(lines, preset=9) if held_out else lines)


def _lines(part: Part) -> Iterable[str]:
    for key in sorted(part.cases):
        line = {"case": key, **part.cases[key].plain(), "read": part.read[key]}
        yield json.dumps(line, ensure_ascii=False, separators=(",", ":")) + "\n"


def load(held_out: bool = False, *, files: bool = True) -> Part:
    """Return the seen or the held-out cases; those of the reference material only if it is there.

    Parameters
    ----------
    held_out
        Which of the two.
    files
        False: without the files' contents.
    """
    text = _digests(held_out).read_bytes()
    cases, read = {}, {}
    for line in (lzma.decompress(text) if held_out else text).decode().splitlines():
        plain = json.loads(line)
        key = plain.pop("case")
        read[key] = plain.pop("read")
        cases[key] = case_of(plain)
    contents = {}
    if files:
        with tarfile.open(_archive(held_out), "r:xz") as archive:
            for entry in archive:
                inside = archive.extractfile(entry)
                assert inside is not None
                contents[entry.name] = inside.read()
    return Part(cases, read, contents)


def contents_of(case: Case, contents: Mapping[str, bytes]) -> dict[str, bytes]:
    """Return the contents that a case needs."""
    wanted = {name for _, name in (*case.files, *case.beside)} | {case.instrument}
    return {name: contents[name] for name in wanted if name is not None and name in contents}


def write_case(case: Case, contents: Mapping[str, bytes], folder: Path) -> list[Path]:
    """Write a case's files into a folder; return those that are read, in their order."""
    if case.is_shared:
        return [SHARED / place for _, place in case.files]
    if case.is_made:
        written = write_kind(case.files[0][1].removeprefix(RIG), folder, SEED)
        paths = [written.path]
    else:
        paths = [folder / name for name, _ in case.files]
        for name, content in (*case.beside, *case.files):
            (folder / name).write_bytes(contents[content])
    if case.instrument in contents:
        (folder / "instrument.toml").write_bytes(contents[case.instrument])
    return paths
