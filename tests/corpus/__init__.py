"""The corpus: every file that tests hand to reading, and what reading made of it.

For whoever changes how files are read: `compare` says which files are read otherwise now, and how
(commands in ``__main__.py``; `show` writes a case's files to look at). A change that is right goes
to ``judged.jsonl``, one line each: {"case": ..., "where": ..., "why": ...}. A fifth of the
contents, drawn by their checksum, is held out: whoever writes rules does not open it, and gets its
counts alone.

``seen.tar.xz`` holds the files under their checksums, ``seen.jsonl`` a line for each case: what is
read, and what came of it (`corpus.digest.read_case`); ``held_out.*`` are those of the fifth. Files
of ``../shared/data`` are read where they lie.

To make it anew, record what tests read (`corpus.record`), then collect::

    TRIBOLAB_RECORD=/tmp/recorded PYTHONPATH=.:tests python -m pytest -p corpus.record \
        tests/questions tests/scans tests/instruments ...
    TRIBOLAB_RECORD=/tmp/recorded PYTHONPATH=.:tests python -m corpus.record \
        tests/robustness/scan_kinds.py
    PYTHONPATH=.:tests python -m corpus collect /tmp/recorded
"""
