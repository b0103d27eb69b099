"""One small study for all tests of the Python API."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import matplotlib
import pytest

from tests.api.cases import small_library, write_example


@pytest.fixture(scope="package")
def example_root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with `examples/front_axle`, small."""
    root = tmp_path_factory.mktemp("repository")
    write_example(root)
    return root


@pytest.fixture(scope="package")
def folder(example_root: Path) -> Path:
    """The small study's folder."""
    return example_root / "examples" / "front_axle"


@pytest.fixture(autouse=True)
def _small(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A small library of effects, one process, and figures that need no display and are closed."""
    from matplotlib import pyplot

    monkeypatch.setattr("doe_kc.workflow.discover.effect_library", small_library)
    monkeypatch.setattr("os.sched_getaffinity", lambda _: {0}, raising=False)
    backend = matplotlib.get_backend()
    pyplot.switch_backend("agg")
    yield
    pyplot.close("all")
    pyplot.switch_backend(backend)
