"""An outside solver beside a live page: what its store has, and what is learnt from an answer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from doe_kc.campaign.record import design_key
from doe_kc.campaign.store import read_store
from doe_kc.live.answer import Compilation, LiveAnswer, answer_from
from doe_kc.live.model import LiveModel
from doe_kc.live.outside_model import outside_model, stored_design
from doe_kc.true_solver.outcome import Outcome


def design_values(model: LiveModel, values: Mapping[str, float]) -> dict[str, float]:
    """Path -> absolute value of a design as campaigns name it: variables, ties, fixed. values: moved ones."""
    moved = {v.path: values.get(v.path, v.start) for v in model.space.variables}
    return model.space.values(model.space.unit(moved))


def stored_outcome(model: LiveModel, values: Mapping[str, float]) -> Outcome | None:
    """What the store of an outside solver's study has for a design; None where that is nothing."""
    study = model.study
    if model.outside is None or not study.store.is_file():
        return None
    with read_store(study.store) as store:
        key = design_key(design_values(model, values))
        if store.status(key) is None or store.lacks_curves(key, study.windows, curves=True):
            return None
        return store.outcome(key, study.windows)


def stored_answer(
    model: LiveModel, values: Mapping[str, float], compilation: Compilation
) -> LiveAnswer | str | None:
    """The outside solver's own answer, or why it has none; None for a design that it was not asked for."""
    outcome = stored_outcome(model, values)
    return None if outcome is None else outside_answer(model, values, compilation, outcome)


def outside_answer(
    model: LiveModel, values: Mapping[str, float], compilation: Compilation, outcome: Outcome
) -> LiveAnswer | str:
    """Of an outcome; a sentence where the solver failed or left out what the page draws."""
    assert model.outside is not None
    if not outcome.failed and not model.outside.form.fits(outcome):
        return "the outside solver gave fewer load cases or responses than in the designs stored before"
    return answer_from(model, values, compilation, outcome)


def learnt(model: LiveModel, values: Mapping[str, float], outcome: Outcome) -> LiveModel:
    """The model whose surrogate knows one more design; itself where there is nothing to learn from it."""
    outside = model.outside
    assert outside is not None
    design = design_values(model, values)
    point = model.space.unit(design)
    known = stored_design(outside.form, design_key(design), point, outcome, model.space, outside.twin)
    return model if known is None else replace(model, outside=outside.learnt(known))


def learnt_anew(model: LiveModel) -> LiveModel:
    """The model whose surrogate knows all of the store, to which a background task has added."""
    return replace(model, outside=outside_model(model.study, model.space))
