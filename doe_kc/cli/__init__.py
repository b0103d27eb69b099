"""The commands of doe-kc."""

from doe_kc.cli._app import main

__all__ = ["main"]
