"""The command line: one application, one module a command, errors as one sentence."""

from __future__ import annotations

import logging
import signal
import sys
from types import FrameType
from typing import NoReturn

import typer

from doe_kc.errors import DoeKcError, RunError

app = typer.Typer(
    name="doe-kc",
    help="Makes a suspension simulation agree with the measured car.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def main() -> NoReturn:
    """Run a command; exit code 0, 2 for bad input, 1 for a failed run, without a traceback."""
    from doe_kc.cli import commands

    commands.register_all()
    logging.basicConfig(format="doe-kc: %(message)s", level=logging.WARNING, stream=sys.stderr)
    signal.signal(signal.SIGINT, _interrupted)
    try:
        app()
    except DoeKcError as error:
        _end(str(error), error.exit_code)
    except BrokenPipeError:
        sys.stderr.close()
        sys.exit(1)
    except OSError as error:
        _end(f"{error.filename or 'a file'}: {error.strerror or error}.", 1)
    except MemoryError:
        _end("out of memory; use fewer --workers.", 1)
    sys.exit(0)


def _interrupted(_signal: int, _frame: FrameType | None) -> None:
    raise RunError("interrupted; results written so far are kept, the same command starts again.")


def _end(message: str, code: int) -> NoReturn:
    sys.stderr.write(f"doe-kc: {message}\n")
    sys.exit(code)
