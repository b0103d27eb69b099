"""How the files of tests are shared by worker processes."""

from __future__ import annotations

from tests.conftest import LONGEST, SMALL_CARS, TESTS, group_of, rank_of


def test_what_starts_first_is_there() -> None:
    assert LONGEST[0] == SMALL_CARS
    for name in LONGEST[1:]:
        assert group_of(TESTS / name) == name


def test_files_that_look_at_small_cars_are_one() -> None:
    files = ("discovery/test_discover.py", "workflow/test_adopt.py", "reports/discovery/test_figures.py")
    assert {group_of(TESTS / name) for name in files} == {SMALL_CARS}
    assert group_of(TESTS / "ground/test_numbers.py") == "ground/test_numbers.py"


def test_longest_files_come_before_all_others() -> None:
    files = [*(TESTS / name for name in reversed(LONGEST[1:])), TESTS / "ground/test_numbers.py"]
    files.sort(key=lambda file: rank_of(group_of(file)))
    assert [group_of(file) for file in files] == [*LONGEST[1:], "ground/test_numbers.py"]
