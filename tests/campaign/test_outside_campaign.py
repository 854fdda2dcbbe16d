"""A campaign file of others writes in its own folder only; what it reads elsewhere is named."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from tribolab.app.run import run_campaign
from tribolab.cli import app
from tribolab.core.errors import ConfigError

FORCE = "# Linear slider, force log\nTime [s],Fx [N],Fz [N]\n" + "".join(
    f"{n / 10},0.5,31.0\n" for n in range(300)
)


@pytest.fixture
def campaign(tmp_path):
    (tmp_path / "home" / "raw").mkdir(parents=True)
    (tmp_path / "elsewhere").mkdir()
    for folder in ("home/raw", "home", "elsewhere"):
        (tmp_path / folder / "a.csv").write_text(FORCE)

    def write(files: str = "a.csv", **said: str) -> Path:
        keys = "".join(f'{key} = "{value}"\n' for key, value in said.items())
        file = tmp_path / "home" / "campaign.toml"
        file.write_text(f'[campaign]\nname = "x"\n{keys}[[run]]\nfiles = "{files}"\n')
        return file

    return write


def run(*words) -> tuple[int, str]:
    answer = CliRunner().invoke(app, ["run", *map(str, words), "-q", "-j", "1"])
    return answer.exit_code, " ".join(answer.output.split())


@pytest.mark.parametrize("place", ["..", "../../..", "../elsewhere/new", "/tmp/new", "link/new"])
def test_results_outside_of_the_campaigns_folder_want_a_word_of_the_user(place, campaign):
    file = campaign(output=place)
    (file.parent / "link").symlink_to(file.parents[1] / "elsewhere")
    before = sorted(file.parents[1].rglob("*"))
    code, said = run(file)
    assert code == 2 and f"campaign.output = '{place}'" in said
    assert "--output or --i-know" in said
    with pytest.raises(ConfigError, match="outside=True"):
        run_campaign(file)
    assert sorted(file.parents[1].rglob("*")) == before


def test_with_that_word_they_are_written(campaign):
    file = campaign(output="../elsewhere/new")
    assert run(file, "--i-know")[0] != 2
    assert (file.parents[1] / "elsewhere/new/report.json").is_file()


def test_i_know_does_not_open_a_folder_with_files_of_others(campaign):
    code, said = run(campaign(output="../elsewhere"), "--i-know")
    assert code == 2 and "holds something else than results" in said


@pytest.mark.parametrize("files", ["../../elsewhere/*.csv", "{}/elsewhere/a.csv", "link.csv"])
def test_raw_files_from_elsewhere_are_named(files, campaign, tmp_path):
    file = campaign(files.format(tmp_path))
    (file.parent / "raw/link.csv").symlink_to(tmp_path / "elsewhere/a.csv")
    assert (
        f"reads 1 file outside of its own folder and that of campaign.raw: {tmp_path}"
        in (run(file)[1])
    )
    assert "outside" not in run(file, "--i-know")[1]


@pytest.mark.parametrize(
    ("files", "raw"), [("../*.csv", "raw"), ("a.csv", "../elsewhere"), ("a.csv", "raw")]
)
def test_files_beside_the_raw_ones_and_a_raw_folder_elsewhere_are_the_campaigns(
    files, raw, campaign
):
    assert "outside" not in run(campaign(files, raw=raw))[1]
