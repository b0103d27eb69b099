"""The static alignment of `test.toml` changed."""

from __future__ import annotations

import re
from collections.abc import Callable

from corruptions.edit import Corruption


def alignment(change: Callable[[str, str, float], float]) -> Callable[[str], str]:
    """change: side, angle, value -> value."""

    def edit(text: str) -> str:
        lines = []
        for line in text.split("\n"):
            side = re.match(r"(left|right) *=", line)
            if side is not None:
                line = re.sub(
                    r"(toe|camber|caster)_deg = ([-+.\d]+)",
                    lambda m, s=side: f"{m[1]}_deg = {change(s[1], m[1], float(m[2])):g}",  # type: ignore[misc]
                    line,
                )
            lines.append(line)
        return "\n".join(lines)

    return edit


def alignments() -> list[Corruption]:
    """Of signs, units, zeros and exchanged angles."""
    out: list[Corruption] = []
    out += [
        Corruption(
            "alignment: caster with its sign reversed",
            ("alignment",),
            "caster*",
            text=alignment(lambda s, a, v: -v if a == "caster" else v),
        ),
        Corruption(
            "alignment: caster 3 deg off",
            ("alignment",),
            "caster*",
            text=alignment(lambda s, a, v: v + 3.0 if a == "caster" else v),
        ),
        Corruption(
            "alignment: camber in minutes",
            ("alignment",),
            "camber*",
            text=alignment(lambda s, a, v: 60 * v if a == "camber" else v),
        ),
        Corruption(
            "alignment: right camber with its sign reversed",
            ("alignment",),
            "camber*",
            text=alignment(lambda s, a, v: -v if (s, a) == ("right", "camber") else v),
        ),
        Corruption(
            "alignment: toe 0.8 deg off",
            ("alignment",),
            "toe*",
            text=alignment(lambda s, a, v: v + 0.8 if a == "toe" else v),
        ),
        Corruption(
            "alignment: camber and caster exchanged",
            ("alignment",),
            "c*",
            text=lambda t: (
                t.replace("camber_deg", "x_deg")
                .replace("caster_deg", "camber_deg")
                .replace("x_deg", "caster_deg")
            ),
        ),
    ]
    return out
