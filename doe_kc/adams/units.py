"""The `[UNITS]` block of an ADAMS file: words to factors."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from doe_kc.adams.teim_orbit import TeimOrbitFile
from doe_kc.ground.errors import InputError, nearest

LENGTH_WORDS = {
    **dict.fromkeys(("mm", "millimeter", "millimeters"), 1.0),
    **dict.fromkeys(("cm", "centimeter", "centimeters"), 10.0),
    **dict.fromkeys(("m", "meter", "meters"), 1000.0),
    **dict.fromkeys(("inch", "in", "inches"), 25.4),
    **dict.fromkeys(("foot", "ft", "feet"), 304.8),
}
FORCE_WORDS = {
    **dict.fromkeys(("newton", "n"), 1.0),
    **dict.fromkeys(("knewton", "kn", "kilo_newton"), 1000.0),
    **dict.fromkeys(("pound_force", "lbf"), 4.4482216152605),
    **dict.fromkeys(("kilogram_force", "kgf"), 9.80665),
}
ANGLE_WORDS = {
    **dict.fromkeys(("deg", "degree", "degrees"), 1.0),
    **dict.fromkeys(("rad", "radian", "radians"), 180.0 / math.pi),
}


@dataclass(frozen=True)
class FileUnits:
    """Factors of a file's units: to mm, N and deg."""

    length: float
    force: float
    angle: float

    @property
    def torque(self) -> float:
        """To Nm."""
        return self.force * self.length / 1000.0


def file_units(file: TeimOrbitFile) -> FileUnits:
    """Units of a file; InputError when it states none, or a word is unknown."""
    block = file.one("UNITS")

    def factor(key: str, words: Mapping[str, float]) -> float:
        cell = file.cell(block, key)
        if cell.text.lower() not in words:
            raise InputError(
                f"{file.path}: line {cell.line}: {key} is {cell.text!r}, expected one of "
                f"{', '.join(words)}.{nearest(cell.text.lower(), words)}"
            )
        return words[cell.text.lower()]

    return FileUnits(
        factor("LENGTH", LENGTH_WORDS), factor("FORCE", FORCE_WORDS), factor("ANGLE", ANGLE_WORDS)
    )
