"""The command line: one application, one module a command, errors as one sentence."""

from __future__ import annotations

import gc
import logging
import os
import signal
import sys
from types import FrameType
from typing import Annotated, NoReturn

import typer

from doe_kc import __version__
from doe_kc.ground.errors import DoeKcError, RunError
from doe_kc.ground.signals import SIGNALS, Handler, of_this_process
from doe_kc.ground.threads import set_thread_variables

INTERRUPTED = "interrupted; results written so far are kept, the same command starts again."

GARBAGE_THRESHOLD = 50_000
"""New objects between two searches for cyclic garbage: at Python's 700, a sixth of the time that a command's
imports take goes into searching what they have just made."""

app = typer.Typer(
    name="doe-kc",
    help="Makes a suspension simulation agree with the measured car.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def _version(asked: bool) -> None:
    if asked:
        typer.echo(f"doe-kc {__version__}")
        raise typer.Exit


@app.callback(help=app.info.help)
def _group(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    # Without a callback Typer makes a lone registered command the whole application.
    pass


def main() -> NoReturn:
    """Run a command; exit code 0, 2 for bad input, 1 for a failed run, without a traceback."""
    set_thread_variables()
    gc.set_threshold(GARBAGE_THRESHOLD)
    _on_interrupt(_leave)
    from doe_kc.cli import commands

    commands.register(app, sys.argv[1:])
    logging.basicConfig(format="doe-kc: %(message)s", level=logging.WARNING, stream=sys.stderr)
    _on_interrupt(_interrupted)
    try:
        app()
    except DoeKcError as error:
        _end(str(error), error.exit_code)
    except BrokenPipeError:
        sys.stderr.close()
        sys.exit(1)
    except OSError as error:
        _end(f"{error.filename or 'standard output'}: {error.strerror or error}.", 1)
    except MemoryError:
        _end("out of memory; use fewer --workers.", 1)
    sys.exit(0)


def _on_interrupt(handler: Handler) -> None:
    for number in SIGNALS:
        signal.signal(number, of_this_process(handler))


def _leave(_signal: int, _frame: FrameType | None) -> None:
    """While modules are imported, where an exception could be swallowed or garbled by an extension."""
    os.write(2, f"doe-kc: {INTERRUPTED}\n".encode())
    os._exit(RunError.exit_code)


def _interrupted(_signal: int, _frame: FrameType | None) -> None:
    raise RunError(INTERRUPTED)


def _end(message: str, code: int) -> NoReturn:
    sys.stderr.write(f"doe-kc: {message}\n")
    sys.exit(code)
