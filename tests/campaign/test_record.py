"""Designs are told apart by their numbers, not by rounding or order."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from doe_kc.campaign.record import design_key
from doe_kc.ground.errors import InputError

NUMBER = st.floats(min_value=1e-6, max_value=1e6) | st.floats(min_value=-1e6, max_value=-1e-6)


def test_rounding_noise_and_order_make_no_other_design() -> None:
    assert design_key({"a": 0.1 + 0.2, "b": 1.0}) == design_key({"b": 1, "a": 0.3})
    assert design_key({"a": -0.0}) == design_key({"a": 0.0})
    assert len(design_key({})) == 64


def test_other_values_and_paths_do() -> None:
    keys = [{"a": 1.0}, {"a": 1.0 + 1e-10}, {"b": 1.0}, {"a": 1.0, "b": 1.0}, {"a": -1.0}, {}]
    assert len({design_key(k) for k in keys}) == len(keys)


@given(NUMBER)
def test_a_part_in_ten_to_the_fourteen_is_the_same_and_one_in_ten_to_the_ten_is_not(x: float) -> None:
    settled = float(f"{x:.10g}")
    assert design_key({"x": settled}) == design_key({"x": settled * (1 + 1e-14)})
    assert design_key({"x": settled}) != design_key({"x": settled * (1 + 1e-10)})


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_no_key_without_a_number(value: float) -> None:
    with pytest.raises(InputError, match=r"LLF\.x = (nan|inf), expected a finite number"):
        design_key({"LLF.x": value})
