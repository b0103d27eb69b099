"""The process of one long task of a live page: `python -m doe_kc.live.background`.

The request is the first line of its standard input, news are lines of its standard output. It ends when the
input closes: with the page's server, however that ends. What it has computed by then is in the study's store.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import FrameType
from typing import TextIO

from doe_kc.axle.model import Axle
from doe_kc.campaign.processes import available_cores
from doe_kc.campaign.runner import Campaign
from doe_kc.correlation.assessment import assess
from doe_kc.correlation.problem import Evaluated
from doe_kc.correlation.result import Correlation
from doe_kc.effects.words import effect_label
from doe_kc.ground.errors import DoeKcError, RunError
from doe_kc.ground.numbers import number
from doe_kc.ground.signals import SIGNALS, of_this_process
from doe_kc.live.effect_switches import EffectSizes, EffectSwitch, effect_switches, effective_axle
from doe_kc.live.tasks import CANCELLED, SavedSizes, TaskFailure, TaskProgress, TaskRequest, TaskResult
from doe_kc.study import Study
from doe_kc.true_solver.make import solver_for
from doe_kc.variables import build_space
from doe_kc.variables.options import Change
from doe_kc.workflow.adopt import AdoptedEffect, Adoption, adopt
from doe_kc.workflow.correlate import correlate
from doe_kc.workflow.discover import discover_study
from doe_kc.workflow.discovery_document import discovery_lines
from doe_kc.workflow.measure import study_measurement, study_records
from doe_kc.workflow.twin_discovery import discovery_ground

NICE = 10
"""Of its priority, so that the hand on the page comes first."""
GRACE_PERIOD = 5.0
"""Seconds in which a task that is told to end puts its results away."""
NEWS_INTERVAL = 0.2
"""Seconds between two lines of progress at least."""
ORIGIN = "live"
Tell = Callable[[str, int, int], None]


def correlated_result(study: Study, request: TaskRequest, tell: Tell) -> TaskResult:
    """The study's correlation, with the effects of the page, locked sliders held, in the page's bounds."""
    adoption = page_adoption(study, request.effects)
    asked = page_study(study, request, study.axle if adoption is None else adoption.axle)
    done, best = 0, -float("inf")

    def watch(new: Sequence[Evaluated]) -> None:
        nonlocal done, best
        done += len(new)
        best = max([best, *(e.merit for e in new)])
        tell(f"correlating, merit {best:.4g}", done, study.correlation.budget)

    workers = None if study.solver.command else max(1, available_cores() - 1)
    correlation = correlate(asked, study_records(study), adoption=adoption, workers=workers, watch=watch)
    return TaskResult(
        lines=list(_correlation_words(correlation)),
        adoptable=True,
        values={**dict(request.fixed), **correlation.values},
    )


def _correlation_words(correlation: Correlation) -> Iterator[str]:
    yield assess(correlation).line
    yield (
        f"Rating {number(correlation.rating)} (baseline {number(correlation.baseline_rating)}; 0 is every "
        f"target met), {len(correlation.run.evaluated)} evaluations, mean improvement "
        f"{number(correlation.mean_improvement, 3)} %."
    )
    if correlation.posterior is not None:
        hidden = int((~correlation.posterior.visible).sum())
        yield f"{hidden} of {correlation.problem.space.dimension} variables are not visible in the records."


def page_adoption(study: Study, effects: EffectSizes) -> Adoption | None:
    """The effects of the page as a correlation takes them; None where they are those of the axle file."""
    if not effects:
        return None
    known = effect_switches(study)
    added = tuple(
        AdoptedEffect(known[name].effect, None, known[name].options(sizes), uncertain=False)
        for name, sizes in effects.items()
        if sizes is not None
    )
    return Adoption(effective_axle(study, effects), added, {}, frozenset())


def page_study(study: Study, request: TaskRequest, axle: Axle) -> Study:
    """The study with the page's bounds, and what is locked fixed; the study itself where there is none."""
    changes = [Change(match=path, range=list(pair)) for path, pair in request.bounds.items()]
    changes += [Change(match=path, fixed=value) for path, value in request.fixed.items()]
    if not changes:
        return study
    variables = study.variables.model_copy(update={"change": [*study.variables.change, *changes]})
    return replace(study, variables=variables, space=build_space(axle, variables, str(study.source)))


def discovered_result(study: Study, request: TaskRequest, tell: Tell) -> TaskResult:
    """The study's discovery, of what the axle lacks beside the effects of the page."""
    ground = discovery_ground(study, study_measurement(study))
    outside = ground.study is not study
    axle = ground.study.axle if outside else effective_axle(study, request.effects)
    asked = page_study(replace(ground.study, axle=axle), request, axle)
    workers = max(1, available_cores() - 1)
    discovery = discover_study(asked, ground.records, exclude=request.exclude, workers=workers, progress=tell)
    lines = list(discovery_lines(discovery))
    if outside:
        return TaskResult(lines=[*lines, "Add it to the outside model by hand: its page has no effects."])
    adoption = adopt(asked, discovery)
    rig = [effect_label(e.id).lower() for e in adoption.effects if e.on_rig]
    if rig:
        lines.append(f"Not adopted, for it is a fault of the measurement: {', '.join(rig)}.")
    effects: SavedSizes = dict(
        switch_sizes(e, effect_switches(study)) for e in adoption.effects if not e.on_rig
    )
    return TaskResult(
        lines=lines,
        adoptable=True,
        values={**dict(request.fixed), **adoption.refit},
        effects=effects,
    )


def switch_sizes(effect: AdoptedEffect, switches: Mapping[str, EffectSwitch]) -> tuple[str, dict[str, float]]:
    """Name of the switch and the sizes of an effect that was adopted; RunError where the page has none."""
    name = effect.id if effect.location is None else f"{effect.id} {effect.location}"
    if law := effect.options.get("law"):
        name = f"{name}, {law}"
    if name not in switches:
        raise RunError(f"{effect.label}: the page has no switch for it; run doe-kc discover instead.")
    return name, {s.name: s.number_in(effect.options) for s in switches[name].sizes}


def confirmed_result(study: Study, request: TaskRequest, tell: Tell) -> TaskResult:
    """One design by the study's solver, unless its store has it."""
    del tell
    solver = solver_for(study.axle, study.solver, study.windows, study.folder)
    with Campaign(solver, study.store, workers=1) as campaign:
        (outcome,) = campaign.evaluate([dict(request.values)], ORIGIN)
    return TaskResult(lines=[outcome.reason] if outcome.failed else [])


TASKS: Mapping[str, Callable[[Study, TaskRequest, Tell], TaskResult]] = {
    "correlate": correlated_result,
    "discover": discovered_result,
    "confirm": confirmed_result,
}


class NewsWriter:
    """Lines of JSON. Progress not too often."""

    def __init__(self, stream: TextIO) -> None:
        self._stream, self._last = stream, -NEWS_INTERVAL

    def write(self, news: TaskProgress | TaskResult | TaskFailure) -> None:
        """One line; nothing where nobody reads any more."""
        with contextlib.suppress(BrokenPipeError):
            self._stream.write(news.model_dump_json() + "\n")
            self._stream.flush()

    def progress(self, words: str, done: int, total: int) -> None:
        """Of a task."""
        now = time.monotonic()
        if now - self._last >= NEWS_INTERVAL:
            self._last = now
            self.write(TaskProgress(words=words, done=done, total=total))


def main() -> int:
    """Do what the first line of the input asks; exit code 0 when there is a result."""
    writer = NewsWriter(_own_output())
    for interrupt in SIGNALS:
        signal.signal(interrupt, of_this_process(_interrupted))
    if hasattr(os, "nice"):
        os.nice(NICE)
    request = TaskRequest.model_validate_json(_first_line())
    threading.Thread(target=_end_with_input, daemon=True).start()
    try:
        writer.write(TASKS[request.task](request.read(), request, writer.progress))
    except DoeKcError as error:
        writer.write(TaskFailure(reason=str(error)))
        return error.exit_code
    except MemoryError:
        writer.write(TaskFailure(reason="out of memory."))
        return 1
    return 0


def _first_line() -> bytes:
    """Of standard input, unbuffered: a thread that waits in a buffer would hold its lock at the end."""
    line = b""
    while not line.endswith(b"\n") and (more := os.read(0, 1 << 16)):
        line += more
    return line


def _own_output() -> TextIO:
    """The pipe of the news; whatever else is printed goes to standard error."""
    own = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    return own


def _interrupted(_signal: int, _frame: FrameType | None) -> None:
    raise RunError(CANCELLED)


def _end_with_input() -> None:
    """When the page's server closes the input or is no more: end the task as Ctrl-C would, then for sure."""
    while os.read(0, 1):
        pass
    main_thread = threading.main_thread().ident
    if hasattr(signal, "pthread_kill") and main_thread is not None:
        signal.pthread_kill(main_thread, signal.SIGTERM)
    else:
        signal.raise_signal(signal.SIGTERM)
    time.sleep(GRACE_PERIOD)
    os._exit(1)


if __name__ == "__main__":
    sys.exit(main())
