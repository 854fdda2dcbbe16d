"""How results show themselves in a notebook."""

import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import tribolab as tl
from tribolab.app import check_output, checks
from tribolab.rig.parameters import Protocol, Rig
from tribolab.rig.runs import simulate_run


@pytest.fixture
def spiked():
    force = 1 + 0.01 * np.random.default_rng(0).standard_normal(2000)
    force[700] = 9.0
    run = xr.Dataset({"friction_force": ("time", force)}, {"time": np.arange(2000) / 100})
    return run.assign(sliding_velocity=("time", np.full(2000, 1e-3))).assign_attrs(
        source="<a>.csv", friction_force_zero_uncertainty_N=0.1
    )


def test_findings_tell_each_objection_whole_and_fold_the_rest_away(spiked):
    found = tl.check(spiked)
    [message] = found.table.query("check == 'spikes'").message
    shown, rest = found._repr_html_().split("<details>")
    assert len(message) > 50 and message in shown and "..." not in shown
    assert shown.count("<tr>") == 2 and rest.count("<tr>") == 1 + len(found.rows)
    assert "&lt;a&gt;.csv: suspect" in shown and "<a>" not in shown


def test_findings_print_what_the_command_shows(spiked, tmp_path, capsys):
    found = tl.check(spiked)
    check_output.show([checks.Checked.of((tmp_path / "<a>.csv",), found)])
    summary, *rows = capsys.readouterr().out.splitlines()
    printed = str(found)
    assert printed.splitlines()[0] == summary
    assert summary.startswith("<a>.csv: suspect (") and ", 1 with findings, " in summary
    assert " ".join("".join(rows).split()) == " ".join(printed.split("\n", 1)[1].split())
    assert "function" not in repr(found.results)


def test_findings_without_objection_need_no_table(spiked):
    shown = tl.check(spiked, skip=["spikes"])._repr_html_().split("<details>")[0]
    assert shown == "<p><b>&lt;a&gt;.csv: pass</b></p>"


def test_a_draft_shows_what_was_understood_and_what_to_fill_in(tmp_path):
    file = tmp_path / "own.txt"
    file.write_text("Zeit [s];Reibkraft [N];Weg <x>\n0,0;1,5;0,1\n0,1;1,6;0,2\n")
    draft = tl.reading.draft_dialect(file)
    shown = draft._repr_html_()
    assert "friction_force" in shown and "decimal comma" in shown
    assert all(f"fill in line {line} of the TOML" in shown for line in draft.to_fill_in)
    assert "Weg &lt;x&gt;" in shown and "<x>" not in shown
    text = draft.toml.splitlines()
    assert text[text.index('source = "none"') + 1].startswith('# "position"')


def test_a_figure_is_shown_at_full_resolution_whatever_pyplot_does(monkeypatch):
    import IPython.display

    shown = []
    monkeypatch.setattr(IPython.display, "display", lambda data, raw: shown.append((data, raw)))
    curve = xr.Dataset(
        {"friction_coefficient": ("sliding_speed", [0.3, 0.4])}, {"sliding_speed": [1e-4, 1e-3]}
    )
    tl.plot.stribeck(measured=curve)._ipython_display_()
    [(data, raw)] = shown
    width = int.from_bytes(data["image/png"][16:20], "big")  # in the header of every PNG
    assert raw and width == pytest.approx(86 / 25.4 * 200, abs=1)


def test_a_figure_with_knobs_is_an_output_of_the_cell_and_follows_them(monkeypatch):
    import IPython.display
    import ipywidgets
    from matplotlib import pyplot

    shown, updated = [], []
    keep = {"display": shown, "update_display": updated}
    for name, calls in keep.items():
        monkeypatch.setattr(
            IPython.display, name, lambda data, calls=calls, **how: calls.append((data, how))
        )

    level = ipywidgets.FloatSlider(value=0.5, max=1.0)

    @tl.plot.knobs(level=level, where=["left", "right"])
    def draw(level=0.5, where="right"):
        figure, axes = pyplot.subplots()
        axes.axhline(level)
        axes.set_title(where)
        return figure

    (box, _), (first, how) = shown
    assert box["text/plain"].endswith("notebook: level = 0.5, where = right")
    assert first["image/png"].startswith(b"\x89PNG") and how["raw"]
    level.value = 0.9
    [(later, again)] = updated
    assert later != first and again["display_id"] == how["display_id"]
    assert pyplot.get_fignums() == []


def test_films_are_drawn_alike_from_a_list_and_from_one_dataset():
    contact = tl.LineContact("7 cm", "10 cm", "1.5 MPa", 0.5)
    films = [
        tl.lubrication.film_profile(contact, None, "1.4 Pa s", "310 N/m", v, cells=60)
        for v in (1e-3, 1e-2)
    ]
    rows = [f.reset_index("x").reset_coords("x").rename_dims(x="point") for f in films]
    joined = xr.concat(rows, "sliding_speed", combine_attrs="drop_conflicts")
    one, other = (tl.plot.figure_data(tl.plot.film_profiles(given)) for given in (films, joined))
    assert one.equals(other)


def test_the_logs_of_a_run_are_read_back_by_the_name_of_the_first(tmp_path):
    run = simulate_run("Sb-S", "dry", rig=Rig(Protocol(speeds=(1e-4, 1e-3))), seed=4)
    force, motion = tl.rig.write_run(run, tmp_path / "new" / "folder")
    found = tl.read(force)
    assert found.attrs["source"] == f"{force.name}; {motion.name}"
    written = set(run.force_log.friction_force.values.round(3))
    assert set(found.friction_force.values.round(3)) <= written


@pytest.mark.slow
def test_units_stand_beside_the_variables_in_what_jupyter_shows_first(tmp_path):
    code = (
        "import IPython, json\n"
        "shell = IPython.core.interactiveshell.InteractiveShell.instance()\n"
        "import tribolab, sys\n"
        "assert 'xarray' not in sys.modules\n"
        "import xarray as xr\n"
        "from tribolab.units.stamping import stamp\n"
        "data = {'friction_force': ('time', [1.0]), 'note': ('time', ['a'])}\n"
        "run = stamp(xr.Dataset(data, {'time': ('time', [0.0])}))\n"
        "run.time.attrs['units'] = '<s>'\n"
        "foreign = xr.Dataset({'air': ('time', [1.0], {'units': 'K', 'long_name': 'air'})})\n"
        "show = lambda data: shell.display_formatter.format(data)[0]['text/html']\n"
        "print(json.dumps([*map(show, [run, run.friction_force, foreign, foreign.air])]))"
    )
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", code],
        check=True, capture_output=True, text=True, env={**os.environ, "IPYTHONDIR": str(tmp_path)},
    )  # fmt: skip
    dataset, array, *foreign = json.loads(done.stdout)
    assert not [shown for shown in foreign if "K, float64" in shown or "[K]" in shown]
    types = re.findall(r"<div class='xr-var-dtype'>(.*?)</div>", dataset)
    assert types == ["&lt;s&gt;, float64", "N, float64", "&lt;U1"]
    assert "&#x27;friction_force&#x27; [N]" in array or "'friction_force' [N]" in array


def test_outcome_results_and_history_are_short_in_a_notebook(two_runs):
    outcome = tl.run_campaign(two_runs, jobs=1, figures="none")
    assert outcome._repr_html_().startswith(f"<p><b>{outcome.folder}: 2 runs, ")
    results = tl.read_results(outcome.folder)
    shown = results._repr_html_()
    assert f"{len(results)} tables</b>" in shown and ", sliding_speed_m_s, " in shown
    told = tl.comparison.history([outcome.folder])._repr_html_()
    assert re.match(r"<p><b>\d+ charts?</b></p><ul>", told)
