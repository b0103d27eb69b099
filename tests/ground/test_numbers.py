"""Numbers for reading."""

from __future__ import annotations

import math

import pytest

from doe_kc.ground.numbers import at_sd, number, sd_format, short, signed, unit_words, with_sd


def test_four_significant_digits_without_an_exponent() -> None:
    read = [short(v) for v in (0.0, -4.0, 0.012345, 123456.0, math.nan)]
    assert read == ["0", "-4.000", "0.01235", "123456", "–"]


def test_no_digit_that_the_uncertainty_does_not_bear() -> None:
    assert with_sd(-395.1377, 0.6378) == "-395.14 ± 0.64"
    assert with_sd(5643.7, 1146.2) == "5600 ± 1100"
    assert with_sd(3195.2, 22.4) == "3195 ± 22"
    assert with_sd(0.05061, 0.00213) == "0.0506 ± 0.0021"
    assert with_sd(0.5, 1e-9) == "0.5000"


def test_a_value_alone_has_the_digits_of_its_deviation() -> None:
    assert [at_sd(0.0059985, 0.01), at_sd(-0.00001, 0.36), at_sd(5643.7, 1146.2)] == [
        "0.006",
        "0",
        "5600",
    ]
    assert [at_sd(1.25, math.nan), at_sd(math.nan, 0.1)] == ["1.250", "–"]


def test_a_value_without_a_sd_stands_alone() -> None:
    assert with_sd(1.25, math.nan) == with_sd(1.25, 0.0) == "1.250"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (math.nan, "–"),
        (131567.0, "132000"),
        (0.04567, "0.0457"),
        (9e7, "9e+07"),
        (-14.15, "-14.2"),
    ],
)
def test_numbers_read_well(value: float, text: str) -> None:
    assert number(value) in {text, text.replace("14.2", "14.1")}


@pytest.mark.parametrize(
    ("sd", "form"),
    [
        (1145.8, "0"),
        (12.3, "0"),
        (0.64, "0.00"),
        (0.0021, "0.0000"),
        (3e-6, "0.0000000"),
        (1e-9, "0.0000"),
        (math.nan, "0.0000"),
    ],
)
def test_a_sheet_shows_two_digits_of_the_deviation(sd: float, form: str) -> None:
    assert sd_format(sd) == form


def test_a_ratio_has_no_unit() -> None:
    assert [unit_words(u) for u in ("-", "", "N/mm")] == ["", "", " N/mm"]


def test_changes_have_signs_but_for_nothing() -> None:
    words = [signed(*pair) for pair in ((1.0, math.nan), (-1.0, 0.25), (-0.001, math.nan), (-0.001, 0.28))]
    assert words == ["+1.00", "\N{MINUS SIGN}1.00 ± 0.25", "0.00", "0.00 ± 0.28"]
