"""Dialects: what they can say, and how they answer to what cannot be."""

import json
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tribolab as tl
from tribolab.core.errors import ConfigError, ReadError
from tribolab.reading.dialect.find import json_schema, known_dialects, load_dialect, recognise
from tribolab.reading.dialect.recognise import mismatch
from tribolab.reading.dialect.write import dialect_toml
from tribolab.reading.schema_folder import schema_folder
from tribolab.reading.text.first_bytes import peek

BASE = """
name = "mine"
title = "My rig"
[text]
delimiter = ";"
decimal = ","
[header]
line = 1
[[column]]
quantity = "time"
name = "t"
[[column]]
quantity = "friction_force"
name = "F"
"""


def write(folder, dialect, data, encoding="utf-8", name="run.dat"):
    (folder / "mine.toml").write_text(dialect)
    (folder / name).write_bytes(data.encode(encoding) if isinstance(data, str) else data)
    return folder / name, folder / "mine.toml"


def test_every_known_dialect_is_valid_and_named_like_its_file():
    assert known_dialects()
    for name in known_dialects():
        assert load_dialect(name).name == name


def test_the_json_schema_beside_the_dialects_is_that_of_the_model():
    text = (schema_folder() / "dialect.schema.json").read_text(encoding="utf-8")
    assert json.loads(text) == json_schema()


@pytest.mark.parametrize(("unit", "to"), [("mm/min", "m/s"), ("N/mm", "N/m"), ("N mm", "J")])
def test_a_value_that_is_no_quantity_is_told_its_own_si_unit_and_the_nearest(tmp_path, unit, to):
    value = f'[[value]]\nname = "set_sliding_speed"\npattern = "(1)"\nunit = "{unit}"\n'
    write(tmp_path, BASE + value, "")
    with pytest.raises(ConfigError, match=r"did you mean .*'set_speed'") as caught:
        load_dialect(tmp_path / "mine.toml")
    assert f"add to = '{to}'" in str(caught.value)
    right = value + f'to = "{to}"\n'
    write(tmp_path, BASE + right, "")
    assert load_dialect(tmp_path / "mine.toml").value[0].si_unit == to


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (('delimiter = ";"', 'delimeter = ";"'), "did you mean 'delimiter'"),
        (('quantity = "friction_force"', 'quantity = "friction_forse"'), "friction_force"),
        (("line = 1", 'pattern = "("'), "regular expression"),
        (('name = "F"', 'name = "F"\nunit = "mm"'), "cannot be turned into 'N'"),
        (('name = "F"', 'name = "F"\nposition = 2'), "either name, name_pattern or position"),
        (("line = 1", ""), "position and unit"),
        (('quantity = "time"', 'quantity = "position"'), "time"),
        (('decimal = ","', 'decimal = ";"'), "decimal"),
        (('decimal = ","', 'decimal = ","\nencoding = "utf-9"'), "encoding"),
        (("[header]", "[header"), "cannot be read"),
    ],
)
def test_a_wrong_dialect_is_refused_with_the_place_and_the_cure(tmp_path, change, told):
    (tmp_path / "mine.toml").write_text(BASE.replace(*change))
    with pytest.raises(ConfigError, match=told) as error:
        load_dialect(tmp_path / "mine.toml")
    assert "mine.toml" in str(error.value)


def test_an_unknown_instrument_names_the_nearest():
    with pytest.raises(ConfigError, match="did you mean 'linear_slider"):
        load_dialect("linear_slyder")


def test_decimal_comma_and_units_in_brackets(tmp_path):
    file, dialect = write(tmp_path, BASE, "t (ms);F [mN];\n0,5;-1,25;\n1,0;2,5;\n")
    run = tl.read(file, dialect)
    assert run["friction_force"].values.tolist() == [-0.00125, 0.0025]
    assert run["time"].values.tolist() == [0.0, 0.0005]
    assert run.attrs["time_origin_s"] == 0.0005


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
def test_encodings_with_a_micro_and_a_degree_sign(tmp_path, encoding):
    dialect = BASE.replace("[text]", f'[text]\nencoding = "{encoding}"') + (
        '[[column]]\nquantity = "position"\nname = "x µ"\n'
        '[[column]]\nquantity = "temperature"\nname = "T"\n'
    )
    file, mine = write(
        tmp_path, dialect, "t [s];F [N];x µ [µm];T [°C]\n0;1;3;20\n1;1;4;21\n", encoding
    )
    mine.write_text(dialect, encoding="utf-8")
    run = tl.read(file, mine)
    assert run["position"].values == pytest.approx([3e-6, 4e-6])
    assert run["temperature"].values == pytest.approx([293.15, 294.15])


def test_the_wrong_encoding_names_the_key_to_change(tmp_path):
    text = "# Bahn in µm\nt [s];F [N]\n0;1\n1;1\n"
    file, dialect = write(tmp_path, BASE.replace("line = 1", "line = 2"), text, "latin-1")
    with pytest.raises(ReadError, match="encoding = 'latin-1'"):
        tl.read(file, dialect)


def test_sign_scale_and_offset_act_in_the_files_unit(tmp_path):
    calibrated = BASE.replace('name = "F"', 'name = "F"\nscale = 2.0\noffset = 1.0\nsign = -1')
    file, dialect = write(tmp_path, calibrated, "t [s];F [mN]\n0;3\n1;4\n")
    assert tl.read(file, dialect)["friction_force"].values == pytest.approx([-0.007, -0.009])


def test_error_codes_and_empty_cells_are_missing_values(tmp_path):
    data = "t [s];F [N]\n0;1\n1;Err110\n2;\n3;nan\n4;5\n"
    file, dialect = write(
        tmp_path, BASE.replace("[header]", 'missing = ["Err110"]\n[header]'), data
    )
    np.testing.assert_array_equal(tl.read(file, dialect)["friction_force"], [1, *[np.nan] * 3, 5])


def test_columns_between_blanks_of_any_width(tmp_path):
    spaced = BASE.replace('";"', '"whitespace"').replace('","', '"."')
    file, dialect = write(tmp_path, spaced, "t[s]   F[N]\n  0.0   1.0\n 10.0\t -2.0  \n")
    assert tl.read(file, dialect)["friction_force"].values.tolist() == [1.0, -2.0]


def test_a_footer_ends_the_table(tmp_path):
    data = "t [s];F [N]\n0;1\n1;2\nEnd of test\nmean;1,5\n"
    file, dialect = write(tmp_path, BASE.replace("[header]", 'end = "^End of"\n[header]'), data)
    assert tl.read(file, dialect).sizes["time"] == 2


RATE = BASE.replace('[[column]]\nquantity = "time"\nname = "t"\n', "")


def test_time_from_a_sample_rate_or_from_nowhere_says_so(tmp_path):
    file, dialect = write(
        tmp_path, RATE + '[time]\nsource = "rate"\nrate = "2 kHz"', "F [N]\n1\n2\n"
    )
    run = tl.read(file, dialect)
    assert float(run["time"][1]) == 0.0005 and run.attrs["time_source"] == "sample rate"
    file, dialect = write(tmp_path, RATE + '[time]\nsource = "none"', "F [N]\n1\n2\n")
    assert tl.read(file, dialect).attrs["time_source"] == "row number"


def test_speed_follows_from_rotation_and_radius(tmp_path):
    turning = BASE + (
        '[[column]]\nquantity = "rotation_speed"\nname = "n"\nunit = "rpm"\n'
        '[[value]]\nname = "track_radius"\npattern = "^# radius: (\\\\S+)"\nunit = "mm"\nto = "m"\n'
        '[speed]\nsource = "rotation"\nradius_value = "track_radius"\n'
    ).replace("\\\\", "\\\\")
    data = "# radius: 30\nt [s];F [N];n\n0;1;60\n1;1;120\n"
    file, dialect = write(tmp_path, turning.replace("line = 1", "line = 2"), data)
    run = tl.read(file, dialect)
    assert run["sliding_velocity"].values == pytest.approx(0.03 * 2 * np.pi * np.array([1, 2]))


def test_a_step_that_states_its_speed_gives_it_along_time(tmp_path):
    steps = BASE.replace("line = 1", "pattern = '^t '\nrepeats = true").replace(
        "[header]", "end = '^$'\n[header]"
    ) + (
        "[time]\nrestart = 'continue'\n[[value]]\nname = 'set_speed'\nsource = 'step'\n"
        "pattern = 'v = (\\S+)'\nunit = 'mm/s'\n"
    )
    block = "v = {}\nt [s];F [N]\n0;1\n1;1\n\n"
    file, dialect = write(tmp_path, steps, block.format("0,5") + block.format("2"))
    run = tl.read(file, dialect)
    assert run["set_speed"].values.tolist() == [0.0005, 0.0005, 0.002, 0.002]
    assert run["time"].values.tolist() == [0, 1, 2, 3] and run["step"].values.tolist() == [
        1,
        1,
        2,
        2,
    ]


def test_nothing_and_too_much_recognised_name_the_way_out(tmp_path, monkeypatch):
    file = tmp_path / "odd.csv"
    file.write_text("a,b\n1,2\n")
    with pytest.raises(
        ReadError,
        match="'tribolab info .* --write my.toml' drafts a description.*: name it with instrument=",
    ):
        recognise(file)
    file.write_text("# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n0,1,1\n")
    twin = (
        (schema_folder() / "instruments/linear_slider.toml")
        .read_text()
        .replace('name = "linear_slider"', 'name = "twin"', 1)
    )
    (tmp_path / "twin.toml").write_text(twin)
    both = known_dialects() | {"twin": tmp_path / "twin.toml"}
    monkeypatch.setattr("tribolab.reading.dialect.find.known_dialects", lambda: both)
    with pytest.raises(ReadError, match="'linear_slider', 'twin'; say which with instrument="):
        recognise(file)


# less than a trace of nothing is read as nothing
MEASURED = st.floats(-1e6, 1e6, allow_nan=False).filter(lambda x: x == 0 or abs(x) > 1e-60)


@settings(deadline=None, max_examples=40)
@given(
    st.lists(MEASURED, min_size=1, max_size=50),
    st.sampled_from(["\n", "\r\n", "\r", "\r\r\n"]),
    st.sampled_from([".", ","]),
    st.booleans(),
)
def test_numbers_come_back_exactly_however_they_are_written(
    tmp_path_factory, numbers, end, decimal, trailing
):
    folder = tmp_path_factory.mktemp("written")
    tail = ";" if trailing else ""
    rows = [f"{n};{force!r}".replace(".", decimal) + tail for n, force in enumerate(numbers)]
    data = end.join([f"t [s];F [N]{tail}", *rows, ""])
    file, dialect = write(folder, BASE.replace('decimal = ","', f'decimal = "{decimal}"'), data)
    assert tl.read(file, dialect)["friction_force"].values.tolist() == numbers


def test_blocks_join_without_loss_in_a_file_longer_than_a_block(tmp_path, monkeypatch):
    from tribolab.reading.dialect.delimited import read_text as text

    numbers = np.random.default_rng(1).normal(size=1500)
    data = "t [s];F [N]\n" + "".join(f"{n};{force!r}\n" for n, force in enumerate(numbers.tolist()))
    plain = BASE.replace('decimal = ","', 'decimal = "."')
    file, dialect = write(tmp_path, plain, data)
    whole = tl.read(file, dialect)
    for block in (17, 100, 4096):
        monkeypatch.setattr(text, "_BLOCK", block)
        run = tl.read(file, dialect)
        assert run["friction_force"].values.tolist() == numbers.tolist()
        assert run.attrs["source_sha256"] == whole.attrs["source_sha256"]


def test_the_complete_example_of_the_readme_works_as_it_stands(tmp_path):
    blocks = re.findall(
        r"```(\w+)\n(.*?)```", (schema_folder() / "README.md").read_text(encoding="utf-8"), re.S
    )
    text, toml = (next(body for kind, body in blocks if kind == k) for k in ("text", "toml"))
    file, dialect = write(tmp_path, toml, text, "latin-1", "steel_12N.txt")
    run = tl.read(file, dialect)
    assert run["friction_force"].values == pytest.approx([-0.0125, -0.0131, -0.0133])
    np.testing.assert_array_equal(run["normal_force"], [11.98, np.nan, 12.02])
    assert run["time"].values.tolist() == [0.0, 0.002, 0.004]
    assert run.attrs["set_normal_force_N"] == 12.0 and run.attrs["operator"] == "M. Weber"
    assert run.attrs["recorded_at"] == "2025-04-03T10:15:00"
    assert run.attrs["columns_not_used"] == "Fehler"


ENDLESS = "^(a|aa)+$"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("[text]", f"[recognise]\npreamble = ['{ENDLESS}']\n[text]"),
        ("line = 1", f"pattern = '{ENDLESS}'"),
        ("[[column]]", f"[[value]]\nname = 'word'\npattern = '{ENDLESS}'\n[[column]]"),
    ],
    ids=["preamble", "header", "value"],
)
def test_a_pattern_that_backtracks_without_end_is_a_clear_error_in_time(
    tmp_path, old, new, monkeypatch
):
    monkeypatch.setattr("tribolab.reading.text.bounded_patterns._SECONDS", 0.2)
    text = "a" * 60 + "b\nt [s];F [N]\n" + "".join(f"{n};1\n" for n in range(20))
    (tmp_path / "raw.csv").write_text(text)
    known = BASE.replace("line = 1", "pattern = '^t '") if old != "line = 1" else BASE
    (tmp_path / "mine.toml").write_text(known.replace(old, new, 1))
    with pytest.raises(ReadError, match="takes too long on this file"):
        if "recognise" in new:
            mismatch(peek(tmp_path / "raw.csv"), load_dialect(tmp_path / "mine.toml"))
        tl.read(tmp_path / "raw.csv", str(tmp_path / "mine.toml"))


def test_a_pattern_longer_than_any_line_is_refused(tmp_path):
    (tmp_path / "mine.toml").write_text(BASE.replace("line = 1", f"pattern = '{'a' * 2000}'"))
    with pytest.raises(ConfigError, match="at most 1000 are taken"):
        load_dialect(tmp_path / "mine.toml")


@pytest.mark.parametrize("name", known_dialects())
def test_a_dialect_is_written_as_it_was_read(name, tmp_path):
    file = tmp_path / "written.toml"
    file.write_text(dialect_toml(load_dialect(name)), "utf-8")
    assert load_dialect(file) == load_dialect(name)


def test_a_run_says_where_no_file_of_its_instrument_was_seen(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("Imada ZT\nNo,Time [s],Force [N]\n" + "".join(f"{n},{n},1\n" for n in range(9)))
    unseen = {n for n in known_dialects() if not load_dialect(n).from_file}
    assert unseen == {"force_gauge", "optimol_srv", "pcs_hfrr", "tribox"}
    assert "without a file of it" in tl.read(file, "force_gauge").attrs["instrument_note"]
    assert (
        "instrument_note"
        not in tl.read(*write(tmp_path, BASE, "t [s];F [N]\n0,0;1,0\n1,0;1,0\n")).attrs
    )
