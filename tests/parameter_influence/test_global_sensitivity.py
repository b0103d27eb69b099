"""Global sensitivities of the example axle beside its slopes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.characteristics import CHARACTERISTICS
from doe_kc.ground.errors import RunError
from doe_kc.parameter_influence import global_sensitivity as module
from doe_kc.parameter_influence.global_methods import find_global_method
from doe_kc.parameter_influence.global_sensitivity import GlobalSensitivity, global_runs, global_sensitivity
from doe_kc.true_solver.outcome import Outcome, failure
from doe_kc.true_solver.own import AxleSolver
from doe_kc.true_solver.protocol import Values
from doe_kc.variables import Change, Space, VariableOptions, build_space
from tests.reference import nominal

ENTRIES = [CHARACTERISTICS[name] for name in ("vertical.bump_steer", "vertical.ride_rate", "static.toe")]
METHODS = {
    find_global_method(name, "test"): size for name, size in (("morris", 6), ("sobol", 16), ("pawn", 60))
}


def space(*changes: Change) -> Space:
    """Three variables: a tie rod, which moves bump steer by a plane; a stop, which nothing at the start
    feels."""
    use = ["ROB.z", "spring.rate", "bump_stop.clearance"]
    return build_space(nominal(), VariableOptions(use=use, change=list(changes)), "test")


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("global") / "global.sqlite"


def solved(store: Path | None, of: Space | None = None) -> GlobalSensitivity:
    return global_sensitivity(nominal(), of or space(), ENTRIES, METHODS, seed=1, store=store, workers=1)


@pytest.fixture(scope="module")
def result(store: Path) -> GlobalSensitivity:
    wide = Change(match="bump_stop.clearance", offset=[-60.0, 10.0])  # type: ignore[arg-type]
    return solved(store, space(wide))


def test_designs_and_store(result: GlobalSensitivity, store: Path) -> None:
    assert global_runs(METHODS, 3) == sum(m.designs for m in result.methods) == 6 * 4 + 16 * 5 + 60
    wide = Change(match="bump_stop.clearance", offset=[-60.0, 10.0])  # type: ignore[arg-type]
    again = solved(store, space(wide))
    assert again.runs == 0 and 0 < result.runs <= global_runs(METHODS, 3)
    for one, other in zip(result.methods, again.methods, strict=True):
        np.testing.assert_array_equal(one.indices[0].values, other.indices[0].values)
        np.testing.assert_array_equal(one.indices[0].error, other.indices[0].error)


def test_a_plane_is_named_by_neither(result: GlobalSensitivity) -> None:
    """Bump steer is a plane in the tie rod's height: slope and every method say the same of it."""
    names = [v.path for v in result.variables]
    i = names.index("ROB.z")
    morris = result.methods[0]
    assert morris.index("mu_star").values[i, 0] == pytest.approx(abs(result.effects[i, 0]), rel=0.05)
    assert result.shares[i, 0] > 0.99 and result.methods[1].index("total").values[i, 0] > 0.6
    assert ("ROB.z", "vertical.bump_steer") not in {
        (d.variable.path, d.characteristic.id) for d in result.disagreements()
    }


def test_what_no_slope_sees_is_named(result: GlobalSensitivity) -> None:
    """A stop that is open at the start and closes within its range moves the ride rate."""
    named = {(d.variable.path, d.characteristic.id, d.method) for d in result.disagreements()}
    assert ("bump_stop.clearance", "vertical.ride_rate", "Morris") in named
    first = next(d for d in result.disagreements() if d.characteristic.id == "vertical.ride_rate")
    assert first.variable.path == "bump_stop.clearance" and first.local == 0.0 and first.missed > 0.0
    morris = next(d.sentence for d in result.disagreements() if d.sentence.endswith("(Morris)."))
    assert "over its range on average, by its slope by 0; what it does beyond" in morris
    assert any(d.method == "Sobol" and d.missed > 0.02 for d in result.disagreements())


def test_what_never_changes_has_no_index(result: GlobalSensitivity) -> None:
    """No variable moves static toe, which is set."""
    k = 2
    for method in result.methods:
        main = method.index(method.main)
        assert np.abs(main.values[:, k]).max() < 1e-6 or np.ptp(result.effects[:, k]) > 0.0


def test_errors_shrink_with_samples(result: GlobalSensitivity) -> None:
    for method in result.methods:
        assert method.errors.shape == (3, 3) and np.isfinite(method.errors).all()
    assert result.methods[2].errors[-1, 1] < result.methods[2].errors[0, 1]


class _Reluctant(AxleSolver):
    def evaluate(self, values: Values) -> Outcome:
        return failure("none") if values["ROB.z"] > 283.0 else super().evaluate(values)


def test_samples_with_a_failure_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "AxleSolver", _Reluctant)
    methods = {find_global_method("pawn", "test"): 60}
    done = global_sensitivity(nominal(), space(), ENTRIES, methods, seed=1, workers=1)
    (pawn,) = done.methods
    assert 0 < pawn.failed < 30 and pawn.blocks + pawn.failed == 60
    narrow = replace(space(), fixed={})
    with pytest.raises(RunError, match=r"global sensitivity by Morris: \d+ of 6 samples hold a design"):
        methods = {find_global_method("morris", "test"): 6}
        global_sensitivity(nominal(), narrow, ENTRIES, methods, seed=1, workers=1)
