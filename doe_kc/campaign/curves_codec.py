"""Curves as a block of bytes, every bit of them, and back.

`KC1`, then zlib of: length of the header (uint32), header (JSON), numbers (float64, little-endian, stored
byte plane by byte plane, which compresses better). Curves that are zero throughout are only named.
"""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Mapping
from typing import Any

import numpy as np

from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray

MAGIC = b"KC1"
COMPRESSION_LEVEL = 1
"""Of zlib; 6 takes half as long again and saves 2 %."""


class DamagedCurves(ValueError):
    """The bytes are not curves, or not all of them."""


def pack(curves: CurveSet) -> bytes:
    """Curves as bytes."""
    arrays: list[FloatArray] = []
    header = {
        "source": curves.source,
        "half_track": float(curves.half_track),
        "static": None
        if curves.static is None
        else {n: list(map(float, v)) for n, v in curves.static.items()},
        "cases": [_case_header(case, arrays) for case in curves.cases.values()],
    }
    text = json.dumps(header).encode()
    numbers = np.concatenate([np.ravel(a) for a in arrays]) if arrays else np.zeros(0)
    planes = numbers.astype("<f8").view(np.uint8).reshape(-1, 8).T.tobytes()
    return MAGIC + zlib.compress(struct.pack("<I", len(text)) + text + planes, COMPRESSION_LEVEL)


def _case_header(case: CaseCurves, arrays: list[FloatArray]) -> dict[str, Any]:
    arrays.append(case.input)
    return {
        "load_case": case.load_case,
        "unit": case.input_unit,
        "points": len(case.input),
        "mean": _listed(case.mean, arrays),
        "half_width": _listed(case.half_width, arrays),
    }


def _listed(curves: Mapping[str, FloatArray], arrays: list[FloatArray]) -> dict[str, bool]:
    """Response -> whether its numbers are stored."""
    out = {name: bool(curve.any()) for name, curve in curves.items()}
    arrays += [curve for name, curve in curves.items() if out[name]]
    return out


def unpack(block: bytes) -> CurveSet:
    """Curves of `pack`; DamagedCurves when the bytes are not whole."""
    try:
        if not block.startswith(MAGIC):
            raise ValueError("no curves")
        content = zlib.decompress(block[len(MAGIC) :])
        (length,) = struct.unpack_from("<I", content)
        header = json.loads(content[4 : 4 + length])
        planes = np.frombuffer(content, dtype=np.uint8, offset=4 + length).reshape(8, -1)
        numbers = _Numbers(np.ascontiguousarray(planes.T).view("<f8").ravel().astype(np.float64))
        cases = {c["load_case"]: _case(c, numbers) for c in header["cases"]}
        static = header["static"]
        angles = None if static is None else {n: np.array(v) for n, v in static.items()}
        return CurveSet(header["source"], cases, angles, header["half_track"])
    except (ValueError, KeyError, TypeError, struct.error, zlib.error) as error:
        raise DamagedCurves(str(error)) from None


class _Numbers:
    """Hands out the numbers in the order in which they were stored."""

    def __init__(self, numbers: FloatArray) -> None:
        self._numbers, self._start = numbers, 0

    def take(self, count: int) -> FloatArray:
        """(count,) the next numbers."""
        block = self._numbers[self._start : self._start + count]
        if len(block) != count:
            raise ValueError("fewer numbers than the header says")
        self._start += count
        return block

    def curves(self, stored: Mapping[str, bool], n: int) -> dict[str, FloatArray]:
        """Response -> (2, n); zeros where nothing is stored."""
        return {
            name: self.take(2 * n).reshape(2, n) if there else np.zeros((2, n))
            for name, there in stored.items()
        }


def _case(header: Mapping[str, Any], numbers: _Numbers) -> CaseCurves:
    n = int(header["points"])
    grid = numbers.take(n)
    mean = numbers.curves(header["mean"], n)
    return CaseCurves(
        header["load_case"], header["unit"], grid, mean, numbers.curves(header["half_width"], n)
    )
