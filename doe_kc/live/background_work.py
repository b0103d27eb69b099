"""What goes on beside a page: long tasks, and an outside solver that confirms what its surrogate says."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import replace

from doe_kc.ground.errors import DoeKcError, InputError
from doe_kc.live.background_queue import BackgroundQueue, TaskStatus
from doe_kc.live.confirmation import (
    learnt,
    learnt_anew,
    outside_answer,
    stored_outcome,
)
from doe_kc.live.effect_switches import effect_switches
from doe_kc.live.session import Session, SolveRequest
from doe_kc.live.tasks import News, TaskKind, TaskProgress, TaskRequest, TaskResult, task_request

Job = Callable[[], None]


class BackgroundWork:
    """status: of the last task, None without one. confirming: sliders of the design that the outside solver
    is asked for.

    in_solver: runs a job in the thread that solves. changed: called, in any thread, when the status is
    another. answered: when the session's answer is.
    """

    def __init__(
        self, session: Session, in_solver: Callable[[Job], None], changed: Job, answered: Job
    ) -> None:
        self.session, self._in_solver = session, in_solver
        self._changed, self._answered = changed, answered
        self.status: TaskStatus | None = None
        self.confirming: Mapping[str, float] | None = None
        self.confirming_since = 0.0
        self.queue = BackgroundQueue(self._heard)

    def begin(self, task: TaskKind) -> None:
        """Correlate or discover with what is set: effects, bounds, and locked sliders held.

        InputError while another one is at work, or without records.
        """
        session, state = self.session, self.session.state
        if session.model.measurement is None and (task == "discover" or session.model.likelihood is None):
            raise InputError(f"there are no records or targets to {task} with; name a measurement.")
        values = session.values()
        studied = set(session.model.study.space.paths)
        starts = {v.path: v.start for v in session.model.space.variables}
        fixed = {p: values[p] for p in state.locked if p in studied or values[p] != starts[p]}
        switches = effect_switches(session.base.study)
        request = task_request(
            session.base.study,
            task,
            effects=state.effects,
            fixed=fixed,
            bounds={p: pair for p, pair in state.bounds.items() if p in studied and p not in fixed},
            exclude=tuple(sorted({switches[n].effect for n in state.locked_effects})),
        )
        self.queue.put(request)
        session.result = None
        self.status = TaskStatus(task, "waiting", f"{task}: begins", time.monotonic())
        self._changed()

    def cancel(self) -> None:
        """End the task; InputError without one."""
        if not self.queue.cancel_task():
            raise InputError("no task is at work.")
        if self.status is not None and not self.status.ended:
            self.status = replace(self.status, state="cancelling", words="ending …")
        self._changed()

    def forget(self) -> None:
        """Say no more of a task that has ended."""
        if self.status is not None and self.status.ended:
            self.status = None
            self.session.result = None
        self._changed()

    def confirm(self, request: SolveRequest) -> None:
        """Have the outside solver answer what the surrogate has answered; nothing where it has already."""
        session = self.session
        if request.model.outside is None:
            return
        self.queue.drop_confirmation()
        self.confirming = None
        if not session.present.true and session.settled and request.at_rest:
            self.confirming, self.confirming_since = dict(request.values), time.monotonic()
            self.queue.put(session.confirm_request(request.values))
        self._changed()

    def close(self) -> None:
        """End all processes."""
        self.queue.close()

    def _heard(self, request: TaskRequest, news: News) -> None:
        """In the thread of a process."""
        if request.task == "confirm":
            if not isinstance(news, TaskProgress):
                self._in_solver(lambda: self._confirmed(request, news))
            return
        if self.status is not None:
            self.status = self.status.after(news)
        if isinstance(news, TaskResult):
            self.session.result = news
            if self.session.model.outside is not None:
                self._in_solver(self._learn_anew)
        self._changed()

    def _confirmed(self, request: TaskRequest, news: News) -> None:
        """In the solver's thread: the outside solver has ended a design; shown if it is still what is set."""
        session = self.session
        asked = session.confirm_request(session.request().values).values == request.values
        try:
            if isinstance(news, TaskResult):
                self._learn(request.values, asked=asked)
            elif asked:
                session.refuse(f"{news.reason}" if not isinstance(news, TaskProgress) else "")
        except DoeKcError as error:
            session.refuse(str(error))
        if asked:
            self.confirming = None
        self._answered()
        self._changed()

    def _learn(self, values: Mapping[str, float], *, asked: bool) -> None:
        session, model = self.session, self.session.model
        sliders = {p: values[p] for p in model.space.paths}
        outcome = stored_outcome(model, sliders)
        if outcome is None:
            session.refuse("the outside solver's answer is not in the store.")
            return
        if not outcome.failed:
            model = learnt(model, sliders, outcome)
            session.remodelled(model)
        if asked:
            answer = outside_answer(model, sliders, session.compilation, outcome)
            session.keep(answer, SolveRequest(session.seq, model, sliders, at_rest=True))
        else:
            session.solve_now()

    def _learn_anew(self) -> None:
        session = self.session
        session.remodelled(learnt_anew(session.model))
        session.solve_now()
        self._answered()
        self._changed()
