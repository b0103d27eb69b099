"""RPC III of MTS (`.rsp`, `.tim`, `.rpc`): header records of 512 bytes, then frames of interleaved channels.

A header is a list of parameters, each 32 bytes of keyword and 96 of value, in ASCII. Samples are 16-bit
integers
times the channel's scale, or 32-bit floats; a frame holds PTS_PER_FRAME samples of each channel in turn.
Keywords
by the format's description in MTS RPC documentation (FORMAT, NUM_HEADER_BLOCKS, NUM_PARAMS, CHANNELS,
DELTA_T,
PTS_PER_FRAME, PTS_PER_GROUP, FRAMES, DATA_TYPE, SCALE.CHAN_i, UNITS.CHAN_i, DESC.CHAN_i).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from doe_kc.ground.errors import InputError
from doe_kc.ground.typing import FloatArray
from doe_kc.measurement.channels import Heading
from doe_kc.measurement.containers._extra import array_table
from doe_kc.measurement.tables import ArrayTable, read_bytes

BLOCK, PARAMETER, KEYWORD = 512, 128, 32
MOST_PARAMETERS, MOST_CHANNELS_RPC = 4096, 256


def read_rpc_table(path: Path, part: str | None, load_case: str) -> ArrayTable:
    """All channels, and `time [s]` from DELTA_T. InputError for a file that is none, or is truncated."""
    data = read_bytes(path)
    header = _header(path, data)
    channels = _integer(path, header, "CHANNELS", 1, MOST_CHANNELS_RPC)
    samples = _samples(path, data, header, channels)
    step = _number(path, header, "DELTA_T")
    out: list[tuple[Heading, FloatArray]] = [
        (Heading("time", "s"), step * np.arange(samples.shape[1], dtype=np.float64))
    ]
    for i in range(channels):
        name = header.get(f"DESC.CHAN_{i + 1}", f"channel {i + 1}")
        out.append((Heading(name, header.get(f"UNITS.CHAN_{i + 1}") or None), samples[i]))
    return array_table(str(path), out)


def _header(path: Path, data: bytes) -> dict[str, str]:
    first = _parameters(data[: 3 * PARAMETER])
    if "FORMAT" not in first or not first["FORMAT"].startswith("BINARY"):
        raise InputError(
            f"{path}: is no RPC III file of binary data; expected FORMAT BINARY_IEEE_LITTLE_END first."
        )
    blocks = _integer(path, first, "NUM_HEADER_BLOCKS", 1, MOST_PARAMETERS)
    count = _integer(path, first, "NUM_PARAMS", 3, MOST_PARAMETERS)
    if len(data) < blocks * BLOCK:
        raise InputError(f"{path}: ends inside its header: the file is truncated; copy or export it again.")
    return _parameters(data[: min(count * PARAMETER, blocks * BLOCK)]) | {"NUM_HEADER_BLOCKS": str(blocks)}


def _parameters(data: bytes) -> dict[str, str]:
    out = {}
    for start in range(0, len(data) - PARAMETER + 1, PARAMETER):
        key = _text(data[start : start + KEYWORD])
        if key:
            out[key] = _text(data[start + KEYWORD : start + PARAMETER])
    return out


def _text(data: bytes) -> str:
    return data.split(b"\x00", 1)[0].decode("latin-1").strip()


def _samples(path: Path, data: bytes, header: Mapping[str, str], channels: int) -> FloatArray:
    """(channels, n) in the channels' units."""
    floats = header.get("DATA_TYPE", "SHORT_INTEGER").startswith("FLOAT")
    order = ">" if "BIG" in header["FORMAT"] else "<"
    frame = _integer(path, header, "PTS_PER_FRAME", 1, 1 << 24)
    frames = _integer(path, header, "FRAMES", 1, 1 << 24)
    group = _integer(path, {"PTS_PER_GROUP": str(frame), **header}, "PTS_PER_GROUP", 1, 1 << 24)
    per_group = max(group // frame, 1)
    kind = np.dtype(f"{order}{'f4' if floats else 'i2'}")
    body = data[int(header["NUM_HEADER_BLOCKS"]) * BLOCK :]
    raw = np.frombuffer(body[: len(body) // kind.itemsize * kind.itemsize], dtype=kind)
    groups = -(-frames // per_group)
    if raw.size < groups * per_group * frame * channels:
        groups = frames // per_group  # the last group may be left out when it is not full
    size = groups * per_group * frame
    if raw.size < size * channels or size == 0:
        raise InputError(
            f"{path}: holds {raw.size} samples, its header says {frames * frame * channels}: the file is "
            "truncated; copy or export it again."
        )
    blocks = raw[: size * channels].reshape(groups, channels, per_group * frame)
    values = blocks.transpose(1, 0, 2).reshape(channels, size)[:, : frames * frame].astype(float)
    if floats:
        return np.asarray(values)
    scale = [_number(path, header, f"SCALE.CHAN_{i + 1}") for i in range(channels)]
    return np.asarray(values * np.array(scale)[:, None])


def _number(path: Path, header: Mapping[str, str], key: str) -> float:
    try:
        value = float(header[key])
    except (KeyError, ValueError):
        value = np.nan
    if not np.isfinite(value):
        raise InputError(
            f"{path}: header {key} is {header.get(key, 'missing')}, expected a number; export it again."
        )
    return value


def _integer(path: Path, header: Mapping[str, str], key: str, low: int, high: int) -> int:
    value = _number(path, header, key)
    if value != int(value) or not low <= value <= high:
        raise InputError(f"{path}: header {key} is {value:g}, expected {low} to {high}; export it again.")
    return int(value)
