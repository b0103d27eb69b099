"""What the page is told in words: what is set, what is advised, what goes on beside it."""

from __future__ import annotations

import math
import time
from typing import Any

from doe_kc.live.advice import Advised
from doe_kc.live.background_queue import TaskStatus
from doe_kc.live.background_work import BackgroundWork
from doe_kc.live.session import Session


def state_document(session: Session) -> dict[str, Any]:
    """What is set, but the sliders' values, which come with every answer."""
    state = session.state
    return {
        "kind": "state",
        "locked": sorted(state.locked),
        "held": sorted(state.held),
        "bounds": {path: list(pair) for path, pair in state.bounds.items()},
        "effects": {n: None if sizes is None else dict(sizes) for n, sizes in state.effects.items()},
        "locked_effects": sorted(state.locked_effects),
        "snapshots": [s.name for s in state.snapshots],
        "undo": session.can_undo,
        "redo": session.can_redo,
    }


def advice_document(advised: Advised, session: Session) -> dict[str, Any]:
    """Sentence and rows: path, present value, value advised, unit, note."""
    now = session.values()
    units = {v.path: v.unit for v in session.model.space.variables}
    labels = {v.path: v.parameter.label for v in session.model.space.variables}
    return {
        "kind": "advice",
        "what": advised.what,
        "sentence": advised.sentence,
        "rows": [
            {"path": r.path, "label": labels[r.path], "now": now[r.path], "value": r.value,
             "unit": units[r.path], "note": r.note}
            for r in advised.rows
        ],
        "adopted": bool(advised.adopt),
    }  # fmt: skip


def work_document(work: BackgroundWork) -> dict[str, Any]:
    """Of what goes on beside the page. task: null without one; rate in steps a second and seconds left null
    where they are not known. outside: null for the package's own solver."""
    return {"kind": "work", "task": _task(work.status), "outside": _outside(work)}


def _task(status: TaskStatus | None) -> dict[str, Any] | None:
    if status is None:
        return None
    rate, left = (v if math.isfinite(v) else None for v in (status.rate, status.left))
    return {
        "name": status.task,
        "state": status.state,
        "words": status.words,
        "done": status.done,
        "total": status.total,
        "rate": None if status.ended else rate,
        "left": None if status.ended else left,
        "seconds": round(status.seconds, 1),
        "lines": [] if status.result is None else status.result.lines,
        "adoptable": status.result is not None and status.result.adoptable,
    }


def _outside(work: BackgroundWork) -> dict[str, Any] | None:
    outside = work.session.model.outside
    if outside is None:
        return None
    asked = None if work.confirming is None else round(time.monotonic() - work.confirming_since, 1)
    return {"sentence": outside.sentence, "confirming": asked}
