"""A TOML file with settings, read into a model that says what may stand there."""

import tomllib
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from serendipity.model import InputError

Held = TypeVar("Held", bound=BaseModel)


def read_settings(file: Path, model: type[Held]) -> Held:
    """What a file holds.

    Raises:
        InputError: it can't be read, is no TOML, or holds something else; it says what and where.
    """
    try:
        return model.model_validate(tomllib.loads(file.read_text(encoding="utf-8-sig")))
    except OSError as error:
        raise InputError(f"can't be read: {(error.strerror or '').lower()}", file) from None
    except UnicodeDecodeError:
        raise InputError("expected a text in UTF-8", file) from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"expected TOML: {str(error)[:1].lower()}{str(error)[1:]}", file) from None
    except RecursionError:
        raise InputError("is nested too deeply", file) from None
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"]))
        said = first["msg"][:1].lower() + first["msg"][1:]
        raise InputError(f"{where}: {said}", file) from None
