"""Safety checks of HDF5 and netCDF-4 files: no external data, no foreign filters.

HDF5 can store a dataset in any other file of the computer, or show parts of it as its own. An
untrusted file could thus expose confidential data in published results.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, BinaryIO

from tribolab.core.errors import shown
from tribolab.reading.raw import limits
from tribolab.reading.raw.opening import RefusedError, isolated, missing

_HDF5 = b"\x89HDF\r\n\x1a\n"
_USER_BLOCK = 512  # bytes; the shortest user block
_CLASSIC = b"CDF"
_BYTES = {3: 2, 4: 4, 5: 4, 6: 8, 8: 2, 9: 4, 10: 8, 11: 8}  # bytes of a number by type; else 1
# registered numbers of the library's filters (deflate, shuffle, fletcher32, szip, nbit,
# scaleoffset) and of LZF, part of h5py: https://github.com/HDFGroup/hdf5_plugins
_OWN_FILTERS = frozenset((1, 2, 3, 4, 5, 6, 32000))


@isolated()
def check_self_contained(path: Path) -> None:
    """Raise if a file refers to external data; every child process checks this before reading.

    Raises
    ------
    ReadError
        As for `refuse_outside`, or if it is damaged.
    """


def refuse_outside(path: Path) -> None:
    """Raise if an HDF5 file refers to external data, or has too many objects.

    Parameters
    ----------
    path
        Any file; netCDF-4 and MAT 7.3 are also HDF5.

    Raises
    ------
    RefusedError
        If the file has a link to another file, a dataset in external storage, a virtual dataset, or
        a filter that is not part of the HDF5 library. The message names the object.
    """
    with path.open("rb") as file:
        head = file.read(len(_HDF5))
        if head[:3] == _CLASSIC and _variables_of_classic(file, head[3]) > limits.COLUMNS.value:
            raise RefusedError(
                f"{path}: more than {limits.COLUMNS.value:.0f} variables are no measurement"
            )
    if not is_hdf5(path):
        return
    try:
        # imported late: h5py loads slowly
        import h5py
    except ImportError as error:
        raise missing(path, "h5py") from error
    with h5py.File(path, "r") as opened:
        look = _Visitor(h5py, opened)
        look.count_attributes(opened.id)
        opened.id.links.visit(look)
    if look.too_many:
        raise RefusedError(
            f"{path}: more than {limits.HDF5_OBJECTS.value:.0f} groups and datasets, "
            f"{limits.HDF5_ATTRIBUTES.value:.0f} attributes or {limits.HDF5_DEPTH.value:.0f} "
            "groups in one another are no measurement; save the run's own datasets in a file of "
            "their own"
        )
    if look.found:
        raise refused(path, *look.found)


def _variables_of_classic(file: BinaryIO, version: int) -> int:
    """Return the number of variables in the header of a classic netCDF file; 0 if it is damaged.

    References
    ----------
    NetCDF Users Guide, appendix "File Format Specifications": a header is dimensions, attributes
    and variables; counts have 8 bytes in version 5.
    """
    wide = 8 if version == 5 else 4

    def number(size: int = wide) -> int:
        part = file.read(size)
        if len(part) < size:
            raise EOFError
        return int.from_bytes(part, "big")

    def skip(size: int) -> None:
        file.seek(size + -size % 4, 1)

    try:
        file.seek(4)
        number()  # number of records
        for is_attribute in (False, True):
            number(4)
            if (count := number()) > limits.HDF5_ATTRIBUTES.value:
                return count
            for _ in range(count):
                skip(number())
                size = _BYTES.get(number(4), 1) if is_attribute else 0
                skip(size * number())
        number(4)
        return number()
    except (EOFError, OSError, OverflowError):
        return 0


def is_hdf5(path: Path) -> bool:
    """Whether a file contains HDF5, which may begin at byte 0, 512, 1024, 2048 ...

    References
    ----------
    HDF5 File Format Specification 3.0, section II.A: the superblock follows a user block.
    """
    with path.open("rb") as file:
        size, place = file.seek(0, 2), 0
        while place < size:
            file.seek(place)
            if file.read(len(_HDF5)) == _HDF5:
                return True
            place = max(2 * place, _USER_BLOCK)
    return False


def foreign_storage(h5: Any, item: Any) -> str:
    """Return how a dataset refers to external data or filters; "" if it does not.

    Parameters
    ----------
    h5
        The library h5py.
    item
        Identifier of an object; only datasets have storage.
    """
    if not isinstance(item, h5.h5d.DatasetID):
        return ""
    made = item.get_create_plist()
    if made.get_external_count():
        name = made.get_external(0)[0].decode(errors="replace")
        return f"stored in another file ({shown(name, 60)})"
    if made.get_layout() == h5.h5d.VIRTUAL:
        return "a virtual dataset, which shows parts of other files"
    for number in range(made.get_nfilters()):
        code = made.get_filter(number)[0]
        if code not in _OWN_FILTERS:
            return f"packed with filter {code}, which is not part of the HDF5 library"
    return ""


def refused(path: Path, name: str, what: str) -> RefusedError:
    """Return the error for a dataset or link that refers to data outside a file."""
    return RefusedError(
        f"{path}: '{shown(name, 80)}' is {what}; tribolab reads no data from outside a file. "
        "Save a copy that holds its own data (h5repack, or read it and write it again)"
    )


class _Visitor:
    """Visitor of all links that stops at the first one to external data."""

    def __init__(self, h5py: Any, file: Any) -> None:
        self._h5py, self._file = h5py, file
        self.found: tuple[str, str] | None = None
        self._count, self._attributes, self.too_many = 0, 0, False

    def __call__(self, name: bytes) -> bool | None:
        h5 = self._h5py
        self._count += 1
        if self._count > limits.HDF5_OBJECTS.value or name.count(b"/") > limits.HDF5_DEPTH.value:
            self.too_many = True  # an exception would not pass through the library
        if self.too_many:
            return True
        kind = self._file.id.links.get_info(name).type
        what = ""
        if kind == h5.h5l.TYPE_HARD:
            what = self._outside(name)
        elif kind == h5.h5l.TYPE_EXTERNAL:
            what = "a link to another file"
        elif kind != h5.h5l.TYPE_SOFT:
            what = "a link of an unknown kind"
        if what:
            self.found = name.decode("utf-8", "replace"), what
        return True if what else None

    def count_attributes(self, item: Any) -> None:
        """Count the attributes of a group, dataset or type."""
        self._attributes += self._h5py.h5a.get_num_attrs(item)
        self.too_many |= self._attributes > limits.HDF5_ATTRIBUTES.value

    def _outside(self, name: bytes) -> str:
        h5 = self._h5py
        item = h5.h5o.open(self._file.id, name)
        self.count_attributes(item)
        return foreign_storage(h5, item)
