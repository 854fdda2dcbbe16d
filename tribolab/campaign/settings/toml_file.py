"""A TOML file of the user's, read and checked against its model: all that is wrong, at once."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from pydantic import BaseModel, ValidationError

from tribolab.campaign.settings import problems
from tribolab.core.limit import Limit
from tribolab.errors import ConfigError, ReadError
from tribolab.reading.raw.source import check_regular

MOST_TABLES = Limit(
    10_000.0, "1", "tables [[run]] and the like in a file: 150 000 take 40 s to be understood"
)
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
        return path.read_text(encoding="utf-8-sig")
    except ReadError as error:
        raise ConfigError(error) from error
    except FileNotFoundError as error:
        raise ConfigError(f"{path}: there is no such file; {missing}") from error
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: cannot be read ({error}); it wants to be UTF-8") from error


@dataclass(frozen=True)
class Opened(Generic[SettingsModel]):
    """A file that says what its model wants."""

    path: Path
    text: str
    content: SettingsModel

    def error(self, wrong: list[problems.SettingsProblem]) -> ConfigError:
        """Return what is still wrong with it, by file and line."""
        return ConfigError(problems.message(wrong, self.path, self.text))


def settings_path(path: str | Path, name: str) -> Path:
    """Return the file that is meant by itself, or by the folder in which it has its usual name."""
    path = Path(path)
    return (path / name if path.is_dir() else path).absolute()


def open_settings(
    path: Path, model: type[SettingsModel], kind: str, missing: str = ""
) -> Opened[SettingsModel]:
    """Read a file and check it against its model.

    Parameters
    ----------
    path
        The file.
    model
        What it has to say.
    kind
        What such a file is called.
    missing
        What to do if there is none.

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
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        said = problems.toml_error(error, text, kind)
        raise ConfigError(f"{path}: not a TOML file: {said}") from error
    except (RecursionError, ValueError) as error:
        raise ConfigError(f"{path}: cannot be read: {problems.unreadable(error)}") from error
    try:
        return Opened(path, text, model.model_validate(content, context={"in_file": True}))
    except ValidationError as error:
        wrong = problems.from_pydantic(error, model)
        raise ConfigError(problems.message(wrong, path, text)) from error
