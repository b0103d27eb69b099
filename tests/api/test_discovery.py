"""Discoveries of the Python API."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import doe_kc as kc
from tests.api.cases import HUB, SMALL_LIBRARY, small_library


@pytest.fixture(scope="module")
def steps() -> list[tuple[str, int, int]]:
    return []


@pytest.fixture(scope="module")
def result(folder: Path, steps: list[tuple[str, int, int]]) -> kc.DiscoveryResult:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("doe_kc.workflow.discover.effect_library", small_library)
        return kc.discover(folder, workers=1, progress=lambda *step: steps.append(step))


def test_it_names_what_is_hidden(result: kc.DiscoveryResult, folder: Path) -> None:
    assert result.verdict == "named" and "hub" in result.sentences[0]
    sizes = result.effects.set_index("size")
    error = sizes.loc["camber_Nm_deg", "value"] - HUB["camber_Nm_deg"]
    assert abs(error) < 3.0 * sizes.loc["camber_Nm_deg", "sd"]
    assert list(result.axle.effects) == ["hub_compliance"]
    assert set(result.library["effect"]) == {*SMALL_LIBRARY}
    assert len(result.held_out) == 2 and result.gap.with_effect < 1.2 < result.gap.tuned
    assert "ROB.z" in set(result.parameters.iloc[:, 0])
    assert not (folder / "out").exists()


def test_it_says_it_shortly(result: kc.DiscoveryResult) -> None:
    assert repr(result).startswith("DiscoveryResult: Effect named. ") and len(repr(result)) < 1200
    assert len(repr(result.discovery)) < 200
    assert "hub_compliance" in result._repr_html_()


def test_its_progress(result: kc.DiscoveryResult, steps: list[tuple[str, int, int]]) -> None:
    done, total = ([step[k] for step in steps] for k in (1, 2))
    assert len(steps) > 3 and done == sorted(done) and total == sorted(total)
    assert all(d <= t for d, t in zip(done, total, strict=True))


def test_its_picture(result: kc.DiscoveryResult) -> None:
    axes = result.plot()
    lines = {line.get_label(): np.asarray(line.get_xdata()) for line in axes.get_lines()}
    assert len(axes.get_yticks()) == len(result.discovery.gaps) == len(lines["as handed in"])
    assert np.median(lines["with the effect"]) < np.median(lines["as handed in"])


def test_an_unknown_effect(folder: Path) -> None:
    with pytest.raises(kc.InputError, match="hub_compliance"):
        kc.discover(folder, exclude=["hub_complianse"])
