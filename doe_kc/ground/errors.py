"""The two ways in which a command ends badly; each carries one finished sentence for the user."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class DoeKcError(Exception):
    """Base of every error that the commands report as one message without a traceback."""

    exit_code = 1


class InputError(DoeKcError):
    """The user's input is wrong: names the file, the key or row, what was expected, how to mend it."""

    exit_code = 2


class RunError(DoeKcError):
    """The input is sound, yet the run failed (no convergence, output not writable, interrupted)."""

    exit_code = 1


def nearest(name: str, known: Iterable[str]) -> str:
    """`' Did you mean "LLF.x"?'` for the closest known name, or an empty string when none is close."""
    candidates = list(known)
    matches = difflib.get_close_matches(name, candidates, n=1, cutoff=0.5)
    if not matches:
        folded = {c.casefold(): c for c in candidates}
        hit = folded.get(name.casefold())
        matches = [hit] if hit else []
    return f' Did you mean "{matches[0]}"?' if matches else ""
