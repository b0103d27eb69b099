"""One module a command, named as it; each registers its command with the application when imported.

Commands bring solver, tables and pictures along: only the one that is called is imported. The list of
commands (help, a typo) is made of their sources.
"""

from __future__ import annotations

import ast
import importlib
import keyword
import pkgutil
from collections.abc import Sequence
from pathlib import Path

import typer


def command_names() -> list[str]:
    """Every command; none is imported."""
    return sorted(info.name.removesuffix("_") for info in pkgutil.iter_modules(__path__))


def module_name(command: str) -> str:
    """Module of a command: its name, with an underscore where that is a word of Python."""
    return f"{command}_" if keyword.iskeyword(command) else command


def register(app: typer.Typer, arguments: Sequence[str]) -> None:
    """Import the command that `arguments` call; when it is none, list all of them."""
    names = command_names()
    called = next((word for word in arguments if not word.startswith("-")), None)
    if called is not None and called in names:
        importlib.import_module(f"{__name__}.{module_name(called)}")
        return
    known = {command.name for command in app.registered_commands}
    for name in names:
        if name not in known:
            app.command(name, help=_description(name))(_listed)


def _listed() -> None:
    """What stands for a command that was not called."""


def _description(name: str) -> str:
    """Docstring of a command's function."""
    name = module_name(name)
    source = Path(__path__[0], f"{name}.py").read_text(encoding="utf-8")
    functions = (f for f in ast.parse(source).body if isinstance(f, ast.FunctionDef) and f.name == name)
    return next((ast.get_docstring(f) or "" for f in functions), "")
