"""Every public function says what it takes, and shows by an example that runs what it gives.

The examples themselves run with the suite (``--doctest-modules``).
"""

import doctest
import inspect
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

import tribolab as tl
from tribolab.studies import xu2026

PROJECT = Path(__file__).resolve().parents[2]


def public():
    """Yield name and object of everything public that can be called."""
    groups = [value for name in tl.__all__ if isinstance(value := getattr(tl, name), ModuleType)]
    for home in (tl, *groups, xu2026):
        names = getattr(home, "__all__", None) or [
            name
            for name, thing in vars(home).items()
            if not name.startswith("_") and getattr(thing, "__module__", "") == home.__name__
        ]
        for name in names:
            thing = getattr(home, name)
            if callable(thing):
                yield f"{home.__name__}.{name}", thing


PUBLIC = dict(public())
every = pytest.mark.parametrize("name", PUBLIC)


@every
def test_a_public_name_has_an_example_that_shows_a_value(name):
    examples = doctest.DocTestParser().get_examples(PUBLIC[name].__doc__ or "")
    assert any(example.want for example in examples)


@every
def test_a_docstring_names_every_parameter(name):
    thing = PUBLIC[name]
    if isinstance(thing, type) and issubclass(thing, BaseException | tuple):
        return
    text = inspect.getdoc(thing) or ""
    missing = [one for one in inspect.signature(thing).parameters if one not in text]
    assert missing == []


def test_the_suite_runs_the_examples():
    options = tomllib.loads((PROJECT / "pyproject.toml").read_text())["tool"]["pytest"]
    assert "tribolab" in options["ini_options"]["testpaths"]
    assert "--doctest-modules" in options["ini_options"]["addopts"].split()
    homes = {inspect.getmodule(thing).__file__ for thing in PUBLIC.values()}
    assert all(Path(home).is_relative_to(PROJECT / "tribolab") for home in homes)
