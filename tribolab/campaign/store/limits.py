"""Limits of the check whether result files are unchanged."""

from tribolab.core.limit import Limit

ALWAYS_READ = Limit(
    8e6, "byte", "largest size of a file of which all bytes are checked at every run: the demo's "
    "200 files, 64 MB, take 0.1 s; larger ones are identified by size, time, inode and samples",
)  # fmt: skip
SAMPLE = Limit(65_536, "byte", "each of the samples of a large file that are checked at every run")
SAMPLES = Limit(16, "1", "samples of a large file, evenly spread: its start and end among them")
