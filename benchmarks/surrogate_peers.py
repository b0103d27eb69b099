"""Surrogates of the example axle beside SMT, scikit-learn, BoTorch and sparse polynomials.

Peers that are not installed are left out; `python benchmarks/surrogate_peers.py`, one thread.
"""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from _common import example_axle, machine, publish

import numpy as np  # isort: skip  # after the thread limits
from scipy.stats import qmc

from doe_kc.campaign.runner import Campaign
from doe_kc.correlation.linearization import linearize
from doe_kc.ground.typing import FloatArray
from doe_kc.surrogate_models.models import make
from doe_kc.surrogate_models.models.gp import FirstOrderTrend
from doe_kc.surrogate_models.models.gp_slopes import SlopeProcess
from doe_kc.surrogate_models.study import fit_study
from doe_kc.surrogate_models.training import Scaling
from doe_kc.surrogate_models.validation import NOMINAL_WIDTH
from doe_kc.true_solver.own import AxleSolver
from doe_kc.variables import Space, VariableOptions, build_space

SEEDS = {50: (1, 2), 100: (1, 2), 200: (1,), 400: (1,)}
TESTS = 300
FEW = slice(None, None, 6)
"""Five of the thirty characteristics: some peers take minutes an output."""
MOST_ROWS = {"SMT KRG": 50, "SMT KPLS": 200, "scikit-learn": 200, "BoTorch": 200}
Predictor = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""Points to mean and variance, (p, m) each."""
Fit = Callable[[FloatArray, FloatArray], Predictor]


@dataclass(frozen=True)
class Truth:
    """designs: (n, seed) -> x, y. test: x, y. trend: exact at the start. suites: its cost in designs."""

    designs: dict[tuple[int, int], tuple[FloatArray, FloatArray]]
    test: tuple[FloatArray, FloatArray]
    trend: FirstOrderTrend
    suites: float


def truth() -> Truth:
    axle = example_axle()
    space = build_space(axle, VariableOptions(), "benchmark")
    with Campaign(AxleSolver(axle, {}), workers=1) as campaign:

        def values(x: FloatArray) -> FloatArray:
            outcomes = campaign.evaluate([space.values(u) for u in x], "benchmark", curves=False)
            return np.array([o.characteristics for o in outcomes])[:, FEW]

        designs = {
            (n, s): (x := hypercube(space, n, seed=s), values(x)) for n, seeds in SEEDS.items() for s in seeds
        }
        test = hypercube(space, TESTS, seed=99)
        started = time.process_time()
        tests = values(test)
        suite = (time.process_time() - started) / TESTS
        value = values(space.start[None])[0]
    started = time.process_time()
    slope = linearize(axle, space, space.start).characteristics[FEW]
    suites = (time.process_time() - started) / suite
    return Truth(designs, (test, tests), FirstOrderTrend(space.start, value, slope), suites)


def hypercube(space: Space, n: int, *, seed: int) -> FloatArray:
    """Plain, the same for every model."""
    return np.asarray(qmc.LatinHypercube(space.dimension, rng=np.random.default_rng(seed)).random(n))


def own(name: str, trend: FirstOrderTrend) -> Fit:
    def fit(x: FloatArray, y: FloatArray) -> Predictor:
        model = SlopeProcess(trend) if name == "gp_slopes" else make(name)
        fitted = model.fit(x, y)
        return lambda t: (fitted.predict(t), fitted.variance(t))

    return fit


def choice(trend: FirstOrderTrend | None) -> Fit:
    def fit(x: FloatArray, y: FloatArray) -> Predictor:
        model = fit_study(x, y, workers=1, trend=trend).model
        return lambda t: (model.predict(t), model.variance(t))

    return fit


def one_by_one(train: Callable[[FloatArray, FloatArray], Predictor]) -> Fit:
    """Standardised outputs, one model each."""

    def fit(x: FloatArray, y: FloatArray) -> Predictor:
        scaling = Scaling.of(y)
        models = [train(x, column) for column in scaling.standardise(y).T]

        def predict(t: FloatArray) -> tuple[FloatArray, FloatArray]:
            parts = [m(t) for m in models]
            mean = scaling.shift + scaling.scale * np.column_stack([p[0] for p in parts])
            return mean, scaling.scale**2 * np.column_stack([p[1] for p in parts])

        return predict

    return fit


def train_krg(x: FloatArray, y: FloatArray) -> Predictor:
    model = import_module("smt.surrogate_models").KRG(print_global=False, n_start=1, seed=1)
    model.set_training_values(x, y)
    model.train()
    return lambda t: (model.predict_values(t)[:, 0], model.predict_variances(t)[:, 0])


def train_kpls(x: FloatArray, y: FloatArray) -> Predictor:
    model = import_module("smt.surrogate_models").KPLS(print_global=False, n_comp=3, seed=1)
    model.set_training_values(x, y)
    model.train()
    return lambda t: (model.predict_values(t)[:, 0], model.predict_variances(t)[:, 0])


def train_scikit(x: FloatArray, y: FloatArray) -> Predictor:
    """Matern 5/2 with a length-scale a variable, and a linear kernel."""
    gp: Any = import_module("sklearn.gaussian_process")
    k: Any = import_module("sklearn.gaussian_process.kernels")
    d = x.shape[1]
    kernel = k.ConstantKernel(1.0, (1e-6, 1e4)) * k.Matern(np.full(d, np.sqrt(d)), (0.05, 1e3), nu=2.5)
    kernel = kernel + k.ConstantKernel(1.0, (1e-6, 1e4)) * k.DotProduct(1.0, (1e-3, 1e3))
    model = gp.GaussianProcessRegressor(kernel, alpha=1e-6).fit(x - 0.5, y)

    def predict(t: FloatArray) -> tuple[FloatArray, FloatArray]:
        mean, sd = model.predict(t - 0.5, return_std=True)
        return mean, sd**2

    return predict


def train_botorch(x: FloatArray, y: FloatArray) -> Predictor:
    """SingleTaskGP with its default kernel and priors for many variables."""
    torch: Any = import_module("torch")
    torch.set_num_threads(1)
    model: Any = import_module("botorch.models").SingleTaskGP(torch.tensor(x), torch.tensor(y)[:, None])
    mll = import_module("gpytorch.mlls").ExactMarginalLogLikelihood(model.likelihood, model)
    import_module("botorch.fit").fit_gpytorch_mll(mll)

    def predict(t: FloatArray) -> tuple[FloatArray, FloatArray]:
        with torch.no_grad():
            known = model.posterior(torch.tensor(t))
            return known.mean.numpy()[:, 0], known.variance.numpy()[:, 0]

    return predict


def models(known: Truth) -> dict[str, tuple[Fit, str]]:
    """Name -> fit and the module that it needs."""
    return {
        "choice of doe-kc": (choice(None), "doe_kc"),
        "choice of doe-kc, slopes at the start": (choice(known.trend), "doe_kc"),
        **{f"`{n}`": (own(n, known.trend), "doe_kc") for n in ("gp", "gp_ard", "gp_slopes")},
        "sparse polynomial chaos": (own("quadratic", known.trend), "doe_kc"),
        "scikit-learn": (one_by_one(train_scikit), "sklearn"),
        "BoTorch": (one_by_one(train_botorch), "botorch"),
        "SMT KPLS": (one_by_one(train_kpls), "smt"),
        "SMT KRG": (one_by_one(train_krg), "smt"),
    }


def row(name: str, fit: Fit, n: int, known: Truth) -> str:
    """Means over seeds and outputs; the error's standard deviation over seeds."""
    errors, covered, lowest, seconds = [], [], [], []
    x_test, y_test = known.test
    for seed in SEEDS[n]:
        x, y = known.designs[n, seed]
        started = time.process_time()
        predict = fit(x, y)
        seconds.append(time.process_time() - started)
        mean, variance = predict(x_test)
        missed = np.square(y_test - mean).mean(axis=0) / y_test.var(axis=0)
        errors.append(float(np.sqrt(missed).mean()))
        inside = (np.abs(y_test - mean) <= NOMINAL_WIDTH * np.sqrt(variance)).mean(axis=0)
        covered.append(float(inside.mean()))
        lowest.append(float(inside.min()))
    spread = f" ± {np.std(errors, ddof=1):.3f}" if len(errors) > 1 else ""
    return (
        f"| {name} | {n} | {np.mean(errors):.4f}{spread} | {np.mean(covered):.3f} | {min(lowest):.2f} | "
        f"{np.mean(seconds):.2f} |"
    )


def main() -> None:
    warnings.simplefilter("ignore")
    known = truth()
    lines: list[str] = []
    missing: list[str] = []
    for n in SEEDS:
        for name, (fit, module) in models(known).items():
            if find_spec(module) is None:
                missing.append(name)
            elif n <= MOST_ROWS.get(name, 400):
                lines.append(row(name, fit, n, known))
                sys.stderr.write(lines[-1] + "\n")
    d, m = known.trend.slope.shape[1], len(known.trend.value)
    publish(
        "surrogate_peers",
        [
            "# Surrogates beside their peers",
            "",
            f"Example axle, {d} variables, {m} of the 30 characteristics, plain Latin hypercubes (the same "
            f"for all), {TESTS} separate test designs. Error: mean over outputs of sqrt(1 - Q2), ± standard "
            f"deviation over {', '.join(f'{len(s)} seeds at {n}' for n, s in SEEDS.items())}. Coverage: of "
            "95 % intervals on the test designs, mean over all and the lowest of a single output. Seconds of "
            "a processor for all outputs; those of the choice hold its cross-validation. Slopes at the start "
            "cost as much as "
            f"{known.suites:.0f} designs. One thread. {machine()}.",
            "",
            "| model | designs | error | coverage | lowest | seconds |",
            "|---|---|---|---|---|---|",
            *lines,
            "",
            "Settings: scikit-learn Matern 5/2 with a length-scale a variable beside a linear kernel, alpha "
            "1e-6, one start; BoTorch SingleTaskGP with its default kernel, priors and fit; SMT KRG constant "
            "trend, one start (its default of ten takes ten times as long), KPLS three components, default "
            "starts; inputs in the unit cube, outputs standardised. Sparse polynomial chaos: Legendre terms "
            "of second order by least-angle regression, cross-validated. Left out where it takes minutes: "
            + "; ".join(f"{name} above {n}" for name, n in MOST_ROWS.items())
            + (f". Not installed: {', '.join(dict.fromkeys(missing))}." if missing else "."),
        ],
    )


if __name__ == "__main__":
    main()
