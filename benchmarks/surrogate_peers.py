"""Surrogates of the example axle beside SMT, scikit-learn, BoTorch and sparse polynomials.

`python benchmarks/surrogate_peers.py [MODEL ...]`, one thread, half an hour. Peers that are not installed are
left out. Rows are kept in results/surrogate_peers.csv as they come; one that is there is not measured again,
except for the models named.
"""

from __future__ import annotations

import csv
import sys
import time
import warnings
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from _common import RESULTS, example_axle, machine, publish

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

SEEDS = {50: (11, 12, 13), 100: (11, 12), 200: (11,), 400: (11,)}
"""Designs that no setting of a model was chosen on; nor were the tests."""
TESTS, TEST_SEED = 500, 199
ROWS = RESULTS / "surrogate_peers.csv"
FEW = slice(None, None, 6)
"""Five of the thirty characteristics, which everyone is measured on: some peers take minutes an output."""
MOST_ROWS = {"SMT KRG": 50}
FEWER_SEEDS = {"SMT KRG": 1}
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
            return np.array([o.characteristics for o in outcomes])

        designs = {
            (n, s): (x := hypercube(space, n, seed=s), values(x)) for n, seeds in SEEDS.items() for s in seeds
        }
        test = hypercube(space, TESTS, seed=TEST_SEED)
        started = time.process_time()
        tests = values(test)
        suite = (time.process_time() - started) / TESTS
        value = values(space.start[None])[0]
    started = time.process_time()
    slope = linearize(axle, space, space.start).characteristics
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


@dataclass(frozen=True)
class Contender:
    """module: needed. whole: fitted to all characteristics at once, as the package does; else to the five."""

    fit: Fit
    module: str
    whole: bool = True


def contenders(known: Truth) -> dict[str, Contender]:
    """By name, the slowest last."""
    return {
        "choice of doe-kc": Contender(choice(None), "doe_kc"),
        "choice of doe-kc, slopes at the start": Contender(choice(known.trend), "doe_kc"),
        **{f"`{n}`": Contender(own(n, known.trend), "doe_kc") for n in ("gp", "gp_ard", "gp_slopes")},
        "sparse polynomial chaos": Contender(own("quadratic", known.trend), "doe_kc", whole=False),
        "scikit-learn": Contender(one_by_one(train_scikit), "sklearn", whole=False),
        "BoTorch": Contender(one_by_one(train_botorch), "botorch", whole=False),
        "SMT KPLS": Contender(one_by_one(train_kpls), "smt", whole=False),
        "SMT KRG": Contender(one_by_one(train_krg), "smt", whole=False),
    }


@dataclass(frozen=True)
class Row:
    """Means over seeds and outputs. spread: standard deviation of the error over several seeds. every: error
    over all characteristics, of models that are fitted to all. seconds: of a processor, an output.
    """

    model: str
    designs: int
    error: float
    spread: float | None
    every: float | None
    coverage: float
    lowest: float
    within: float
    seconds: float

    def __str__(self) -> str:
        spread = "" if self.spread is None else f" ± {self.spread:.3f}"
        every = "" if self.every is None else f"{self.every:.4f}"
        return (
            f"| {self.model} | {self.designs} | {self.error:.4f}{spread} | {every} | {self.coverage:.3f} | "
            f"{self.lowest:.2f} | {self.within:.2f} | {self.seconds:.3f} |"
        )


def measured(name: str, one: Contender, n: int, known: Truth) -> Row:
    errors, every, inside, seconds = [], [], [], []
    x_test, y_test = known.test
    few = np.arange(y_test.shape[1])[FEW]
    for seed in SEEDS[n][: FEWER_SEEDS.get(name)]:
        x, y = known.designs[n, seed]
        wanted = y if one.whole else y[:, few]
        started = time.process_time()
        predict = one.fit(x, wanted)
        seconds.append((time.process_time() - started) / wanted.shape[1])
        mean, variance = predict(x_test)
        true = y_test if one.whole else y_test[:, few]
        missed = np.sqrt(np.square(true - mean).mean(axis=0) / true.var(axis=0))
        errors.append(float((missed[few] if one.whole else missed).mean()))
        every.append(float(missed.mean()))
        inside.append((np.abs(true - mean) <= NOMINAL_WIDTH * np.sqrt(variance)).mean(axis=0))
    covered = np.array(inside)
    return Row(
        model=name,
        designs=n,
        error=float(np.mean(errors)),
        spread=float(np.std(errors, ddof=1)) if len(errors) > 1 else None,
        every=float(np.mean(every)) if one.whole else None,
        coverage=float(covered.mean()),
        lowest=float(covered.min()),
        within=float((np.abs(covered - 0.95) <= 0.03).mean()),
        seconds=float(np.mean(seconds)),
    )


def stored() -> dict[tuple[int, str], Row]:
    """Rows of earlier runs by designs and model."""
    if not ROWS.is_file():
        return {}

    def number(text: str) -> float | None:
        return float(text) if text else None

    with ROWS.open(encoding="utf-8", newline="") as file:
        rows = [
            Row(r["model"], int(r["designs"]), float(r["error"]), number(r["spread"]), number(r["every"]),
                *(float(r[k]) for k in ("coverage", "lowest", "within", "seconds")))
            for r in csv.DictReader(file)
        ]  # fmt: skip
    return {(r.designs, r.model): r for r in rows}


def keep(rows: dict[tuple[int, str], Row]) -> None:
    with ROWS.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, [f.name for f in fields(Row)])
        table.writeheader()
        table.writerows({k: "" if v is None else v for k, v in asdict(r).items()} for r in rows.values())


def main() -> None:
    warnings.simplefilter("ignore")
    known = truth()
    field = contenders(known)
    missing = [name for name, one in field.items() if find_spec(one.module) is None]
    for module in ("smt.surrogate_models", "sklearn.gaussian_process", "botorch.models"):
        if find_spec(module.partition(".")[0]) is not None:
            import_module(module)  # seconds that are no model's
    again = set(sys.argv[1:]) & set(field)
    rows = {key: row for key, row in stored().items() if row.model not in again}
    for n in SEEDS:
        for name, one in field.items():
            if name not in missing and n <= MOST_ROWS.get(name, 400) and (n, name) not in rows:
                rows[n, name] = measured(name, one, n, known)
                keep(rows)
                sys.stderr.write(f"{rows[n, name]}\n")
    lines = [str(rows[n, name]) for n in SEEDS for name in field if (n, name) in rows]
    d, m = known.trend.slope.shape[1], len(known.trend.value)
    publish(
        "surrogate_peers",
        [
            "# Surrogates beside their peers",
            "",
            f"`python benchmarks/surrogate_peers.py`. Example axle, {d} variables, plain Latin hypercubes "
            f"(the same for all), {TESTS} separate test designs. Error: mean over the same five "
            f"characteristics of sqrt(1 - Q2), ± standard deviation over the seeds "
            f"({', '.join(f'{len(s)} at {n}' for n, s in SEEDS.items())}; SMT KRG one); all: over all {m}. "
            f"The models of doe-kc are fitted to all {m} at once, as its command does, the others to the "
            "five. Coverage: of 95 % intervals on the test designs, mean over the outputs, the lowest of a "
            "single one, and the share of outputs with 0.95 ± 0.03; models under their own names are not "
            "calibrated, the choice is. Seconds of a processor an output; those of the choice hold its "
            f"cross-validation. Slopes at the start cost as much as {known.suites:.0f} designs. One thread, "
            f"niced, other work on the machine. {machine()}.",
            "",
            "| model | designs | error | all | coverage | lowest | within | seconds an output |",
            "|---|---|---|---|---|---|---|---|",
            *lines,
            "",
            "Settings: scikit-learn Matern 5/2 with a length-scale a variable beside a linear kernel, alpha "
            "1e-6, one start; BoTorch SingleTaskGP with its default kernel, priors and fit; SMT KRG constant "
            "trend, one start (its default of ten takes ten times as long), KPLS three components, default "
            "starts; inputs in the unit cube, outputs standardised. Sparse polynomial chaos: Legendre terms "
            "of second order by least-angle regression, cross-validated (`quadratic`)."
            + "".join(f" Left out, as it takes minutes: {k} above {n}." for k, n in MOST_ROWS.items())
            + (f" Not installed: {', '.join(missing)}." if missing else ""),
        ],
    )


if __name__ == "__main__":
    main()
