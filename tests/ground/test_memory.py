"""Large arrays that are freed are given back, however many small ones lie between them."""

from __future__ import annotations

import subprocess
import sys

import pytest

SCRIPT = """
import numpy as np
from doe_kc.ground.memory import return_large_arrays

def resident() -> int:
    return int(open("/proc/self/statm").read().split()[1]) * 4096

return_large_arrays()
np.ones(4_000_000)  # freed: glibc would take the next ones from its heap
before, kept = resident(), []
large = []
for _ in range(20):
    large.append(np.ones(500_000))
    kept.append(np.ones(5_000))
assert resident() - before > 60e6
large.clear()
assert resident() - before < 10e6
"""


@pytest.mark.skipif(sys.platform != "linux", reason="asks glibc")
def test_freed_arrays_leave_no_holes() -> None:
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


KEPT = """
import resource
import numpy as np
from doe_kc.ground.memory import return_large_arrays

def pages() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt

def used() -> None:
    [np.ones(100_000) for _ in range(20)]  # 16 MB, each less than a large array

return_large_arrays()
used()
before = pages()
for _ in range(10):
    used()
assert pages() - before < 3000, pages() - before  # 16 MB are 4000
"""


@pytest.mark.skipif(sys.platform != "linux", reason="asks glibc")
def test_free_memory_at_the_end_of_the_heap_is_used_again() -> None:
    """Given back after each array it was asked for again, 8 million pages in a search of five effects."""
    done = subprocess.run([sys.executable, "-c", KEPT], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
