"""Checks the names in a study's target tables."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.errors import InputError, nearest
from doe_kc.load_cases import LOAD_CASES
from doe_kc.targets.options import CharacteristicOptions, CurveOptions


def check_names(
    characteristics: Sequence[CharacteristicOptions], curves: Sequence[CurveOptions], source: str
) -> None:
    """InputError for an entry that fits no characteristic or curve."""
    lines = [f"{case}.{response}" for case in LOAD_CASES for response in RIG_RESPONSES]
    for what, options, known in (
        ("characteristics", characteristics, list(CHARACTERISTICS)),
        ("curves", curves, lines),
    ):
        for option in options:
            if not any(fnmatchcase(name, option.match) for name in known):
                raise InputError(
                    f"{source}: {what}: match = {option.match!r} fits none; expected an id or glob such as "
                    f"{known[0]} or {known[0].split('.')[0]}.*.{nearest(option.match, known)}"
                )
