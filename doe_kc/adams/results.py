"""Results of an ADAMS run in XML (`.res`): columns by request and component.

`<StepMap>` names the components with their units and ids, each `<Step>` holds their values in the order of
the ids.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from doe_kc.adams.property_files import parsed_xml, xml_name
from doe_kc.adams.units import ANGLE_WORDS, FORCE_WORDS, LENGTH_WORDS
from doe_kc.ground.errors import InputError
from doe_kc.ground.files import read_bytes
from doe_kc.ground.typing import FloatArray

LARGEST_RESULT = 10_000_000
"""Numbers of a results file."""
UNIT_KINDS: Mapping[str, tuple[str, Mapping[str, float]]] = {
    "mm": ("length", LENGTH_WORDS),
    "deg": ("angle", ANGLE_WORDS),
    "N": ("force", FORCE_WORDS),
}
"""Unit of this project -> kind of the file's, and its words."""


@dataclass(frozen=True)
class AdamsResult:
    """values: `request.component`, lower case, to (n,) as they stand. units: the words they are in, empty
    where only `defaults` (by kind) say it."""

    path: Path
    values: Mapping[str, FloatArray]
    units: Mapping[str, str]
    defaults: Mapping[str, str]

    def column(self, name: str, unit: str) -> FloatArray:
        """(n,) in mm, deg or N; InputError when there is no such component, or its unit is unknown."""
        if name not in self.values:
            raise InputError(f"{self.path}: has no request {name}; add it to the run.")
        kind, words = UNIT_KINDS[unit]
        word = (self.units[name] or self.defaults.get(kind, "")).lower()
        if word not in words:
            raise InputError(
                f"{self.path}: {name} is in {word!r}, expected a unit of {kind}: {', '.join(words)}."
            )
        return self.values[name] * words[word]


def read_result(path: Path) -> AdamsResult:
    """An XML results file; InputError for text results, for one that is cut off, or that holds no step."""
    content = read_bytes(path, "results file (.res)")
    if not content.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        raise InputError(f"{path}: is no XML; let ADAMS write its results as XML (output / xrf).")
    root = parsed_xml(content, path)
    maps = [e for e in root.iter() if xml_name(e.tag) == "StepMap"]
    if len(maps) != 1:
        raise InputError(f"{path}: has {len(maps)} elements StepMap, expected one of one analysis.")
    names, units = _components(maps[0], path)
    steps = [e for e in root.iter() if xml_name(e.tag) == "Step"]
    rows = [_numbers(step, len(names), path) for step in steps]
    if not rows or len(rows) * len(names) > LARGEST_RESULT:
        raise InputError(
            f"{path}: holds {len(rows)} steps; expected at least one, and no more than a few thousand."
        )
    table = np.array(rows)
    defaults = next((dict(e.attrib) for e in root.iter() if xml_name(e.tag) == "Units"), {})
    return AdamsResult(path, dict(zip(names, table.T, strict=True)), units, defaults)


def _components(step_map: ElementTree.Element, path: Path) -> tuple[list[str], dict[str, str]]:
    """Names in the order of the ids, and their units."""
    entries = []
    for entity in (e for e in step_map if xml_name(e.tag) == "Entity"):
        for component in (e for e in entity if xml_name(e.tag) == "Component"):
            name = f"{entity.get('name', '')}.{component.get('name', '')}".lower()
            number = component.get("id", "")
            if not number.isdecimal() or len(number) > 9:
                raise InputError(f"{path}: component {name} has the id {number[:20]!r}, expected a number.")
            entries.append((int(number), name, component.get("unitsValue", "")))
    entries.sort()
    if len({name for _, name, _ in entries}) < len(entries) or len({i for i, _, _ in entries}) < len(entries):
        raise InputError(f"{path}: names a component or an id twice; expected each once.")
    return [name for _, name, _ in entries], {name: unit for _, name, unit in entries}


def _numbers(step: ElementTree.Element, count: int, path: Path) -> list[float]:
    words = (step.text or "").split()
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        numbers = []
    if len(numbers) != count or not np.all(np.isfinite(numbers)):
        raise InputError(
            f"{path}: a step has {len(words)} values, expected {count} finite numbers. Is the file cut off?"
        )
    return numbers
