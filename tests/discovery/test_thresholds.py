"""The page of thresholds is what the script prints of the module, and every number says what it is for."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import pytest

from doe_kc.discovery import thresholds

REPORTS = Path(__file__).parents[2] / "reports"


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(str(REPORTS))
    return importlib.import_module("thresholds")


def test_the_committed_page_is_what_the_script_prints(script: ModuleType) -> None:
    assert script.PAGE.read_text("utf-8") == script.page()


def test_every_number_has_unit_decision_and_reason(script: ModuleType) -> None:
    rows = list(script.thresholds_of(Path(str(thresholds.__file__)).read_text("utf-8")))
    numbers = {name for name in vars(thresholds) if name.isupper()}
    assert {r.name for r in rows} == numbers and len(rows) == len(numbers)
    assert all(r.section and r.unit and len(r.decides) > 10 and r.reason.endswith(".") for r in rows)


@pytest.mark.parametrize("words", ["", "-", "-, chance of a false alarm.", "chance. The usual level."])
def test_a_number_without_one_of_them_is_refused(script: ModuleType, words: str) -> None:
    with pytest.raises(ValueError, match="LEVEL"):
        list(script.thresholds_of(f'# Fit\n\nLEVEL = 0.05\n"""{words}"""\nOTHER = 1\n'))
