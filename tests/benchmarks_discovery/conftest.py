"""Hidden cars that several tests look at, drawn once."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.discovery.generator import HiddenCar, hidden_car


@pytest.fixture(scope="session")
def plain() -> HiddenCar:
    """Nothing hidden, no clutter, a rig without loops of its own and without bad samples."""
    return hidden_car(3, "null", clutter_in=False, faults=False)


@pytest.fixture(scope="session")
def plain_folder(plain: HiddenCar, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What an analyser gets of it."""
    return plain.write(tmp_path_factory.mktemp("plain"))
