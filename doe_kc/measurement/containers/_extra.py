"""What the readers of binary containers share: extras that may be missing, channels of one length."""

from __future__ import annotations

import importlib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.channels import Heading
from doe_kc.measurement.tables import ArrayTable


def extra(module: str, name: str, path: Path) -> Any:
    """A module of an optional extra; InputError that says how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError:
        raise InputError(
            f'{path}: needs the package {module}, which is not installed; `pip install "doe-kc[{name}]"`, or '
            "export the record as CSV."
        ) from None


def array_table(label: str, channels: Sequence[tuple[Heading, FloatArray]]) -> ArrayTable:
    """Those of the commonest length, which are the samples; InputError where there are none."""
    sizes = Counter(values.size for _, values in channels)
    if not sizes:
        raise InputError(
            f"{label}: holds no channel of numbers; expected one array a channel, export it again."
        )
    size = max(sizes, key=lambda n: (sizes[n], n))
    kept = [(heading, values) for heading, values in channels if values.size == size]
    return ArrayTable(label, tuple(h for h, _ in kept), tuple(v for _, v in kept))
