"""How many designs this machine's processor computes side by side, and the compiler flags for that."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

PROCESSOR_FILE = Path("/proc/cpuinfo")
AVX512 = frozenset({"avx512f", "avx512dq", "avx512vl", "fma"})
AVX2 = frozenset({"avx2", "fma"})
VECTOR_LIBRARY_SINCE = (2, 35)
"""glibc whose vector library has every function of lanes.h."""


@dataclass(frozen=True)
class InstructionSet:
    """lanes: designs side by side. flags: of the compiler. library: whether there is glibc's libmvec."""

    lanes: int
    flags: tuple[str, ...]
    library: bool

    def of_lanes(self, count: int) -> InstructionSet:
        """The same for as many lanes, 4 or 8; those of the instruction set are the most."""
        return replace(self, lanes=min(count, self.lanes))

    @property
    def name(self) -> str:
        """That tells libraries of different instruction sets apart."""
        return f"{self.lanes} lanes {' '.join(self.flags)} {'with' if self.library else 'without'} libmvec"

    @property
    def defines(self) -> str:
        """What lanes.h wants to know, in C."""
        return f"#define LANES {self.lanes}\n#define VECTOR_LIBRARY {int(self.library)}\n"

    @property
    def build_flags(self) -> Mapping[str, str]:
        """Of `library.library_of`."""
        flags = " ".join(self.flags)
        return {
            "": f"-O1 -ffp-contract=off {flags}",
            "batch": f"-O3 {flags}",
            "program": f"-O2 -ffp-contract=off {flags}",
            "link": "-lmvec -lm" if self.library else "-lm",
        }


def instruction_set(features: frozenset[str], libc: tuple[str, str]) -> InstructionSet:
    """Of a processor's features in the words of Linux, and the C library's name and version."""
    library = libc[0] == "glibc" and _version(libc[1]) >= VECTOR_LIBRARY_SINCE
    if features >= AVX512:
        return InstructionSet(8, ("-mavx512f", "-mavx512dq", "-mavx512vl", "-mfma"), library)
    if features >= AVX2:
        return InstructionSet(4, ("-mavx2", "-mfma"), library)
    return InstructionSet(4, (), False)


@lru_cache(maxsize=1)
def own_instruction_set() -> InstructionSet:
    """Of this machine: eight lanes with AVX-512, four with AVX2, four of any other processor's registers."""
    return instruction_set(_features(), platform.libc_ver())


def _features() -> frozenset[str]:
    """Of the processor, where the system tells them."""
    if platform.machine() in ("x86_64", "AMD64"):
        with suppress(OSError):
            for line in PROCESSOR_FILE.read_text().splitlines():
                if line.startswith("flags"):
                    return frozenset(line.partition(":")[2].split())
    return frozenset()


def _version(text: str) -> tuple[int, ...]:
    return tuple(int(part) for part in text.split(".") if part.isdigit())
