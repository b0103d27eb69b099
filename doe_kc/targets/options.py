"""The `[[characteristics]]` and `[[curves]]` tables of a study, and their names checked."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase
from typing import Annotated, Literal

from pydantic import Field

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.fields import Finite, NotNegative, Positive, Strict
from doe_kc.load_cases import LOAD_CASES

Goal = Literal["target", "minimize", "maximize"]


class CharacteristicOptions(Strict):
    """What differs for the characteristics whose id matches a glob; later entries win.

    target, sd: in place of the measured value and its standard error (a concept's requirement, another
    car's figure). objective, constraint: in place of Appendix B's flags. low, high: constraint interval
    in place of equations 5.1 and 5.2. goal: what the objective is: the distance to the target, or the
    value itself made small or large. linear, quadratic, norm: LinWt, QuadWt, Norm of the objective, those
    with `constraint_` of the constraint (equation 2.2). hold: false lets it move away from its target.
    relax: false insists on the interval though no design within the bounds reaches it.
    """

    match: str
    target: Finite | None = None
    sd: NotNegative | None = None
    objective: bool | None = None
    constraint: bool | None = None
    low: Finite | None = None
    high: Finite | None = None
    goal: Goal | None = None
    linear: NotNegative | None = None
    quadratic: NotNegative | None = None
    norm: Positive | None = None
    constraint_linear: NotNegative | None = None
    constraint_quadratic: NotNegative | None = None
    constraint_norm: Positive | None = None
    hold: bool | None = None
    relax: bool | None = None


class CurveOptions(Strict):
    """The same for whole curves, matched as `load_case.response` ("vertical.toe"); RMS by equation 2.1.

    hold: false lets the curve move away from the measured one.
    """

    match: str
    objective: bool | None = None
    linear: NotNegative | None = None
    quadratic: NotNegative | None = None
    norm: Positive | None = None
    hold: bool | None = None


Characteristics = Annotated[list[CharacteristicOptions], Field(default=[])]
Curves = Annotated[list[CurveOptions], Field(default=[])]


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
