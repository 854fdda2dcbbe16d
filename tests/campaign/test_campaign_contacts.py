"""Several contacts in a campaign: a stiffness series, several balls."""

import re

import pytest

from tribolab.campaign.pipeline import process
from tribolab.campaign.settings.load import load_and_plan, load_campaign
from tribolab.core.errors import ConfigError
from tribolab.reading.netcdf.netcdf import read_netcdf
from tribolab.rig import Protocol, Rig, simulate_campaign

HEAD = """[campaign]
name = "a series"
[contact]
geometry = "ball"
radius = "9.5 mm"
poisson_ratio = 0.5
youngs_modulus = "2 MPa"
youngs_modulus_range = ["1.8 MPa", "2.2 MPa"]
modulus_file = "dma.csv"
[contact.soft]
youngs_modulus = "0.5 MPa"
[contact.large]
radius = "19 mm"
[[surface]]
name = "sphere"
[medium.oil]
viscosity = "0.1 Pa s"
"""


def written(folder, runs):
    (folder / "raw").mkdir(exist_ok=True)
    for name in ("a.csv", "b.csv", "dma.csv"):
        (folder / "raw" / name).write_text("")
    file = folder / "campaign.toml"
    file.write_text(HEAD + runs, "utf-8")
    return file


def run(name, contact=""):
    stated = f'contact = "{contact}"\n' if contact else ""
    return f'[[run]]\nfiles = "{name}.csv"\nsurface = "sphere"\nmedium = "oil"\n{stated}'


def test_a_named_contact_takes_over_what_it_leaves_out_but_not_another_rubbers_moduli(tmp_path):
    contacts = load_campaign(written(tmp_path, run("a", "soft"))).contact.by_name
    assert list(contacts) == ["", "soft", "large"]
    soft, large = contacts["soft"], contacts["large"]
    assert soft.whole().youngs_modulus == 5e5 and soft.whole().radius == 9.5e-3
    assert soft.youngs_modulus_range is None and soft.modulus_file is None
    assert large.whole().radius == 19e-3 and large.modulus_file == "dma.csv"
    assert large.youngs_modulus_range == (1.8e6, 2.2e6)


def test_a_run_is_filed_under_its_surface_and_contact(tmp_path):
    _, (a, b) = load_and_plan(written(tmp_path, run("a") + run("b", "soft")))
    assert (a.surface, b.surface) == ("sphere", "sphere, soft")
    _, (_, other) = load_and_plan(written(tmp_path, run("a") + run("b", "large")))
    assert other.config_sha256 != b.config_sha256
    assert other.reading_sha256 == b.reading_sha256  # the signals need not be read again


@pytest.mark.parametrize(
    ("runs", "words"),
    [
        (
            run("a", "sotf"),
            ["run 1, contact", "there is no [contact.sotf]", "did you mean", "soft"],
        ),
        (
            run("a") + '[contact.hard]\nradus = "1 mm"\n',
            ["contact.hard.radus", "unknown key", "'radius'"],
        ),
        (run("a") + "[contact.hard]\nradius = 3\n", ["contact.hard.radius", "no unit"]),
        (
            run("a") + '[contact.hard]\nmodulus_file = "x.csv"\n',
            ["contact.hard.modulus_file", "there is no file"],
        ),
    ],
    ids=["unknown contact", "unknown key", "no unit", "no file"],
)
def test_a_mistake_in_a_contact_is_named(tmp_path, runs, words):
    with pytest.raises(ConfigError) as error:
        load_campaign(written(tmp_path, runs))
    for word in words:
        assert word in str(error.value)


def test_a_mistyped_key_of_the_contact_is_no_table(tmp_path):
    file = written(tmp_path, run("a"))
    file.write_text(file.read_text("utf-8").replace("poisson_ratio", "poison_ratio"), "utf-8")
    with pytest.raises(ConfigError, match=r"contact\.poison_ratio: unknown key.*'poisson_ratio'"):
        load_campaign(file)


@pytest.mark.slow
def test_every_contact_has_its_own_curve_model_and_spectrum(tmp_path):
    rig = Rig(Protocol(speeds=(1e-5, 1e-4, 4.64e-4)))
    file = simulate_campaign(
        tmp_path / "c", 5, small=True, surfaces=("Sb-S",), n_scans=1, rig=rig, n_repeats=2
    )
    text = re.sub(
        r'\n\[\[run\]\]\nfiles = "[^"]*_dry_.*?(?=\n\[|\Z)', "", file.read_text("utf-8"), flags=re.S
    )
    entry = re.search(r"\[\[run\]\]\n.*?(?=\n\[|\Z)", text, flags=re.S)[0]
    name = re.search(r'files = "(.*)"', entry)[1]
    each = [
        entry.replace(name, name.replace("*", f"0{k}*")) + f'\ncontact = "{contact}"\n'
        for k, contact in ((1, "soft"), (2, "layer"))
    ]
    text = text.replace(entry, "\n\n".join(each))
    text += '\n[contact.soft]\nyoungs_modulus = "0.75 MPa"\n[contact.layer]\nthickness = "2 mm"\n'
    text += '[model]\nuncertainty = "none"\npoints = 9\nslowest = "1 um/s"\n'
    text += 'fastest = "1 mm/s"\njoint = false\n'
    file.write_text(text, "utf-8")
    made = process(load_campaign(file), tmp_path)
    names = ["Sb-S, soft", "Sb-S, layer"]
    assert [surface.name for surface in made.surfaces] == names
    assert sorted(curve.surface for curve in made.curves) == sorted(names)
    models = {model.surface: model for model in made.models}
    soft, layer = (read_netcdf(tmp_path / models[name].data_file, "curve") for name in names)
    assert soft.attrs["youngs_modulus_Pa"] == 0.75e6
    assert layer.attrs["youngs_modulus_Pa"] == 1.5e6
    widths = [
        float(read_netcdf(tmp_path / surface.data_file, "loads").contact_width[0])
        for surface in made.surfaces
    ]
    assert widths[0] > 1.4 * widths[1]  # softer, and not held by a base
