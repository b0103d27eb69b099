"""Faults of a TOML file as one sentence for the user."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from pathlib import Path
from types import UnionType
from typing import Any, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from doe_kc.ground.errors import InputError, nearest


def refuse_unknown(path: Path, data: Mapping[str, Any], model: type[BaseModel], prefix: str = "") -> None:
    """InputError for a key that `model` does not know, with the nearest known one.

    Where a model allows further keys, only those are refused that look like a known key misspelt.
    """
    known = list(model.model_fields)
    for key, value in data.items():
        if key not in known:
            if _tolerated(key, known, model):
                continue
            raise InputError(
                f"{path}: key {prefix}{key} is unknown, expected one of {', '.join(known)};"
                f"{nearest(key, known)} Rename or delete it."
            )
        inner = _submodel(model.model_fields[key].annotation)
        if inner is not None and isinstance(value, dict):
            refuse_unknown(path, value, inner, f"{prefix}{key}.")


def _tolerated(key: str, known: list[str], model: type[BaseModel]) -> bool:
    misspelt = bool(difflib.get_close_matches(key, known, n=1, cutoff=0.8))
    return model.model_config.get("extra") == "allow" and not misspelt


def _submodel(annotation: Any) -> type[BaseModel] | None:
    options = get_args(annotation) if get_origin(annotation) in (Union, UnionType) else (annotation,)
    for option in options:
        if isinstance(option, type) and issubclass(option, BaseModel):
            return option
    return None


def sentence(path: Path, error: ValidationError) -> str:
    """The first fault of a validation error: file, key, what was expected, what to do."""
    fault = error.errors(include_url=False)[0]
    if fault["type"] == "value_error":
        return f"{path}: {fault['ctx']['error']}."
    key = ".".join(str(part) for part in fault["loc"])
    if fault["type"] == "missing":
        return f"{path}: key {key} is missing; expected it in the file, add it."
    expected = fault["msg"].removeprefix("Input should be ").removeprefix("Value error, ")
    return f"{path}: key {key} = {_short(fault['input'])}, expected {expected}; correct the value."


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."
