"""The variables of a campaign or correlation: which parameters move, between what bounds, in what steps."""

from __future__ import annotations

from doe_kc.variables.build import build_space
from doe_kc.variables.options import Change, VariableOptions
from doe_kc.variables.space import Space, Tie
from doe_kc.variables.variable import Variable

__all__ = ["Change", "Space", "Tie", "Variable", "VariableOptions", "build_space"]
