"""A packed file that unpacks to far more than results hold is refused before it is unpacked."""

import zipfile

import pytest

from tribolab.archive import packing
from tribolab.core.errors import ReadError


def test_a_bomb_is_not_unpacked_to_be_verified(tmp_path, monkeypatch):
    path = tmp_path / "a.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(packing.METADATA, '{"@graph": []}')
        with archive.open("tables/a.csv", "w") as file:
            for _ in range(100):
                file.write(b"0" * 1_000_000)
    monkeypatch.setattr(zipfile.ZipFile, "read", lambda *_: pytest.fail("it was unpacked"))
    with pytest.raises(ReadError, match=r"a\.zip: it unpacks to 100 MB"):
        packing.problems_of(path)
