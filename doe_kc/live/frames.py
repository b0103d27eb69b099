"""Binary frames to the page: a header, float64 and float32 arrays in an announced order, a text.

Little-endian. Header: six uint32 (kind, seq, number of float64, number of float32, bytes of text, 0), so that
the float64 array begins at a multiple of 8. The text is JSON, UTF-8.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from doe_kc.curves import RESPONSE_UNITS, CurveSet
from doe_kc.ground.typing import FloatArray

PRESENT, REFERENCE, SHAPE, INFLUENCE = 1, 2, 3, 4
"""Kinds: the answer to the sliders; the nominal axle's or a snapshot's; the axle's points; the influence."""
HEADER = struct.Struct("<6I")


@dataclass(frozen=True)
class PageFrame:
    """exact: values that are shown as numbers. drawn: values that are drawn."""

    kind: int
    seq: int
    exact: FloatArray
    drawn: FloatArray
    text: Mapping[str, Any]

    def encode(self) -> bytes:
        """Bytes of the frame."""
        text = json.dumps(self.text, allow_nan=False).encode()
        exact = np.ascontiguousarray(self.exact, dtype="<f8")
        drawn = np.ascontiguousarray(self.drawn, dtype="<f4")
        header = HEADER.pack(self.kind, self.seq, exact.size, drawn.size, len(text), 0)
        return b"".join([header, exact.tobytes(), drawn.tobytes(), text])

    @classmethod
    def decode(cls, data: bytes) -> PageFrame:
        """The frame of its bytes; ValueError when they are none."""
        if len(data) < HEADER.size:
            raise ValueError("the frame is shorter than its header")
        kind, seq, n, m, length, _ = HEADER.unpack_from(data)
        end = HEADER.size + 8 * n + 4 * m
        if len(data) != end + length:
            raise ValueError("the frame has another length than its header says")
        exact = np.frombuffer(data, "<f8", n, HEADER.size)
        drawn = np.frombuffer(data, "<f4", m, HEADER.size + 8 * n)
        return cls(kind, seq, exact, np.asarray(drawn, dtype=float), json.loads(data[end:]))


def drawn_curves(curves: CurveSet, announced: CurveSet) -> FloatArray:
    """All mean curves, then all half-widths: load cases in their order, responses, left and right; nan for
    responses that an outside solver leaves out.

    announced: whose inputs the page has; loops have more of them than an axle without friction.
    """
    parts = []
    for half in (False, True):
        for ident, case in curves.cases.items():
            branches, inputs = case.half_width if half else case.mean, announced.cases[ident].input
            same = np.array_equal(inputs, case.input)
            for response in RESPONSE_UNITS:
                rows = branches.get(response, np.full((2, case.input.size), np.nan))
                at = rows if same else np.array([np.interp(inputs, case.input, row) for row in rows])
                parts.append(at.ravel())
    return np.concatenate(parts)
