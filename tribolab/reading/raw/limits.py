"""Limits of the resources used while reading a file."""

from tribolab.core.limit import Limit

CPU_FOR_ANY_FILE = Limit(
    4.0, "s", "computing time that a small file may take; a sound one takes less than 1 s"
)
BYTES_PER_CPU_SECOND = Limit(
    1e6, "1/s", "slowest sound reading: workbooks take 1 s for 1 to 2 MB of packed cells",
    "measured with python-calamine 0.4 on 1e6 cells",
)  # fmt: skip
MEMORY_FOR_ANY_FILE = Limit(
    0.7e9, "byte", "memory beyond the libraries' own: reading a small file stays below 1 GB"
)
MEMORY_PER_BYTE = Limit(
    40.0, "1", "memory per byte of the file: a workbook's cells take 30 times their packed size",
    "measured with python-calamine 0.4 on 1e6 cells",
)  # fmt: skip
UNPACKED_FOR_ANY_FILE = Limit(
    16e6, "byte", "what a packed file may unpack to, however well it is packed: read in 2 s"
)
UNPACKED_PER_BYTE = Limit(
    50.0, "1", "times its size that a packed file may unpack to: measured signals shrink 2 to 20 "
    "times, set-points and clocks 30 times",
)  # fmt: skip
MAX_UNPACKED = Limit(
    16e9, "byte", "what any file may unpack to; the environment variable TRIBOLAB_MAX_UNPACKED "
    "(bytes) changes it",
)  # fmt: skip
PATIENCE = Limit(60.0, "s", "waiting for a child beyond its computing time, on a busy machine")
AT_REST = Limit(
    600.0, "s", "age from which on size and times alone show whether a file is written to: FAT "
    "notes times to 2 s, network file systems some 60 s late, and clocks of servers differ",
)  # fmt: skip
SURELY_OLD = Limit(
    3.0, "s", "age from which size and times show whether a file is the one that was looked at",
    "FAT notes times to 2 s",
)  # fmt: skip
READINGS = Limit(3.0, "1", "readings of a file that changes while it is read, before it is refused")
HDF5_OBJECTS = Limit(
    5000.0, "1", "groups and datasets in an HDF5 file: 10 000 take half a "
    "minute to read", "measured with h5py 3 on datasets of 2 numbers",
)  # fmt: skip
HDF5_ATTRIBUTES = Limit(
    20_000.0, "1", "attributes in an HDF5 file: 30 000 take 10 s to read", "measured with h5py 3"
)
COLUMNS = Limit(
    5000.0, "1", "columns of a file: a run has tens, a spectrum of time some thousand; the draft "
    "of 10 000 takes more than 10 s", "measured on text and Parquet",
)  # fmt: skip
COLUMNS_OF_TEXT = Limit(
    10_000.0, "1", "cells in a line of text: a map has up to 8192; to look at rows of 20 000 takes "
    "more than 10 s", "measured on text",
)  # fmt: skip
HDF5_DEPTH = Limit(100.0, "1", "groups in one another: 3000 take half a minute to look at")
XML_DEPTH = Limit(500.0, "1", "elements of XML in one another; office files have a dozen")
LETTERS_OF_ENTITY = Limit(
    100.0, "1", "letters of an entity: a sign or a name; so no text grows to more than 25 times"
)
LETTERS_OF_DEFAULTS = Limit(
    200.0, "1", "letters of attributes that a DTD gives to each element: some namespaces"
)
