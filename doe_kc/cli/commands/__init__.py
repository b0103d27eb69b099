"""One module a command; each registers itself with the application."""

from __future__ import annotations

import sys

from doe_kc.registry import import_members


def register_all() -> None:
    """Import every command."""
    import_members(sys.modules[__name__])
