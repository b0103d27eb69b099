"""The `[discovery]` table of a study."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from doe_kc.effects import EFFECTS
from doe_kc.ground.errors import InputError, nearest
from doe_kc.ground.fields import Strict


class DiscoveryOptions(Strict):
    """adopt: which effects `run` adds to the axle that it correlates: "auto" the named ones and the leading
    one of a class, "never" none, or a list of ids, of which those that are found are added.
    """

    adopt: Literal["auto", "never"] | list[str] = Field(default="auto")

    def check_names(self, source: str) -> None:
        """InputError for an id that is no effect."""
        for ident in self.adopt if isinstance(self.adopt, list) else ():
            if ident not in EFFECTS:
                raise InputError(
                    f"{source}: discovery.adopt: {ident!r} is no effect; known are {', '.join(EFFECTS)}."
                    f"{nearest(ident, EFFECTS)}"
                )
