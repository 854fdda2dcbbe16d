"""A TOML file of the user's, read and checked against its model: all that is wrong, at once."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from tribolab.campaign.settings import problems
from tribolab.errors import ConfigError

Model = TypeVar("Model", bound=BaseModel)


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
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError as error:
        raise ConfigError(f"{path}: there is no such file; {missing}") from error
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: cannot be read ({error}); it wants to be UTF-8") from error


def checked(
    path: Path, text: str, model: type[Model], kind: str
) -> tuple[Model | None, list[problems.Problem]]:
    """Return what a text says, or what is wrong with it.

    Parameters
    ----------
    path, text
        A file and its text.
    model
        What it has to say.
    kind
        What such a file is called.

    Raises
    ------
    ConfigError
        If it is no TOML.
    """
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        said = problems.toml_error(error, text, kind)
        raise ConfigError(f"{path}: not a TOML file: {said}") from error
    except (RecursionError, ValueError) as error:
        raise ConfigError(f"{path}: cannot be read: {problems.unreadable(error)}") from error
    try:
        return model.model_validate(content, context={"in_file": True}), []
    except ValidationError as error:
        return None, problems.from_pydantic(error, model)
