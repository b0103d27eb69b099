"""Results in order, some begun before they are asked for."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest

from doe_kc.ground.in_turn import AHEAD, in_turn


@pytest.mark.parametrize("threads", [0, 2])
def test_results_are_those_of_every_argument_in_order(threads: int) -> None:
    pool = ThreadPoolExecutor(threads) if threads else None
    assert list(in_turn(abs, [-3, 2, -1, 0], pool)) == [3, 2, 1, 0]
    assert list(in_turn(abs, [], pool)) == []


@pytest.mark.parametrize(("threads", "most"), [(0, 2), (1, 2 + AHEAD)])
def test_a_loop_that_stops_begins_with_no_more_than_some_ahead(threads: int, most: int) -> None:
    asked: list[int] = []

    def noted(number: int) -> int:
        asked.append(number)
        return number

    with ThreadPoolExecutor(1) as pool:
        results = in_turn(noted, range(9), pool if threads else None)
        assert [next(results), next(results)] == [0, 1]
        results.close()  # type: ignore[attr-defined]
    assert len(asked) <= most


def test_what_a_function_raises_comes_in_its_turn() -> None:
    with ThreadPoolExecutor(2) as pool:
        results = in_turn(lambda number: 1 / number, [2, 0, 1], pool)
        assert next(results) == 0.5
        with pytest.raises(ZeroDivisionError):
            next(results)
