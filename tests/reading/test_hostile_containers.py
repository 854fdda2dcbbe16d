"""Files that reach for other files, or for all of the machine, cost one message each."""

import os
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest
from hostile.outside import SECRET, WAYS, external, foreign_filter, reference, secret, write

import tribolab as tl
from tribolab.core.errors import ReadError
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.reading.raw.hdf5_safety import check_self_contained


@pytest.fixture
def away(tmp_path):
    return secret(tmp_path)


@pytest.mark.parametrize("ending", ["h5", "nc", "mat"])
@pytest.mark.parametrize("way", WAYS, ids=lambda way: way.__name__)
def test_data_from_another_file_are_refused_by_name_by_every_reader(way, ending, away, tmp_path):
    path = tmp_path / f"a.{ending}"
    write(path, way, away)
    readers = [check_self_contained, tl.read, tl.read_scans]
    readers += [read_netcdf] * (ending == "nc")
    for reader in readers:
        with pytest.raises(ReadError) as caught:
            reader(path)
        assert "tribolab reads no data from outside a file" in str(caught.value)
        assert SECRET[:10] not in str(caught.value)


@pytest.mark.parametrize("user_block", [1024, 65536])
def test_hdf5_behind_a_long_user_block_is_looked_at(user_block, away, tmp_path):
    """The library looks for it at 512, 1024, 2048 ... bytes."""
    path = tmp_path / "a.mat"
    write(path, external, away, user_block)
    for reader in (tl.read, tl.read_scans, read_netcdf):
        with pytest.raises(ReadError, match="is stored in another file"):
            reader(path)


def test_a_zip_archive_that_is_hdf5_too_is_refused(away, tmp_path):
    write(tmp_path / "a.mat", external, away)
    content = (tmp_path / "a.mat").read_bytes()
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as archive:
        archive.writestr(zipfile.ZipInfo("a" * (512 - 30)), content[512:])
    with pytest.raises(ReadError, match="is stored in another file"):
        check_self_contained(tmp_path / "a.zip")


def test_a_dataset_to_which_a_reference_alone_leads_is_refused(away, tmp_path):
    write(tmp_path / "a.mat", reference, away)
    with pytest.raises(ReadError, match=r"'run/Fx_N\(1\)' is stored in another file"):
        tl.read(tmp_path / "a.mat")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="children are copies on POSIX only")
def test_what_cannot_be_checked_is_not_read(tmp_path, monkeypatch):
    """A function that would read it is not called."""
    import isolated_cases as cases

    monkeypatch.syspath_prepend(str(Path(cases.__file__).parent))
    for name, head in (("a.h5", b"\x89HDF\r\n\x1a\n"), ("a.zip", b"PK\x03\x04")):
        (tmp_path / name).write_bytes(head + b"damaged" * 9)
        with pytest.raises(ReadError, match=f"{name}: this .* cannot be read"):
            cases.leave_a_trace(tmp_path / name)
    assert len(list(tmp_path.iterdir())) == 2


def test_a_filter_that_is_not_the_librarys_is_refused(tmp_path):
    write(tmp_path / "a.h5", foreign_filter, tmp_path)
    with pytest.raises(ReadError, match=r"'Fx \[N\]' is packed with filter 32004"):
        check_self_contained(tmp_path / "a.h5")


def test_files_with_their_own_data_pass(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["a/x"] = np.arange(4.0)
        file["a/soft"] = h5py.SoftLink("/a/x")
        for name in ("gzip", "lzf"):
            file.create_dataset(name, data=np.arange(100.0), compression=name, shuffle=True)
    check_self_contained(tmp_path / "a.h5")


def sparse_workbook(path: Path) -> None:
    """Two cells in opposite corners of a sheet: 1.7e10 cells lie between them."""
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006"
    cell = '<row r="{0}"><c r="{1}{0}"><v>1</v></c></row>'
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{package}/content-types"/>',
        "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
        f'Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets>'
        '<sheet name="a" sheetId="1" r:id="r1"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{package}/relationships">'
        f'<Relationship Id="r1" Type="{office}/worksheet" Target="worksheets/sheet1.xml"/>'
        "</Relationships>",
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{main}"><sheetData>'
        f"{cell.format(1, 'A')}{cell.format(1048576, 'XFD')}</sheetData></worksheet>",
    }
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(name, text)


@pytest.mark.parametrize("reader", [tl.read, tl.read_scans, tl.rubber.read_modulus])
def test_a_workbook_of_two_far_cells_costs_one_message(reader, tmp_path):
    sparse_workbook(tmp_path / "a.xlsx")
    with pytest.raises(ReadError, match=r"a\.xlsx"):
        reader(tmp_path / "a.xlsx")


@pytest.mark.parametrize("shape", [(10**12,), (10**6, 10**7)])
def test_a_dataset_of_terabytes_costs_one_message(shape, tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.create_dataset("Fx [N]", shape, "f8", chunks=(1000,) * len(shape))
    for reader in (tl.read, tl.read_scans):
        with pytest.raises(ReadError, match=r"a\.h5"):
            reader(tmp_path / "a.h5")


def test_an_index_beside_a_tdms_file_is_not_looked_at(shared_data, tmp_path):
    whole = shared_data / "tdms_force_MIT" / "TDMSSample.tdms"
    (tmp_path / "a.tdms").write_bytes(whole.read_bytes())
    (tmp_path / "a.tdms_index").write_bytes(b"TDSh" + b"\xff" * 400)
    from tribolab.reading.raw.containers.tdms import channel_names

    assert channel_names(tmp_path / "a.tdms") == channel_names(whole) != set()
