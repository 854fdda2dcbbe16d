"""Old import paths of modules that have moved; they work for one release, with a warning."""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.util
import sys
import warnings
from collections.abc import Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType

MOVED = {
    "tribolab.across.compare": "tribolab.comparison.comparison",
    "tribolab.across.history": "tribolab.comparison.instrument_history",
    "tribolab.across.repeatability": "tribolab.comparison.repeat_study",
    "tribolab.across": "tribolab.comparison",
    "tribolab.conditions": "tribolab.arrays.conditions",
    "tribolab.deposit.pack": "tribolab.archive.packing",
    "tribolab.deposit": "tribolab.archive",
    "tribolab.errors": "tribolab.core.errors",
    "tribolab.friction.statistics": "tribolab.friction.mean_error.estimates",
    "tribolab.mode": "tribolab.regime",
    "tribolab.several": "tribolab.arrays.broadcasting",
    "tribolab.stamping": "tribolab.units.stamping",
    "tribolab.surface.abel": "tribolab.surface.spectra.abel",
    "tribolab.surface.psd": "tribolab.surface.spectra.psd",
    "tribolab.validity": "tribolab.core.validity",
    "tribolab.quantities": "tribolab.units.quantities",
}


class _MovedModules(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Import finder that loads a moved module from its new path."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        return importlib.util.spec_from_loader(fullname, self) if new_path(fullname) else None

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        new = new_path(spec.name)
        warnings.warn(f"{spec.name} is now {new}", FutureWarning, stacklevel=2)
        self._spec = importlib.import_module(new).__spec__
        return sys.modules[new]

    def exec_module(self, module: ModuleType) -> None:
        module.__spec__ = self._spec  # the import system has just set the old path here


def new_path(old: str) -> str:
    """Return the new path of a moved module; "" if it has not moved.

    Examples
    --------
    >>> new_path("tribolab.across.compare")
    'tribolab.comparison.comparison'
    >>> new_path("tribolab.friction")
    ''
    """
    for before, now in MOVED.items():
        if old == before or old.startswith(f"{before}."):
            return now + old.removeprefix(before)
    return ""


def accept_old_paths() -> None:
    """Make the old import paths of moved modules work.

    The finder is placed first: the usual finder would load the modules in the new folder of a moved
    package a second time, under their old path.
    """
    if not any(isinstance(finder, _MovedModules) for finder in sys.meta_path):
        sys.meta_path.insert(0, _MovedModules())
