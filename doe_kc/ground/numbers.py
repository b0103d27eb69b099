"""Numbers rounded for reading: no more digits than their uncertainty bears."""

from __future__ import annotations

import math

MOST_DECIMALS = 7
"""Of a number that is read: a nanometre of a millimetre, a tenth of a microdegree."""
SD_DIGITS = 2
"""Significant digits of a standard deviation, to the last of which its value is written: two at most are
usual (JCGM 100:2008, Guide to the expression of uncertainty in measurement, 7.2.6)."""


def short(value: float) -> str:
    """Four significant digits without an exponent for ordinary sizes."""
    if not math.isfinite(value):
        return "–"
    digits = max(0, min(5, 3 - math.floor(math.log10(abs(value))))) if value else 0
    return f"{value:.{digits}f}"


def number(value: float, digits: int = 3) -> str:
    """Significant digits for reading, without an exponent for ordinary sizes."""
    if not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    places = digits - 1 - math.floor(math.log10(abs(value)))
    if places < -3 or places > 6:
        return f"{value:.{digits}g}"
    return f"{round(value, places):.{max(0, places)}f}"


def decimals(sd: float) -> int | None:
    """Decimals that show the last significant digit of a sd, 7 at most; None without a sd, or below them."""
    if not math.isfinite(sd) or sd <= 0.0 or _place(sd) >= MOST_DECIMALS + SD_DIGITS:
        return None
    return max(0, min(_place(sd), MOST_DECIMALS))


def _place(sd: float) -> int:
    return SD_DIGITS - 1 - math.floor(math.log10(sd))


def with_sd(value: float, sd: float) -> str:
    """`value ± sd`, both to the second significant digit of sd; four digits of a value without one."""
    digits = decimals(sd)
    if digits is None:
        return short(value)
    place = min(_place(sd), MOST_DECIMALS)
    return f"{round(value, place) + 0.0:.{digits}f} ± {round(sd, place):.{digits}f}"


def at_sd(value: float, sd: float) -> str:
    """The value alone as `with_sd` writes it, 0 for what rounds to it; a dash for none."""
    if not math.isfinite(value):
        return "–"
    text = with_sd(value, sd).partition(" ")[0]
    return text if float(text) else "0"


def signed(value: float, sd: float) -> str:
    """A change with its sign, as `with_sd` writes it; two decimals without a standard deviation."""
    words = with_sd(value, sd) if math.isfinite(sd) and sd > 0.0 else f"{value:.2f}"
    if not float(words.split()[0]):
        return words.removeprefix("-")
    return words.replace("-", "\N{MINUS SIGN}") if words.startswith("-") else f"+{words}"


def sd_format(sd: float) -> str:
    """Number format of a sheet for a value with this standard deviation, or of the deviation itself."""
    digits = decimals(sd)
    if digits is None:
        return "0.0000"
    return "0." + "0" * digits if digits else "0"


def unit_words(unit: str) -> str:
    """A blank and the unit, nothing for a ratio."""
    return "" if unit in ("", "-") else f" {unit}"
