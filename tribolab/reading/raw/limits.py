"""Limits of the resources used while reading a file."""

from tribolab.core.limit import Limit

CPU_FOR_ANY_FILE = Limit(
    4.0, "s", "computing time that any file may take; a sound small file takes less than 1 s"
)
BYTES_PER_CPU_SECOND = Limit(
    1e6, "1/s", "slowest sound reading: workbooks take 1 s for 1 to 2 MB of packed cells",
    "measured with python-calamine 0.4 on 1e6 cells",
)  # fmt: skip
MEMORY_FOR_ANY_FILE = Limit(
    0.7e9, "byte", "memory that any file may take in addition to the libraries; a sound small "
    "file takes less than 1 GB in all",
)  # fmt: skip
MEMORY_PER_BYTE = Limit(
    40.0, "1", "memory per byte of the file; the cells of a workbook take 30 times their packed "
    "size", "measured with python-calamine 0.4 on 1e6 cells",
)  # fmt: skip
UNPACKED_FOR_ANY_FILE = Limit(
    16e6, "byte", "size to which any packed file may unpack, however well it is packed; it is "
    "read in 2 s",
)  # fmt: skip
UNPACKED_PER_BYTE = Limit(
    50.0, "1", "unpacked size, divided by the packed size, up to which a file is read: measured "
    "signals shrink 2 to 20 times, set-points and clocks 30 times",
)  # fmt: skip
MAX_UNPACKED = Limit(
    16e9, "byte", "largest unpacked size of any file; the environment variable "
    "TRIBOLAB_MAX_UNPACKED (bytes) changes it",
)  # fmt: skip
PATIENCE = Limit(
    60.0, "s", "time to wait for a child process beyond its computing time, for a busy machine"
)
AT_REST = Limit(
    600.0, "s", "age above which size and times alone show that a file has not changed: FAT "
    "stores times to 2 s, network file systems some 60 s late, and clocks of servers differ",
)  # fmt: skip
SURELY_OLD = Limit(
    3.0, "s", "age above which size and times show whether a file is the one that was inspected",
    "FAT notes times to 2 s",
)  # fmt: skip
READINGS = Limit(
    3.0, "1", "attempts to read a file that changes while it is read, before it is refused"
)
HDF5_OBJECTS = Limit(
    5000.0, "1", "most groups and datasets in an HDF5 file; 10 000 take half a minute to read",
    "measured with h5py 3 on datasets of 2 numbers",
)  # fmt: skip
HDF5_ATTRIBUTES = Limit(
    20_000.0, "1", "most attributes in an HDF5 file; 30 000 take 10 s to read",
    "measured with h5py 3",
)  # fmt: skip
COLUMNS = Limit(
    5000.0, "1", "most columns of a file: a run has tens, spectra over time some thousand; a "
    "draft for 10 000 takes more than 10 s", "measured on text and Parquet",
)  # fmt: skip
COLUMNS_OF_TEXT = Limit(
    10_000.0, "1", "most cells in a line of text: a map has up to 8192; inspecting rows of 20 000 "
    "takes more than 10 s", "measured on text",
)  # fmt: skip
HDF5_DEPTH = Limit(
    100.0, "1", "deepest nesting of groups in an HDF5 file; 3000 levels take half a minute to "
    "inspect",
)  # fmt: skip
XML_DEPTH = Limit(500.0, "1", "deepest nesting of XML elements; office files have a dozen levels")
LETTERS_OF_ENTITY = Limit(
    100.0, "1", "longest XML entity in letters: a sign or a name, so that no text grows by more "
    "than 25 times",
)  # fmt: skip
LETTERS_OF_DEFAULTS = Limit(
    200.0, "1", "most letters of attributes that a DTD gives to each element: some namespaces"
)
