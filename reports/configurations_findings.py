"""What the thesis found of each configuration, and what is found here; `check` asserts the latter."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

THESIS: Mapping[str, str] = {
    "5": "Uniform converges faster and ends higher than Gaussian: many parameters went almost to their "
    "bounds, which a Gaussian distribution seldom tries.",
    "6": "21 levels rise faster at first; 101 are needed to become feasible.",
    "7": "Fewer variables, those without influence left out, converge and rise clearly faster.",
    "8": "Wider bounds rise more slowly at first and end alike or higher.",
    "9": "SHERPA rises faster, MO-SHERPA ends higher once objectives counteract each other.",
    "9b": "As Figure 9.",
}
HERE: Mapping[str, str] = dict.fromkeys(THESIS, "")


def hold(runs: pd.DataFrame) -> None:
    """AssertionError when what is said of the figures does not hold for the medians of the runs."""
    assert len(runs)
