"""Reading of settings in TOML; all errors are reported at once."""

from __future__ import annotations

import multiprocessing
import tomllib
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import BaseModel, ValidationError

from tribolab.campaign.settings import problems
from tribolab.core.errors import ConfigError, ReadError, shown
from tribolab.core.limit import Limit
from tribolab.core.provenance import escape_controls
from tribolab.core.untyped import Json
from tribolab.reading.raw.source import check_regular

MOST_TABLES = Limit(
    10_000.0, "1", "tables [[run]] and the like in a file: 150 000 take 40 s to be understood"
)
MOST_ENTRIES = Limit(
    50_000.0, "1", "keys and items of lists in a file: 100 000 unknown ones take 5 s to be named"
)
LARGEST = Limit(8e6, "byte", "a file: 10 000 runs take 3 MB, and 40 MB of comments 12 s")
SettingsModel = TypeVar("SettingsModel", bound=BaseModel)


def text_of(path: Path, missing: str) -> str:
    """Return the text of a file.

    Parameters
    ----------
    path
        The file.
    missing
        What to do if there is none.

    Raises
    ------
    ConfigError
        If it cannot be read.
    """
    try:
        if path.exists():
            check_regular(path)
            if (size := path.stat().st_size) > LARGEST.value:
                raise ConfigError(
                    f"{path}: {size / 1e6:.0f} MB are more than the {LARGEST.value / 1e6:.0f} MB "
                    "that settings may have; is it the right file?"
                )
        return path.read_text(encoding="utf-8-sig")
    except ReadError as error:
        raise ConfigError(error) from error
    except FileNotFoundError as error:
        raise ConfigError(f"{path}: there is no such file; {missing}") from error
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: cannot be read ({error}); it wants to be UTF-8") from error


@dataclass(frozen=True)
class Opened(Generic[SettingsModel]):
    """Settings file that was read and is valid."""

    path: Path
    text: str
    content: SettingsModel

    def error(self, wrong: list[problems.SettingsProblem]) -> ConfigError:
        """Return an error with file and line for problems found later."""
        return ConfigError(problems.message(wrong, self.path, self.text))


def settings_path(path: str | Path, name: str) -> Path:
    """Return the path of a settings file, given itself or the folder that contains it."""
    path = Path(path)
    return (path / name if path.is_dir() else path).absolute()


def open_settings(
    path: Path,
    model: type[SettingsModel],
    kind: str,
    missing: str = "",
    update: Callable[[Json], list[str]] | None = None,
) -> Opened[SettingsModel]:
    """Read a file and check it against its model.

    Parameters
    ----------
    path
        The file.
    model
        Pydantic model of the content.
    kind
        Kind of the file in words, for messages.
    missing
        What to do if there is none.
    update
        Function that moves old keys to their present place and returns a line for each.

    Raises
    ------
    ConfigError
        If anything in it is wrong: the message has the file, the line, the key and the cure.
    """
    text = text_of(path, missing)
    if (tables := text.count("\n[[")) > MOST_TABLES.value:
        raise ConfigError(
            f"{path}: {tables} tables such as [[run]] are more than {MOST_TABLES.value:.0f}; name "
            "many runs by one pattern, or make several campaigns"
        )
    content: dict[str, object]
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        reason = problems.toml_error(error, text, kind)
        raise ConfigError(f"{path}: not a TOML file: {reason}") from error
    except (RecursionError, ValueError) as error:
        raise ConfigError(f"{path}: cannot be read: {problems.unreadable(error)}") from error
    _check_entries(path, content)
    if update is not None:
        _warn(path, update(content))
    try:
        return Opened(path, text, model.model_validate(content, context={"in_file": True}))
    except ValidationError as error:
        wrong = problems.from_pydantic(error, model)
        raise ConfigError(problems.message(wrong, path, text)) from error


def _warn(path: Path, lines: list[str]) -> None:
    """Warn of old keys, in the main process only."""
    if multiprocessing.parent_process() is None:
        for line in lines:
            warnings.warn(f"{path}: {line}", FutureWarning, stacklevel=5)


def _check_entries(path: Path, content: dict[str, object]) -> None:
    """Raise if there are too many entries, or texts with control characters."""
    count = 0
    left: list[tuple[str, object]] = list(content.items())
    while left:
        key, value = left.pop()
        count += 1
        for text in (key, value):
            if isinstance(text, str) and escape_controls(text) != text:
                raise ConfigError(
                    f"{path}: {shown(key)} = '{shown(value)}' contains a control character (shown "
                    "as ?); write it without"
                )
        if isinstance(value, dict):
            left += value.items()
        elif isinstance(value, list):
            left += [(key, item) for item in value]
        if count + len(left) > MOST_ENTRIES.value:
            raise ConfigError(
                f"{path}: more than {MOST_ENTRIES.value:.0f} keys and items of lists; name many "
                "runs by one pattern, or make several campaigns"
            )
