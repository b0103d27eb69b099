"""Points in the unit cube, the same as those of `scipy.stats.qmc`, whose import takes longer than a search.

References: M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21(2), 1979 (Latin hypercube);
I. M. Sobol, USSR Comput. Math. Math. Phys. 7(4), 1967; direction numbers: S. Joe, F. Y. Kuo, SIAM J. Sci.
Comput. 30(5), 2008, criterion 6; scrambling: J. Matousek, J. Complexity 14(4), 1998.
"""

from __future__ import annotations

import numpy as np

from doe_kc.ground.typing import FloatArray

BITS = 30
"""Of a coordinate."""
POWER_LEVELS = 6
"""Direction numbers a dimension that the table has: enough for 2^6 points."""
DIRECTIONS = (
    "0000663d2fa33bd16fe8130a4975121468944a6e3404554847d560e32ab8637108f831b97a541eef1db744f2302545317b51"
    "526c184d243625973b2202f5758f688942d4781e79a66c531bf977fd1569576916be3f0f16412a64402f11cb4def3d4256c8"
    "221f7f5155522395006b4e101f112168392c5a7c27df1ec81ff45f326aa80d6e1a140ef655051bf27c83240a3edc6a2c1810"
    "703a54e935c17b4d040c709214e8775361655ac60ad214fe190f4e79400055f9364e448b351b2162733f6d06367356cd0954"
    "4b9b08b94c960d195d321a7776557fcc4da622993c47782c793339de13215ff573ca71871a986624599f72c75e2a29536dcc"
    "2c25609f509b2e1f4d7207a238214eb17e0e417771947f5a3ac26f3a24d96f0b2330635e0ac5795b0dba3c87541a00b32592"
    "241f302072f92bbc5a53793533690e6b4ea651f604d8637b2c6f20fc217478014236076a531f4563645903523b3b11810c66"
    "63261ece698a38fa336808bf550703334ac03bca6c9744062d8e310f3992738d2b93093f71f556380ef84df71aef367f3389"
    "17560b111d5169624d40212f5681310e29616f5e524c4031149e468148644833782a7f18556c05147eb813742751758c35bb"
    "56fd06ad3df61c7e326636a42514324a2d8233383a227fa33cff0b37328b01601a4c11b56481727a13472ff91d766cdd28e5"
    "1acf642a766343c618880650"
)
"""Four hexadecimal digits a dimension: the odd direction numbers m_2 ... m_6, each halved, in 1 to 5 bits
from the lowest one."""
DIMENSIONS = len(DIRECTIONS) // 4


def latin_hypercube(n: int, dimension: int, seed: int) -> FloatArray:
    """(n, dimension) points in [0, 1), one in each of n slices of every coordinate."""
    rng = np.random.default_rng(seed).spawn(1)[0]
    inside = rng.uniform(size=(n, dimension))
    slices = np.tile(np.arange(1, n + 1), (dimension, 1))
    for row in slices:
        rng.shuffle(row)
    out: FloatArray = (slices.T - inside) / n
    return out


def scrambled_sobol(levels: int, dimension: int, seed: int) -> FloatArray:
    """(2^levels, dimension) points in [0, 1) of Sobol's sequence, scrambled linearly and shifted."""
    if levels > POWER_LEVELS or dimension > DIMENSIONS:
        from scipy.stats import qmc

        engine = qmc.Sobol(dimension, rng=np.random.default_rng(seed))
        return np.asarray(engine.random_base2(levels))
    rng = np.random.default_rng(seed).spawn(1)[0]
    shift = rng.integers(2, size=(dimension, BITS), dtype=np.uint32) @ 2 ** np.arange(BITS, dtype=np.uint32)
    lower = np.tril(rng.integers(2, size=(dimension, BITS, BITS), dtype=np.uint32))
    lower[:, range(BITS), range(BITS)] = 1
    places = np.arange(BITS - 1, -1, -1, dtype=np.uint32)
    bits = _directions(dimension)[:, :, None] >> places & 1
    scrambled = np.einsum("dpi,dji->djp", lower, bits) % 2 @ (np.uint32(1) << places)
    points = [shift]
    for k in range(2**levels - 1):
        lowest_zero = (~k & k + 1).bit_length() - 1  # Gray code: one direction more or less a point
        points.append(points[-1] ^ scrambled[:, lowest_zero])
    return np.array(points) * 0.5**BITS


def _directions(dimension: int) -> np.ndarray:
    """(dimension, POWER_LEVELS) m_k 2^(BITS - k)."""
    out = np.empty((dimension, POWER_LEVELS), dtype=np.uint32)
    for d in range(dimension):
        code = int(DIRECTIONS[4 * d : 4 * d + 4], 16)
        odd = [1, *(2 * (code >> k * (k - 1) // 2 & 2**k - 1) + 1 for k in range(1, POWER_LEVELS))]
        out[d] = [m << BITS - 1 - k for k, m in enumerate(odd)]
    return out
