"""Drafting dialects of any text: what was written is read back, whatever the way of writing."""

import numpy as np
import pytest
from drafts import drafted
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from tribolab.core.errors import ReadError
from tribolab.reading.unknown.proposal.draft import draft_dialect

NAMES = {
    "time": ("Time", "s", 1.0),
    "friction_force": ("Reibkraft", "mN", 1e-3),
    "normal_force": ("Normal force", "N", 1.0),
    "position": ("Weg", "um", 1e-6),
    "sliding_velocity": ("Sliding speed", "mm/s", 1e-3),
    "temperature": ("Temperatur", "K", 1.0),
}


@st.composite
def files(draw):
    """Text files as instruments write them: every mixture of marks, ends, headers, preambles."""
    delimiter, decimal = draw(
        st.sampled_from([("\t", "."), ("\t", ","), (";", "."), (";", ","), (",", ".")])
    )
    names = ["time", *draw(st.lists(st.sampled_from(list(NAMES)[1:]), min_size=1, unique=True))]
    order = draw(st.permutations(names))
    rows = draw(st.integers(3, 40))
    seed = draw(st.integers(0, 2**31))
    values = {n: np.random.default_rng(seed + i).normal(5, 2, rows) for i, n in enumerate(names)}
    values["time"] = np.cumsum(np.random.default_rng(seed).uniform(0.01, 0.02, rows)) + 3
    table = np.round(np.array([values[name] for name in order]).T, 4)
    style = draw(st.sampled_from(["brackets", "round", "row"]))
    label = {"brackets": "{} [{}]", "round": "{} ({})", "row": "{}"}[style]
    header = [delimiter.join(label.format(*NAMES[name][:2]) for name in order)]
    if style == "row":
        header.append(delimiter.join(NAMES[name][1] for name in order))
    preamble = draw(
        st.lists(
            st.sampled_from(
                ["# date: 2026-03-02", "Operator: Müller", "Sample PMMA", "", "Rate = 100 Hz"]
            ),
            max_size=4,
        )
    )
    body = [delimiter.join(f"{v:.4f}".replace(".", decimal) for v in row) for row in table]
    footer = draw(st.sampled_from([[], [""], ["", "End of test"]]))
    end = draw(st.sampled_from(["\n", "\r\n", "\r", "\r\r\n"]))
    encoding = draw(st.sampled_from(["utf-8", "utf-8-sig", "latin-1", "utf-16"]))
    text = end.join([*preamble, *header, *body, *footer]) + draw(st.sampled_from(["", end]))
    return text.encode(encoding), dict(zip(order, table.T, strict=True))


@pytest.mark.slow
@given(made=files())
@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_any_way_of_writing_the_same_table_is_read_back(made, tmp_path_factory):
    content, columns = made
    folder = tmp_path_factory.mktemp("made")
    file = folder / "made.txt"
    file.write_bytes(content)
    data, draft = drafted(file, folder)
    wanted = " ".join(draft.to_fill_in.values())
    alone = {"friction_force", "normal_force"} & set(columns) == {"friction_force"}
    assert draft.kind == "run" and (wanted.startswith("the load") if alone else not wanted)
    assert data.attrs["time_origin_s"] == pytest.approx(columns["time"][0])
    for name, values in columns.items():
        if name != "time":
            np.testing.assert_allclose(data[name].values, values * NAMES[name][2], rtol=1e-12)


@pytest.mark.slow
@given(content=st.binary(max_size=400) | st.text(max_size=200).map(str.encode))
@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_any_bytes_are_drafted_or_refused_with_a_reason(content, tmp_path_factory):
    file = tmp_path_factory.mktemp("bytes") / "any.txt"
    file.write_bytes(content)
    try:
        draft = draft_dialect(file)
    except ReadError as error:
        assert str(file) in str(error)
        return
    assume(draft.toml)
    assert draft.dialect is not None
