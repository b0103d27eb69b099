"""One thread for linear algebra: many test processes share the cores, and the matrices are small."""

from __future__ import annotations

import os

from threadpoolctl import threadpool_limits

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")
threadpool_limits(1)
