"""A finished correlation as a file: what was asked, predicted and chosen; the answers are in the store."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any, Literal

import numpy as np

from doe_kc.axle.design_parameters import Parameter, design_parameters
from doe_kc.axle.model import Axle
from doe_kc.axle.parameters import parameter_value
from doe_kc.campaign.record import design_key
from doe_kc.campaign.store import Store
from doe_kc.correlation.answer_record import AnswerRecord
from doe_kc.correlation.assessment import Objection
from doe_kc.correlation.loop import Run
from doe_kc.correlation.methods._base import best_design
from doe_kc.correlation.posterior import ParameterPosterior
from doe_kc.correlation.problem import Candidate, Problem, RatingForecast
from doe_kc.correlation.result import Correlation
from doe_kc.ground.errors import InputError
from doe_kc.ground.fields import Strict
from doe_kc.ground.files import validate
from doe_kc.true_solver.outcome import Outcome
from doe_kc.variables import Space, Tie, Variable
from doe_kc.variables.build import plain_parameter
from doe_kc.variables.options import Distribution


class VariableRecord(Strict):
    """A variable as it was in the run; absolute values. Its fields are those of `Variable`."""

    path: str
    lower: float
    upper: float
    start: float
    levels: int | None
    distribution: Distribution
    logarithmic: bool


class TieRecord(Strict):
    """A tie as it was in the run."""

    follower: str
    leader: str
    ratio: bool
    follower_nominal: float
    leader_nominal: float


class PredictionRecord(Strict):
    """What was expected of a candidate; None where no model said anything."""

    values: list[float | None]
    sd: list[float | None]
    rating: float | None
    rating_sd: float | None


class EvaluationRecord(Strict):
    """One design: its place between the bounds, who proposed it, what was expected."""

    point: list[float]
    origin: str
    predicted: PredictionRecord | None


class PosteriorRecord(Strict):
    """The fields of `ParameterPosterior` but the prior."""

    sd: list[float]
    offset: list[float]
    correlation: list[list[float]]
    misfit: float
    at_bound: list[int]
    inward: list[float | None]


class EffectRecord(Strict):
    """An effect that the run began with. uncertain: others of its class could stand for it."""

    id: str
    location: str | None
    options: dict[str, Any]
    uncertain: bool


class ObjectionRecord(Strict):
    """The fields of `Objection`."""

    sentence: str
    fatal: bool


class RunRecord(Strict):
    """The whole file. discovered: whether it followed a discovery, whose effects it begins with. without:
    (load case, response) left out of the objectives. objections, misfit: what the discovery says of the
    axle handed over, see `assess`. answer: of the chain that it is part of; None of a correlation alone."""

    schema_: Literal["doe_kc.run/1"] = "doe_kc.run/1"
    method: str
    stopped: str
    best: int
    seconds: float
    steps: list[str]
    notes: list[str]
    variables: list[VariableRecord]
    ties: list[TieRecord]
    fixed: dict[str, float]
    posterior: PosteriorRecord | None
    discovered: bool
    effects: list[EffectRecord]
    without: list[list[str]]
    objections: list[ObjectionRecord]
    misfit: float | None
    answer: AnswerRecord | None = None
    evaluations: list[EvaluationRecord]


def run_document(
    correlation: Correlation,
    *,
    discovered: bool = False,
    effects: Sequence[EffectRecord] = (),
    without: Collection[tuple[str, str]] = (),
    objections: Sequence[Objection] = (),
    misfit: float | None = None,
    answer: AnswerRecord | None = None,
) -> dict[str, Any]:
    """The record of a correlation, for `write_json`. The rest as in `RunRecord`."""
    space, after = correlation.problem.space, correlation.posterior
    record = RunRecord(
        method=correlation.method,
        stopped=correlation.run.stopped,
        best=correlation.run.best,
        seconds=correlation.seconds,
        steps=list(correlation.steps),
        notes=list(correlation.notes),
        variables=[
            VariableRecord(**{name: getattr(v, name) for name in VariableRecord.model_fields})
            for v in space.variables
        ],
        ties=[TieRecord(**vars(t)) for t in space.ties],
        fixed=dict(space.fixed or {}),
        posterior=None if after is None else _posterior(after),
        discovered=discovered,
        effects=list(effects),
        without=[list(place) for place in sorted(without)],
        objections=[ObjectionRecord(sentence=o.sentence, fatal=o.fatal) for o in objections],
        misfit=misfit,
        answer=answer,
        evaluations=[_evaluation(e.candidate) for e in correlation.run.evaluated],
    )
    return record.model_dump()


def _posterior(after: ParameterPosterior) -> PosteriorRecord:
    return PosteriorRecord(
        sd=after.sd.tolist(),
        offset=after.offset.tolist(),
        correlation=after.correlation.tolist(),
        misfit=after.misfit,
        at_bound=after.at_bound.tolist(),
        inward=after.inward.tolist(),
    )


def _evaluation(candidate: Candidate) -> EvaluationRecord:
    expected = candidate.predicted
    predicted = None
    if expected is not None:
        predicted = PredictionRecord(
            values=expected.values.tolist(),
            sd=expected.sd.tolist(),
            rating=expected.rating,
            rating_sd=expected.rating_sd,
        )
    return EvaluationRecord(point=candidate.point.tolist(), origin=candidate.origin, predicted=predicted)


def read_record(document: Mapping[str, Any], source: str) -> RunRecord:
    """The checked record; InputError for a damaged file, or one of another version."""
    try:
        record = validate(RunRecord, document, source)
    except InputError as error:
        raise InputError(f"{error} Or run doe-kc correlate again, which writes the file anew.") from None
    if not 0 <= record.best < len(record.evaluations):
        raise InputError(
            f"{source}: best = {record.best} is no evaluation of the file; run doe-kc correlate again."
        )
    return record


def recorded_space(record: RunRecord, axle: Axle) -> Space:
    """The space of the run."""
    known = {p.path: p for p in design_parameters(axle)}
    variables = tuple(
        Variable(parameter=known.get(v.path) or _plain(axle, v.path), **v.model_dump(exclude={"path"}))
        for v in record.variables
    )
    return Space(variables, tuple(Tie(**t.model_dump()) for t in record.ties), record.fixed)


def _plain(axle: Axle, path: str) -> Parameter:
    parameter_value(axle, path)
    return plain_parameter(axle, path)


def recalled_answers(
    record: RunRecord, problem: Problem, store: Store, source: str
) -> list[tuple[Candidate, Outcome]]:
    """Every evaluation of the run; InputError when the store lacks one of its designs."""
    out = []
    for index, entry in enumerate(record.evaluations):
        point = np.array(entry.point)
        try:
            outcome = store.outcome(design_key(problem.space.values(point)), problem.windows)
        except KeyError:
            raise InputError(
                f"{source}: evaluation {index} is not in {store.path}; run doe-kc correlate again."
            ) from None
        out.append((Candidate(point, entry.origin, _expected(entry)), outcome))
    return out


def recalled(
    record: RunRecord, problem: Problem, answers: Sequence[tuple[Candidate, Outcome]]
) -> Correlation:
    """The correlation again, judged by the problem's present targets and weights.

    The design to hand over is the best merit, but for `gauss_newton` the one it chose.
    """
    evaluated = [problem.judged(i, candidate, outcome) for i, (candidate, outcome) in enumerate(answers)]
    chosen = record.best
    if record.method != "gauss_newton":
        chosen = best_design(evaluated)
    after = None
    if record.posterior is not None and chosen == record.best:
        known = record.posterior
        after = ParameterPosterior(
            np.array(known.sd),
            np.array(known.offset),
            problem.space.prior_sd,
            np.array(known.correlation),
            known.misfit,
            np.array(known.at_bound, dtype=int),
            np.array([np.nan if v is None else v for v in known.inward]),
        )
    return Correlation(
        record.method,
        problem,
        Run(tuple(evaluated), chosen, record.stopped),
        tuple(record.steps),
        after,
        record.seconds,
        tuple(record.notes),
    )


def _expected(entry: EvaluationRecord) -> RatingForecast | None:
    forecast = entry.predicted
    if forecast is None:
        return None
    values, sd = (np.array([np.nan if v is None else v for v in x]) for x in (forecast.values, forecast.sd))
    rating, spread = (np.nan if x is None else x for x in (forecast.rating, forecast.rating_sd))
    return RatingForecast(values, sd, rating, spread)
