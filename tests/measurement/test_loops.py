from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from doe_kc.ground.errors import InputError
from doe_kc.measurement.loops import split_loop
from tests.measurement.synthetic import triangle


def sine(samples: int) -> np.ndarray:
    return np.cos(2.0 * np.pi * np.arange(samples) / samples)


def test_the_standard_loop_splits_in_half() -> None:
    loop = split_loop(triangle(), label="f")
    assert loop.unload[0] == 0 and loop.unload[-1] == 256
    assert loop.load[0] == 256 and loop.load[-1] == 0  # closed by its first sample
    assert loop.load.size == 257


@settings(max_examples=60, deadline=None)
@given(
    st.integers(64, 700),
    st.floats(0.0, 1.0),
    st.floats(0.0, 0.004),
    st.booleans(),
    st.integers(0, 2**31),
)
def test_any_phase_shape_and_noise_gives_two_whole_branches(
    samples: int, phase: float, noise: float, smooth: bool, seed: int
) -> None:
    shape = sine(samples) if smooth else triangle(samples)
    rng = np.random.default_rng(seed)
    values = np.roll(shape, int(phase * samples)) + noise * rng.normal(size=samples)
    loop = split_loop(values, label="f")
    for branch, way in ((loop.unload, -1.0), (loop.load, 1.0)):
        assert way * (values[branch[-1]] - values[branch[0]]) > 1.8
        assert branch.size >= 0.45 * samples


def test_of_several_cycles_the_last_full_one_counts() -> None:
    values = np.concatenate([np.tile(triangle(200), 3), triangle(200)[:60]])
    loop = split_loop(values, label="f")
    assert min(loop.unload.min(), loop.load.min()) >= 300
    assert max(loop.unload.max(), loop.load.max()) <= 600


def test_a_run_in_from_zero_is_left_out() -> None:
    values = np.concatenate([np.linspace(0.0, 1.0, 60, endpoint=False), triangle(200), [1.0]])
    loop = split_loop(values, label="f")
    assert loop.unload[0] == 60 and loop.load[-1] == 260


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (np.linspace(-1.0, 1.0, 200), "no loop"),
        (np.concatenate([np.linspace(0, 1, 100), np.linspace(0, -1, 100)]), "no loop|turns back"),
        (triangle(400)[:300], "no loop"),
    ],
)
def test_what_is_no_loop_is_refused(values: np.ndarray, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        split_loop(values, label="file.csv")
    assert str(caught.value).startswith("file.csv: ")


def test_a_reversal_is_refused_with_its_sample() -> None:
    values = triangle(400)
    values[100:130] = values[100] + np.linspace(0.0, 0.4, 30)
    with pytest.raises(InputError, match=r"turns back at sample \d+"):
        split_loop(values, label="f")


def test_a_noisy_input_is_not_monotone() -> None:
    values = triangle(512) + 0.04 * np.random.default_rng(1).normal(size=512)
    with pytest.raises(InputError, match=r"not monotone|turns back"):
        split_loop(values, label="f")
