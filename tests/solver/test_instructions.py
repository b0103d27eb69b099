"""How many lanes a processor has."""

from __future__ import annotations

import pytest

from doe_kc.solver.instructions import instruction_set, own_instruction_set

GLIBC = ("glibc", "2.36")


@pytest.mark.parametrize(
    ("features", "libc", "lanes", "library"),
    [
        ("avx512f avx512dq avx512vl fma avx2", GLIBC, 8, True),
        ("avx512f fma avx2", GLIBC, 4, True),
        ("avx2 fma", ("glibc", "2.31"), 4, False),
        ("avx2 fma", ("", ""), 4, False),
        ("sse2", GLIBC, 4, False),
        ("", GLIBC, 4, False),
    ],
)
def test_lanes_follow_from_the_processor(
    features: str, libc: tuple[str, str], lanes: int, library: bool
) -> None:
    found = instruction_set(frozenset(features.split()), libc)
    assert (found.lanes, found.library) == (lanes, library)
    assert f"LANES {lanes}" in found.defines
    assert ("-lmvec" in found.build_flags["link"]) == library


def test_different_instruction_sets_have_different_libraries() -> None:
    sets = [instruction_set(frozenset(f.split()), GLIBC) for f in ("", "avx2 fma")]
    assert sets[0].name != sets[1].name
    assert own_instruction_set() is own_instruction_set()
