"""Design variables of an axle, with nominal value, bounds and step of each."""

from __future__ import annotations

from dataclasses import dataclass

from doe_kc.axle.model import Axle
from doe_kc.axle.parameter_kinds import (
    PRODUCTION_SD,
    PRODUCTION_SHARE,
    SWITCHES,
    Group,
    ParameterKind,
    Quantity,
    is_lateral,
    quantity_of,
    side_prefix,
)
from doe_kc.axle.parameters import parameter_value
from doe_kc.axle.structure_parameters import structure_kinds


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """A design variable of one axle.

    nominal, lower, upper: absolute, in `unit` ("-" for factors). step: one-at-a-time change, absolute.
    active: False when the axle's model does not contain it (for example the radius of a rigid arm).
    """

    path: str
    label: str
    group: Group
    unit: str
    nominal: float
    lower: float
    upper: float
    step: float
    active: bool

    @property
    def quantity(self) -> Quantity:
        """What it measures; of a path that is not declared, by its last name."""
        return quantity_of(self.path)

    @property
    def one_sided(self) -> bool:
        """Whether it is at its lower limit of zero, and can only be raised."""
        return self.lower == 0.0 and self.nominal < self.step

    @property
    def mirrored(self) -> bool:
        """Whether the right side has the opposite sign in the chassis frame."""
        return is_lateral(self.path.removeprefix(side_prefix(self.path)))

    @property
    def in_model(self) -> bool:
        """Whether the axle's model contains it: not where a zero value switches it off."""
        return self.active and not (self.path in SWITCHES and self.nominal == 0.0)

    @property
    def production_sd(self) -> float:
        """One standard deviation between cars of one design, in its unit; 0 for one that does not scatter."""
        if not self.active:
            return 0.0
        share = PRODUCTION_SHARE.get(self.quantity, 0.0)
        return PRODUCTION_SD.get(self.quantity, share * abs(self.nominal))


def design_parameters(axle: Axle) -> list[Parameter]:
    """Every design variable of Table 1 and Appendix A, in their order; followers only when freed."""
    kinds = structure_kinds(axle.topology.structure, axle.labels)
    return [
        _parameter(axle, path, kind) for path, kind in kinds.items() if path.split(".")[0] not in axle.follow
    ]


def _parameter(axle: Axle, path: str, kind: ParameterKind) -> Parameter:
    nominal = parameter_value(axle, path)
    if kind.relative:
        lower, upper = (nominal * s for s in kind.span)
        step = abs(nominal) * kind.step
    else:
        lower, upper, step = nominal + kind.span[0], nominal + kind.span[1], kind.step
    if kind.bounds == "absolute":
        lower, upper = kind.span
    return Parameter(
        path=path,
        label=kind.label,
        group=kind.group,
        unit=kind.unit,
        nominal=nominal,
        lower=lower,
        upper=upper,
        step=step,
        active=is_active(axle, path),
    )


def is_active(axle: Axle, path: str) -> bool:
    """Whether the axle's equations contain the parameter."""
    if path in {"strut.bending", "strut.torsion"}:
        return axle.topology.strut_bending
    if path.startswith("steer_arm.") or path.split(".")[0] == "SAH":
        return axle.topology.steer_arm
    if path.startswith("arb.") and path != "arb.rate":
        return axle.values["arb.rate"] > 0
    return True
