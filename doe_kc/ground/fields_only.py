"""What is sent to another process: the fields of a dataclass, not what it has computed of itself."""

from __future__ import annotations

from dataclasses import fields
from typing import Any


class FieldsOnly:
    """Base of dataclasses whose cached properties are large and soon computed again."""

    def __getstate__(self) -> dict[str, Any]:
        return {f.name: getattr(self, f.name) for f in fields(self)}  # type: ignore[arg-type]  # a dataclass


class CommonArgument(FieldsOnly):
    """Base of large dataclasses that are never changed and are arguments of many tasks: a process that had
    one before is not sent it again."""
