"""Curves as a block of bytes and back: every bit of them, or rebuilt to the accuracy of their fit.

`KC1`, then zlib of: length of the header (uint32), header (JSON), numbers (float64, little-endian, stored
byte plane by byte plane, which compresses better). Curves that are zero throughout are only named.
`KC2` is the same with the fit of `curve_fit` in place of curves: inputs alone are float64 numbers, then
follow the numbers of coefficients (uint16) and the coefficients (int32), likewise in planes.
"""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from doe_kc.campaign.curve_fit import CurveFit, coefficient_step, fitted, rebuilt
from doe_kc.curves import CaseCurves, CurveSet
from doe_kc.ground.typing import FloatArray

MAGIC = b"KC1"
FIT_MAGIC = b"KC2"
COMPRESSION_LEVEL = 1
"""Of zlib; 6 takes half as long again and saves 2 %."""


class DamagedCurves(ValueError):
    """The bytes are not curves, or not all of them."""


def pack(curves: CurveSet) -> bytes:
    """Curves as bytes."""
    there = {name: _stored(case) for name, case in curves.cases.items()}
    numbers = [n for name, case in curves.cases.items() for n in (case.input, *there[name].values())]
    return _block(MAGIC, curves, there, _planes(numbers, "<f8"))


def pack_fit(curves: CurveSet) -> bytes:
    """Their fit as bytes; those of `pack` where they cannot be fitted."""
    cases = list(curves.cases.values())
    there = {name: _stored(case) for name, case in curves.cases.items()}
    try:
        fits = [_fit(case.input, there[name]) for name, case in curves.cases.items()]
    except OverflowError:
        return pack(curves)
    content = _planes([case.input for case in cases], "<f8")
    content += _planes([f.counts for f in fits], "<u2") + _planes([f.steps for f in fits], "<i4")
    return _block(FIT_MAGIC, curves, there, content)


Stored = dict[tuple[str, str], FloatArray]
"""(mean or half_width, response) -> curves (2, n) that are not zero throughout."""


def _fit(inputs: FloatArray, there: Stored) -> CurveFit:
    rows = np.concatenate(list(there.values())) if there else np.zeros((0, inputs.size))
    return fitted(inputs, rows, _steps(tuple(response for _, response in there), inputs.size))


@lru_cache(maxsize=64)
def _steps(responses: tuple[str, ...], n: int) -> FloatArray:
    """(2 k,) of k responses, left and right."""
    return np.repeat([coefficient_step(name, n) for name in responses], 2)


def _stored(case: CaseCurves) -> Stored:
    """Mean curves, then half-widths."""
    kinds = (("mean", case.mean), ("half_width", case.half_width))
    return {(kind, r): c for kind, curves in kinds for r, c in curves.items() if c.any()}


def _planes(arrays: list[FloatArray] | list[NDArray[Any]], kind: str) -> bytes:
    numbers = np.concatenate([np.ravel(a) for a in arrays]) if arrays else np.zeros(0)
    flat = numbers.astype(kind)
    return flat.view(np.uint8).reshape(-1, flat.itemsize).T.tobytes()


def _block(magic: bytes, curves: CurveSet, there: Mapping[str, Stored], content: bytes) -> bytes:
    header = {
        "source": curves.source,
        "half_track": float(curves.half_track),
        "static": None
        if curves.static is None
        else {n: list(map(float, v)) for n, v in curves.static.items()},
        "cases": [
            {
                "load_case": case.load_case,
                "unit": case.input_unit,
                "points": len(case.input),
                "mean": {r: ("mean", r) in there[name] for r in case.mean},
                "half_width": {r: ("half_width", r) in there[name] for r in case.half_width},
            }
            for name, case in curves.cases.items()
        ],
    }
    text = json.dumps(header).encode()
    return magic + zlib.compress(struct.pack("<I", len(text)) + text + content, COMPRESSION_LEVEL)


def unpack(block: bytes) -> CurveSet:
    """Curves of `pack` or `pack_fit`; DamagedCurves when the bytes are not whole."""
    try:
        magic = block[: len(MAGIC)]
        if magic not in (MAGIC, FIT_MAGIC):
            raise ValueError("no curves")
        content = zlib.decompress(block[len(MAGIC) :])
        (length,) = struct.unpack_from("<I", content)
        header = json.loads(content[4 : 4 + length])
        read = _exact_cases if magic == MAGIC else _fitted_cases
        cases = {case.load_case: case for case in read(header["cases"], content[4 + length :])}
        static = header["static"]
        angles = None if static is None else {n: np.array(v) for n, v in static.items()}
        return CurveSet(header["source"], cases, angles, header["half_track"])
    except (ValueError, KeyError, TypeError, struct.error, zlib.error) as error:
        raise DamagedCurves(str(error)) from None


def _numbers(content: bytes, kind: str) -> NDArray[Any]:
    size = np.dtype(kind).itemsize
    planes = np.frombuffer(content, dtype=np.uint8).reshape(size, -1)
    return np.ascontiguousarray(planes.T).view(kind).ravel()


class _Numbers:
    """Hands out the numbers in the order in which they were stored."""

    def __init__(self, numbers: NDArray[Any]) -> None:
        self._numbers, self._start = numbers, 0

    def take(self, count: int) -> NDArray[Any]:
        """(count,) the next numbers."""
        block = self._numbers[self._start : self._start + count]
        if len(block) != count:
            raise ValueError("fewer numbers than the header says")
        self._start += count
        return block


def _exact_cases(headers: list[Mapping[str, Any]], content: bytes) -> Iterator[CaseCurves]:
    numbers = _Numbers(_numbers(content, "<f8").astype(np.float64))
    for header in headers:
        n = int(header["points"])
        yield _case(header, numbers.take(n), lambda n=n: numbers.take(2 * n).reshape(2, n))  # type: ignore[misc]


def _fitted_cases(headers: list[Mapping[str, Any]], content: bytes) -> Iterator[CaseCurves]:
    names = [[r for kind in ("mean", "half_width") for r, there in h[kind].items() if there] for h in headers]
    ends = np.cumsum([8 * sum(int(h["points"]) for h in headers), 4 * sum(map(len, names))])
    inputs = _Numbers(_numbers(content[: ends[0]], "<f8").astype(np.float64))
    counts = _Numbers(_numbers(content[ends[0] : ends[1]], "<u2"))
    steps = _Numbers(_numbers(content[ends[1] :], "<i4"))
    for header, responses in zip(headers, names, strict=True):
        n = int(header["points"])
        grid, own = inputs.take(n), counts.take(2 * len(responses))
        fit = CurveFit(own, steps.take(int(own.sum())))
        rows = iter(rebuilt(grid, fit, _steps(tuple(responses), n)).reshape(-1, 2, n))
        yield _case(header, grid, lambda rows=rows: next(rows))  # type: ignore[misc]


def _case(header: Mapping[str, Any], grid: FloatArray, rows: Callable[[], FloatArray]) -> CaseCurves:
    """rows: the next curves (2, n) that are stored; zeros stand for the others."""
    mean, half = (
        {name: rows() if there else np.zeros((2, grid.size)) for name, there in header[kind].items()}
        for kind in ("mean", "half_width")
    )
    return CaseCurves(header["load_case"], header["unit"], grid, mean, half)
