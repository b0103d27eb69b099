"""What the page may say: one model a kind, checked in full before anything is done."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, TypeAdapter, ValidationError

from doe_kc.ground.errors import InputError
from doe_kc.ground.fields import Finite, Strict

LONGEST_MESSAGE = 16_384
"""Bytes; the largest honest one, an effect with its sizes, has some hundred."""
Name = Annotated[str, Field(min_length=1, max_length=80)]
MessageNumber = Annotated[int, Field(ge=0, le=2**32 - 1)]


class Move(Strict):
    """A slider to an absolute value. last: the slider was let go."""

    kind: Literal["move"]
    seq: MessageNumber
    path: Name
    value: Finite
    last: bool = True


class Reset(Strict):
    """One slider, or all without a path, to the start."""

    kind: Literal["reset"]
    seq: MessageNumber = 0
    path: Name | None = None


class Lock(Strict):
    """Sliders that advice leaves alone: those of the paths, or all without any."""

    kind: Literal["lock"]
    paths: Annotated[list[Name], Field(max_length=1000)] = Field(default=[])
    on: bool


class Hold(Strict):
    """A characteristic that advice must not move."""

    kind: Literal["hold"]
    characteristic: Name
    on: bool


class BoundsChange(Strict):
    """A slider's bounds, absolute."""

    kind: Literal["bounds"]
    path: Name
    lower: Finite
    upper: Finite


class SwitchEffect(Strict):
    """An effect on with sizes in their units, or off (sizes null)."""

    kind: Literal["effect"]
    seq: MessageNumber = 0
    name: Name
    sizes: Annotated[dict[Name, Finite], Field(max_length=20)] | None


class ResetEffect(Strict):
    """An effect as it was at first: of the axle file as it is there, else off."""

    kind: Literal["reset_effect"]
    seq: MessageNumber = 0
    name: Name


class LockEffect(Strict):
    """An effect that background tasks leave alone, or not."""

    kind: Literal["lock_effect"]
    name: Name
    on: bool


class TakeSnapshot(Strict):
    """Keep the present design to compare with."""

    kind: Literal["snapshot"]
    name: Annotated[str, Field(max_length=40)] = ""


class PlacedSnapshot(Strict):
    """Drop a snapshot, or go back to its design."""

    kind: Literal["drop", "restore"]
    seq: MessageNumber = 0
    place: Annotated[int, Field(ge=0, lt=10)]


class UndoStep(Strict):
    """Undo or redo."""

    kind: Literal["undo", "redo"]
    seq: MessageNumber = 0


class Look(Strict):
    """Where the axle is seen: a load case and a row of its rising input."""

    kind: Literal["look"]
    load_case: Name
    row: Annotated[int, Field(ge=0, lt=100_000)]


class Ask(Strict):
    """Advice on the present design."""

    kind: Literal["best_step", "helpers", "invisible"]


class RunTask(Strict):
    """A command in the background: its progress is told, its result waits to be adopted."""

    kind: Literal["correlate", "discover"]


class EndTask(Strict):
    """Cancel the background task, adopt its result, or forget it."""

    kind: Literal["cancel", "adopt", "forget"]
    seq: MessageNumber = 0


class Keep(Strict):
    """Write to, or read from, the study's own folder; no path comes from the page."""

    kind: Literal["save", "reopen", "export_axle", "export_table", "export_page"]


Message = Annotated[
    Move | Reset | Lock | Hold | BoundsChange | SwitchEffect | ResetEffect | LockEffect | TakeSnapshot
    | PlacedSnapshot | UndoStep | Look | Ask | RunTask | EndTask | Keep,
    Field(discriminator="kind"),
]  # fmt: skip
_ADAPTER: TypeAdapter[Message] = TypeAdapter(Message)


def read_message(text: str | bytes) -> Message:
    """The message; InputError in one sentence for anything else."""
    if len(text) > LONGEST_MESSAGE:
        raise InputError(f"message of {len(text)} characters: expected at most {LONGEST_MESSAGE}.")
    try:
        return _ADAPTER.validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(str(p) for p in first["loc"]) or "message"
        raise InputError(f"{where}: {first['msg']}.") from None
