"""Points in the unit cube beside those of SciPy."""

import numpy as np
import pytest
from scipy.stats import qmc

from doe_kc.correlation.modelled.unit_samples import DIMENSIONS, latin_hypercube, scrambled_sobol


@pytest.mark.parametrize("dimension", [1, 2, 37, DIMENSIONS, DIMENSIONS + 1])
@pytest.mark.parametrize("levels", [0, 3, 6, 7])
def test_sobol_is_that_of_scipy(dimension: int, levels: int) -> None:
    peer = qmc.Sobol(dimension, rng=np.random.default_rng(dimension))
    np.testing.assert_array_equal(scrambled_sobol(levels, dimension, dimension), peer.random(2**levels))


@pytest.mark.parametrize("n", [1, 2, 9])
def test_latin_hypercube_is_that_of_scipy(n: int) -> None:
    peer = qmc.LatinHypercube(12, rng=np.random.default_rng(n))
    np.testing.assert_array_equal(latin_hypercube(n, 12, n), peer.random(n))
