"""Public names of a package, loaded when first used: importing the package costs nothing."""

from __future__ import annotations

import ast
import importlib
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any


def loaded_on_use(
    package: str, file: str
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return ``__getattr__``, ``__dir__`` and ``__all__`` of a package.

    Its public names are those that the file imports for type checkers only, in the block
    ``if TYPE_CHECKING``; type checkers and users thus see the same names.

    Parameters
    ----------
    package, file
        ``__name__`` and ``__file__`` of the package.

    Examples
    --------
    >>> import tribolab.surface as surface
    >>> load, names, public = loaded_on_use("tribolab.surface", surface.__file__)
    >>> load("remove_form").__module__, "psd_1d" in names(), public == surface.__all__
    ('tribolab.surface.form', True, True)
    """
    homes = _imported_for_types(Path(file).read_text(encoding="utf-8"))

    def load(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module '{package}' has no attribute '{name}'")
        home = homes[name]
        if home == package:  # a module of the package
            return importlib.import_module(f"{package}.{name}")
        value = getattr(importlib.import_module(home), name)
        setattr(sys.modules[package], name, value)
        return value

    return load, lambda: sorted(homes), sorted(homes)


def _imported_for_types(source: str) -> dict[str, str]:
    """Return the module of each name imported in the block for type checkers."""
    block = next(
        node.body
        for node in ast.parse(source).body
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
    )
    return {
        alias.name: node.module or ""
        for node in block
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
