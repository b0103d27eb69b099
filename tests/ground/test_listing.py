"""Lists in sentences."""

from __future__ import annotations

import pytest

from doe_kc.ground.listing import first_of


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ([], ""),
        (["a"], "a"),
        (["a", "b"], "a, b"),
        (["a", "b", "c"], "a, b and 1 more"),
        (["a", "b", "c", "d"], "a, b and 2 more"),
    ],
)
def test_of_many_words_the_first_stand_and_the_others_are_counted(words: list[str], expected: str) -> None:
    assert first_of(words, 2) == expected


def test_parts_that_hold_commas_are_parted_by_another_sign() -> None:
    assert first_of(["a, b", "c", "d"], 2, separator="; ") == "a, b; c and 1 more"
