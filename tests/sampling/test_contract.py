"""Every registered sampler: inside the bounds, on the levels, by the distribution, seeded."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from doe_kc.axle import design_parameters, with_values
from doe_kc.axle.design_parameters import Parameter
from doe_kc.ground.errors import InputError
from doe_kc.sampling import SAMPLERS, Design, Sampler, sample
from doe_kc.sampling._base import sampler
from doe_kc.sampling.latin_hypercube import SPREAD_UP_TO
from doe_kc.variables import Change, Space, VariableOptions, build_space
from tests.reference import nominal

pytestmark = pytest.mark.usefixtures("few_exchanges")
N = 64
MANY = 1024
"""More designs than are kept apart, which moves none within its variable."""
IDS = sorted(SAMPLERS)


def space(*, levels: int | None = None, gaussian: bool = False) -> Space:
    """Two hardpoint coordinates, a stiffness, a rate; one tied and one fixed parameter."""
    options = VariableOptions(
        use=["LLF.z", "LLF.x", "llr.Fx", "spring.rate"],
        levels=levels or "continuous",
        distribution="gaussian" if gaussian else "uniform",
        change=[
            Change(match="LLR.z", tie="LLF.z"),
            Change(match="tyre.rate", fixed=210.0),
            Change(match="LLF.x", offset=[-2.0, 4.0]),
        ],
    )
    return build_space(nominal(), options, "test")


def drawn(ident: str, where: Space, folder: Path, *, n: int = N, seed: int = 1) -> Design:
    """n designs, or as many as the method has of its own; the table holds those of a hypercube."""
    table = None
    if ident == "table":
        table = folder / "designs.csv"
        rows = sample(where, n, seed=seed)
        columns = [rows.paths.index(p) for p in where.paths]
        lines = [",".join(where.paths), *(",".join(map(repr, map(float, r[columns]))) for r in rows.values)]
        table.write_text("\n".join(lines))
    return sample(where, n, seed=seed, method=ident, table=table)


def units(design: Design, where: Space) -> np.ndarray:
    return np.array([where.unit(row) for row in design.rows()])


def test_the_methods_that_there_are() -> None:
    assert IDS == ["full_factorial", "lhs", "one_at_a_time", "sobol", "table"]
    assert all(s.id == i for i, s in SAMPLERS.items())
    with pytest.raises(ValueError, match="registered twice"):
        sampler(type("Again", (Sampler,), {"id": "lhs"}))
    with pytest.raises(InputError, match=r"'lhd' is no sampling method; known are .*Did you mean \"lhs\""):
        sample(space(), 3, seed=1, method="lhd")


@pytest.mark.parametrize("ident", IDS)
def test_shape_columns_and_labels(ident: str, tmp_path: Path) -> None:
    where = space()
    design = drawn(ident, where, tmp_path)
    expected = {"one_at_a_time": 9, "full_factorial": 81}.get(ident, N)
    assert design.method == ident
    assert design.paths == (*where.paths, "LLR.z", "tyre.rate")
    assert design.values.shape == (expected, 6) and len(design.labels) == expected
    assert len(set(design.labels)) == expected
    assert design.seed == (1 if SAMPLERS[ident].seeded else None)
    assert SAMPLERS[ident].sized == (ident in {"lhs", "sobol"})
    for row in design.rows():
        assert row["tyre.rate"] == 210.0
        assert row["LLR.z"] - row["LLF.z"] == pytest.approx(where.ties[0].value(0.0))
        with_values(nominal(), row)


@pytest.mark.parametrize("ident", IDS)
@pytest.mark.parametrize("levels", [2, 5, 101, None])
def test_inside_the_bounds_and_on_the_levels(ident: str, levels: int | None, tmp_path: Path) -> None:
    where = space(levels=levels)
    found = units(drawn(ident, where, tmp_path), where)
    assert found.min() > -1e-12 and found.max() < 1.0 + 1e-12
    if levels is not None:
        steps = found * (levels - 1)
        np.testing.assert_allclose(steps, np.round(steps), atol=1e-8)
    assert (np.ptp(found, axis=0) > 0.1).all() or ident == "one_at_a_time"
    assert (np.ptp(found, axis=0) > 0).all()


@pytest.mark.parametrize("ident", IDS)
def test_the_seed_decides(ident: str, tmp_path: Path) -> None:
    where = space()
    first, again, other = (drawn(ident, where, tmp_path, seed=s).values for s in (7, 7, 8))
    np.testing.assert_array_equal(first, again)
    assert (np.abs(first - other).max() > 0) == (SAMPLERS[ident].seeded or ident == "table")


@pytest.mark.parametrize("ident", ["lhs", "sobol"])
@pytest.mark.parametrize("n", [128, MANY])
def test_uniform_and_gaussian(ident: str, n: int, tmp_path: Path) -> None:
    """Means and spreads within a tenth of what chance alone would leave uncertain."""
    assert MANY > SPREAD_UP_TO
    for gaussian in (False, True):
        where = space(gaussian=gaussian)
        found = units(drawn(ident, where, tmp_path, n=n), where)
        middle = [0.342, 0.5, 0.5, 0.5] if gaussian else [0.5] * 4  # cut off two deviations below its start
        np.testing.assert_allclose(found.mean(axis=0), middle, atol=0.012)
        spread = [0.1566, 0.1643, 0.1643, 0.1643] if gaussian else where.prior_sd
        np.testing.assert_allclose(found.std(axis=0), spread, rtol=0.03)
        inner = (np.abs(found - middle) < 1.0 / 6.0).mean(axis=0)
        np.testing.assert_allclose(inner, 0.683 if gaussian else 1.0 / 3.0, atol=0.03)


@pytest.mark.parametrize("ident", ["lhs", "sobol"])
@pytest.mark.parametrize("n", [1, 3, 100])
def test_any_number(ident: str, n: int, tmp_path: Path) -> None:
    assert drawn(ident, space(), tmp_path, n=n).values.shape[0] == n


def test_stiffnesses_are_even_in_their_logarithm() -> None:
    column = [row["llr.Fx"] for row in sample(space(), MANY, seed=1).rows()]
    assert (np.array(column) < 1.0).mean() == pytest.approx(0.5, abs=0.002)


def parameters() -> list[Parameter]:
    return design_parameters(nominal())


def test_a_step_is_the_parameters_own() -> None:
    where = build_space(nominal(), VariableOptions(levels="continuous"), "test")
    design = sample(where, 1, seed=1, method="one_at_a_time")
    base = design.values[0]
    steps = {p.path: p.step for p in parameters()}
    for i, variable in enumerate(where.variables):
        up, down = design.values[1 + 2 * i] - base, design.values[2 + 2 * i] - base
        for change, sign in ((up, 1.0), (down, -1.0)):
            assert np.flatnonzero(np.abs(change) > 1e-9).tolist() == [i]
            assert change[i] == pytest.approx(sign * steps[variable.path], rel=1e-9)
    assert design.labels[:2] == ("start", "LLF.x +1 mm")


def test_a_step_stops_at_the_bound_and_moves_to_the_next_level() -> None:
    where = space(levels=3)
    tight = replace(where, variables=tuple(replace(v, start=v.upper) for v in where.variables))
    for each, ups in ((where, 0.5), (tight, 0.0)):
        found = units(sample(each, 1, seed=1, method="one_at_a_time"), each)
        changes = found[1:] - found[0]
        for i in range(each.dimension):
            assert changes[2 * i, i] == pytest.approx(ups, abs=1e-9)
            assert changes[2 * i + 1, i] == pytest.approx(-0.5, abs=1e-9)


def test_a_factorial_is_every_combination() -> None:
    where = space()
    design = sample(where, 1, seed=1, method="full_factorial", levels=2)
    found = np.round(units(design, where), 9)
    assert sorted(map(tuple, found)) == sorted({tuple(map(float, f"{i:04b}")) for i in range(16)})
    assert sample(space(levels=2), 1, seed=1, method="full_factorial", levels=5).values.shape[0] == 16


def test_a_factorial_that_is_too_large_says_how_large() -> None:
    where = build_space(nominal(), VariableOptions(use=["LL?.*"]), "test")
    with pytest.raises(InputError, match=r"6 variables with 10 levels has 1e\+06 designs, more than 20000"):
        sample(where, 1, seed=1, method="full_factorial", levels=10)
    whole = build_space(nominal(), VariableOptions(), "test")
    with pytest.raises(InputError, match="fewer variables or levels"):
        sample(whole, 1, seed=1, method="full_factorial", levels=1000)
