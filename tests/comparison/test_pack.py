"""Deposits: what is packed can be read, checked and run again; a changed byte is seen."""

import json
import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import pandas as pd
import pytest
from campaigns import copied
from typer.testing import CliRunner

import tribolab as tl
from tribolab import cli
from tribolab.app.run import run_campaign
from tribolab.archive.packing import problems_of
from tribolab.core.provenance import sha256_of_file

NUMBERS = ("friction", "stribeck", "stick_slip", "static_friction", "sources")


@pytest.fixture(scope="module")
def deposit(original, tmp_path_factory):
    """A packed campaign with its raw files."""
    folder = tmp_path_factory.mktemp("deposit")
    return tl.archive.pack(
        original.parent / "results", folder / "a.zip", raw=True, licence="CC-BY-4.0"
    )


@pytest.fixture(scope="module")
def unpacked(deposit, tmp_path_factory):
    folder = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(deposit) as archive:
        archive.extractall(folder)
    return folder


@pytest.mark.slow
def test_an_unpacked_deposit_run_again_gives_the_same_tables(unpacked, tmp_path):
    elsewhere = shutil.copytree(unpacked, tmp_path / "elsewhere")
    run_campaign(elsewhere / "campaign.toml", jobs=1, figures="none")
    for name in NUMBERS:
        ours = (elsewhere / f"results/tables/{name}.csv").read_text("utf-8")
        assert ours == (elsewhere / f"published/tables/{name}.csv").read_text("utf-8"), name


def test_every_file_is_described_with_its_checksum(unpacked):
    crate = json.loads((unpacked / "ro-crate-metadata.json").read_text("utf-8"))
    parts = {part["@id"]: part for part in crate["@graph"]}
    root = parts["./"]
    assert parts["ro-crate-metadata.json"]["conformsTo"]["@id"].endswith("/ro/crate/1.2")
    for key in ("name", "description", "datePublished", "license", "author", "publisher"):
        assert root[key], key
    assert root["license"] == {"@id": "https://spdx.org/licenses/CC-BY-4.0"}
    files = {p.relative_to(unpacked).as_posix() for p in unpacked.rglob("*") if p.is_file()}
    assert {part["@id"] for part in root["hasPart"]} == files - {"ro-crate-metadata.json"}
    for name in files - {"ro-crate-metadata.json"}:
        part = parts[name]
        assert part["description"] and part["encodingFormat"]
        assert part["sha256"] == sha256_of_file(unpacked / name)
        assert int(part["contentSize"]) == (unpacked / name).stat().st_size
    kinds = [part["@type"] for part in parts.values()]
    assert kinds.count("CreateAction") == 2
    curve = pd.read_csv(unpacked / "published/tables/stribeck.csv")
    values = [part["value"] for part in parts.values() if part["@type"] == "PropertyValue"]
    assert values == pytest.approx(curve.friction_coefficient.tolist(), rel=1e-12)


def test_the_tables_are_as_the_data_package_says(unpacked):
    package = json.loads((unpacked / "datapackage.json").read_text("utf-8"))
    assert {"friction", "stribeck"} <= {one["name"] for one in package["resources"]}
    kinds = {"number": "fiu", "integer": "iu", "string": "OUT", "boolean": "b"}
    for resource in package["resources"]:
        table = pd.read_csv(unpacked / resource["path"], keep_default_na=False, na_values=[""])
        fields = resource["schema"]["fields"]
        assert [field["name"] for field in fields] == list(table)
        for field in fields:
            kind = table[field["name"]].dtype
            assert kind.kind in kinds[field["type"]] or pd.api.types.is_string_dtype(kind)
        assert resource["hash"] == f"sha256:{sha256_of_file(unpacked / resource['path'])}"


@pytest.mark.slow
def test_names_that_steer_a_terminal_reach_no_page_table_or_member_as_they_are(tmp_path):
    short = tl.rig.Rig(tl.rig.Protocol(speeds=(1e-4, 1e-3)))
    for path in tl.rig.write_run(tl.rig.simulate_run("Sb-S", "dry", rig=short), tmp_path / "raw"):
        path.rename(path.with_name(f"\x1b[31m\x07\n\x9b2J\u202e{path.name}"))
    file = tmp_path / "campaign.toml"
    file.write_text('[campaign]\nname = "one"\n[[run]]\nfiles = "*.csv"\n')
    results = run_campaign(file, jobs=1, figures="none").folder
    tl.archive.pack(results, tmp_path / "one.zip", raw=True, licence="CC-BY-4.0")
    steers = re.compile("[\x07\x1b\x9b\u202e]")
    texts = [path for path in results.rglob("*") if path.suffix in (".csv", ".html", ".json")]
    assert not [path for path in texts if steers.search(path.read_text("utf-8"))]
    sources = pd.read_csv(results / "tables/sources.csv")["file"]
    with zipfile.ZipFile(tmp_path / "one.zip") as archive:
        names = archive.namelist()
    assert all(name.isprintable() for name in [*names, *sources])
    assert set(sources) <= set(names)


def changed(deposit, target, name, how):
    """Copy a packed file with one member changed, left out, or added."""
    with zipfile.ZipFile(deposit) as old, zipfile.ZipFile(target, "w") as new:
        for info in old.infolist():
            content = old.read(info)
            if info.filename == name:
                if how == "lost":
                    continue
                content = content[:100] + bytes([content[100] ^ 1]) + content[101:]
            new.writestr(info.filename, content)
        if how == "added":
            new.writestr(name, "x")
    return target


@pytest.mark.parametrize(
    "how, name, says",
    [
        ("byte", "published/tables/friction.csv", "is not as it was packed"),
        ("byte", "campaign.toml", "is not as it was packed"),
        ("lost", "published/report.html", "is missing"),
        ("added", "notes.txt", "is not described"),
    ],
)
def test_what_changed_is_found(deposit, tmp_path, how, name, says):
    assert problems_of(deposit) == []
    target = changed(deposit, tmp_path / "b.zip", name, how)
    assert problems_of(target) == [f"{name} {says}"]
    done = CliRunner().invoke(cli.app, ["verify", str(target)])
    assert done.exit_code == 3 and says in done.stderr


def test_without_raw_files_their_checksums_go_along(original, tmp_path):
    target = tmp_path / "a.zip"
    words = ["pack", str(original.parent / "results"), "-o", str(target)]
    done = CliRunner().invoke(cli.app, words)
    assert done.exit_code == 0 and "no licence is stated" in done.stdout, done.output
    with zipfile.ZipFile(target) as archive:
        names = archive.namelist()
        assert not [name for name in names if name.startswith("raw/")]
        assert "published/tables/sources.csv" in names and "campaign.toml" in names
    assert CliRunner().invoke(cli.app, ["verify", str(target)]).exit_code == 0


def test_results_that_are_not_as_they_were_written_are_not_packed(original, tmp_path):
    file = copied(original, tmp_path)
    table = file.parent / "results/tables/stribeck.csv"
    table.write_text(table.read_text("utf-8") + "x\n", "utf-8")
    with pytest.raises(tl.TribolabError, match="not as it was written"):
        tl.archive.pack(file.parent / "results", tmp_path / "a.zip")
    file.write_text(file.read_text("utf-8") + "\n", "utf-8")
    with pytest.raises(tl.TribolabError, match="changed since these results were made"):
        tl.archive.pack(file.parent / "results", tmp_path / "a.zip")
    assert not list(tmp_path.glob("*a.zip*"))


# what the words of a deposit mean by RO-Crate 1.2: those of schema.org, but for two
_CONTEXT = "https://w3id.org/ro/crate/1.2/context"
_OTHERS = {
    "File": "http://schema.org/MediaObject",
    "conformsTo": "http://purl.org/dc/terms/conformsTo",
}
_KEEP = """
import io, sys, requests, requests_cache, urllib3
url, cache, content = sys.argv[1], sys.argv[2], sys.argv[3].encode()
told = requests.Response()
told.status_code, told.url, told._content = 200, url, content
told.headers["Content-Type"] = "application/ld+json"
given = {"status": 200, "preload_content": False, "request_url": url, "headers": told.headers}
told.raw = urllib3.HTTPResponse(io.BytesIO(content), **given)
told.request = requests.Request("GET", url).prepare()
requests_cache.CachedSession(cache_name=cache, expire_after=-1).cache.save_response(told)
"""


def terms_of(crate):
    """Return every name of a type or of a property that a deposit's description uses."""
    kinds = [part["@type"] for part in crate["@graph"]]
    words = {key for part in crate["@graph"] for key in part if not key.startswith("@")}
    return words | {kind for some in kinds for kind in ([some] if isinstance(some, str) else some)}


@pytest.fixture(scope="module")
def validated(unpacked, tmp_path_factory):
    """Give what the validator of RO-Crates says of a folder: whether it passes, and of what not.

    It reaches no network: the meaning of the words lies in its cache.
    """
    tool = shutil.which("rocrate-validator")
    if tool is None:
        pytest.skip("the validator of RO-Crates (pip install roc-validator) is not installed")
    crate = json.loads((unpacked / "ro-crate-metadata.json").read_text("utf-8"))
    assert crate["@context"][0] == _CONTEXT
    terms = {word: f"http://schema.org/{word}" for word in terms_of(crate)} | _OTHERS
    aside = tmp_path_factory.mktemp("validator")
    cache, answer = str(aside / "told"), aside / "answer.json"
    python = str(Path(tool).resolve().with_name("python"))
    content = json.dumps({"@context": terms})
    subprocess.run([python, "-c", _KEEP, _CONTEXT, cache, content], check=True)
    words = ["--no-interactive", "validate", "--offline", "--cache-path", cache]
    words += ["-l", "required", "-p", "ro-crate-1.2", "-f", "json", "-o", str(answer)]

    def validate(folder):
        subprocess.run([tool, *words, str(folder)], capture_output=True)
        said = json.loads(answer.read_text("utf-8"))
        return said["passed"], [issue["message"] for issue in said["issues"]]

    return validate


def test_the_validator_of_others_finds_no_violation(validated, unpacked):
    assert validated(unpacked) == (True, [])


def test_the_validator_of_others_sees_what_is_missing(validated, unpacked, tmp_path):
    (tmp_path / "broken").mkdir()
    for path in unpacked.iterdir():  # a link to each: nothing is copied
        if path.name != "ro-crate-metadata.json":
            (tmp_path / "broken" / path.name).symlink_to(path)
    crate = json.loads((unpacked / "ro-crate-metadata.json").read_text("utf-8"))
    (root,) = (part for part in crate["@graph"] if part["@id"] == "./")
    del root["datePublished"]
    target = tmp_path / "broken" / "ro-crate-metadata.json"
    target.write_text(json.dumps(crate), "utf-8")
    passed, said = validated(tmp_path / "broken")
    assert not passed and any("datePublished" in message for message in said)
