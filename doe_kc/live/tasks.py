"""Long tasks that a live page asks for, and what is told of them: one line of JSON each, to and from the
process that does them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, TypeAdapter

from doe_kc.ground.fields import Finite, Pair, Strict
from doe_kc.live.effect_switches import EffectSizes
from doe_kc.study import Study, read_study

CANCELLED = "cancelled; results written so far are kept."
TaskKind = Literal["correlate", "discover", "confirm"]
SavedSizes = dict[str, dict[str, Finite] | None]


class TaskRequest(Strict):
    """task: the command of that name; confirm: one design by the study's true solver, into its store.

    study, measurement, out, seed: as the page was opened. effects: switched on or off. fixed, bounds:
    absolute, of parameters. exclude: ids of effects that are not looked for. values: of the design to
    confirm.
    """

    task: TaskKind
    study: str
    measurement: list[str]
    out: str
    seed: int
    effects: SavedSizes = Field(default={})
    fixed: dict[str, Finite] = Field(default={})
    bounds: dict[str, Pair] = Field(default={})
    exclude: list[str] = Field(default=[])
    values: dict[str, Finite] = Field(default={})

    def read(self) -> Study:
        """The study; InputError as `read_study`."""
        measurement = [Path(name) for name in self.measurement]
        return read_study(Path(self.study), measurement=measurement, out=Path(self.out), seed=self.seed)


class TaskProgress(Strict):
    """Steps done of how many. words: what is under way."""

    kind: Literal["progress"] = "progress"
    words: str
    done: int
    total: int


class TaskResult(Strict):
    """lines: the answer in words, first the most important. adoptable: whether there is anything to adopt.

    values: path -> absolute value of every parameter that is not at its start. effects: that are added.
    """

    kind: Literal["result"] = "result"
    lines: list[str]
    adoptable: bool = False
    values: dict[str, Finite] = Field(default={})
    effects: SavedSizes = Field(default={})


class TaskFailure(Strict):
    """reason: one sentence."""

    kind: Literal["failure"] = "failure"
    reason: str


News = Annotated[TaskProgress | TaskResult | TaskFailure, Field(discriminator="kind")]
NEWS: TypeAdapter[News] = TypeAdapter(News)


def task_request(
    study: Study,
    task: TaskKind,
    *,
    effects: EffectSizes | None = None,
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    exclude: tuple[str, ...] = (),
    values: Mapping[str, float] | None = None,
) -> TaskRequest:
    """The request of a task on a study that was read."""
    sizes = {name: None if s is None else dict(s) for name, s in (effects or {}).items()}
    return TaskRequest(
        task=task,
        study=str(study.source),
        measurement=[str(path) for path in study.measurements],
        out=str(study.out),
        seed=study.seed,
        effects=sizes,
        fixed=dict(fixed or {}),
        bounds={path: list(pair) for path, pair in (bounds or {}).items()},
        exclude=list(exclude),
        values=dict(values or {}),
    )
