"""Reading and validating user files with messages that name file, key, expectation and remedy."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from doe_kc.ground.errors import InputError, nearest

Model = TypeVar("Model", bound=BaseModel)
EXCEL_SIGNATURES = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")


def read_bytes(path: Path, what: str) -> bytes:
    """Content of a file; InputError when it cannot be read."""
    try:
        if Path(path).exists() and not (Path(path).is_file() or Path(path).is_dir()):
            raise InputError(f"{path}: is a pipe or a device, expected a {what} on a disk; name that.")
        return Path(path).read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such {what}; check the path.") from None
    except IsADirectoryError:
        raise InputError(f"{path}: is a folder, expected a {what}; name the file in it.") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path}: the {what} cannot be read ({reason}).") from None


def read_toml(path: Path) -> dict[str, Any]:
    """Parsed TOML; InputError with line and column for a syntax error."""
    content = read_bytes(path, "TOML file")
    if content.startswith(EXCEL_SIGNATURES):
        raise InputError(f"{path}: is an Excel workbook, expected a TOML text file.")
    try:
        return tomllib.loads(content.decode("utf-8-sig"))  # Notepad puts a mark before it
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not UTF-8 text; save it as UTF-8.") from None
    except (ValueError, RecursionError) as error:  # TOMLDecodeError; plain for a number of 5000 digits
        raise InputError(f"{path}: is not valid TOML: {error}. Mend that place in the file.") from None


def validate(model: type[Model], document: Mapping[str, Any], source: str) -> Model:
    """The checked document; InputError that lists every wrong key in words."""
    try:
        return model.model_validate(dict(document))
    except ValidationError as error:
        lines = [_sentence(e, model) for e in error.errors()]
        head = f"{source}: " + lines[0]
        more = "".join(f"\n{source}: {line}" for line in lines[1:5])
        rest = len(lines) - 5
        tail = f"\n{source}: and {rest} more of the kind." if rest > 0 else ""
        raise InputError(head + more + tail) from None


def _sentence(error: Any, model: type[BaseModel]) -> str:
    keys = [str(part) for part in error["loc"]]
    where = ".".join(keys) or "the file"
    kind = error["type"]
    if kind == "missing":
        return f"key {where} is missing; add it."
    if kind == "extra_forbidden":
        known = _siblings(model, keys)
        hint = nearest(keys[-1], known) or (f" Known there: {', '.join(known)}." if known else "")
        return f"key {where} is unknown; remove or rename it.{hint}"
    if kind == "literal_error":
        return f"{where} is {error['input']!r}, expected {error['ctx']['expected']}."
    if kind == "finite_number":
        return f"{where} is {error['input']}, expected a finite number."
    if kind in {"greater_than", "greater_than_equal", "less_than", "less_than_equal"}:
        symbol = {"greater_than": ">", "greater_than_equal": ">=", "less_than": "<"}.get(kind, "<=")
        bound = next(iter(error["ctx"].values()))
        return f"{where} is {error['input']}, expected a number {symbol} {bound:g}."
    if kind == "value_error":
        return f"{where}: {error['ctx']['error']}."
    return f"{where} is {_short(error['input'])}: {error['msg'][0].lower()}{error['msg'][1:]}."


def _short(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _siblings(model: type[BaseModel], keys: list[str]) -> list[str]:
    current: type[BaseModel] | None = model
    for key in keys[:-1]:
        field = current.model_fields.get(key) if current is not None else None
        annotation = field.annotation if field is not None else None
        current = annotation if isinstance(annotation, type) and issubclass(annotation, BaseModel) else None
    fields = current.model_fields if current is not None else {}
    return [field.alias or name for name, field in fields.items()]
