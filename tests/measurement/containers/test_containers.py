"""Every container gives the same record as the CSV file."""

from __future__ import annotations

import contextlib
import os
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import savemat

from doe_kc.curves import RIG_RESPONSES
from doe_kc.ground.errors import InputError
from doe_kc.measurement import RigRecord, read_record
from doe_kc.measurement.channel_map import ChannelMap, channel_map
from doe_kc.measurement.containers import read_table
from doe_kc.measurement.map_file import MapFile
from tests.measurement.synthetic import csv_text, record_columns

COLUMNS = record_columns("vertical", samples=128)


def plain(folder: Path) -> RigRecord:
    (folder / "v.csv").write_text(csv_text(COLUMNS))
    return read_record(folder / "v.csv", "vertical")


def same(one: RigRecord, other: RigRecord, atol: float = 1e-6) -> None:
    np.testing.assert_allclose(one.input, other.input, atol=atol)
    for r in RIG_RESPONSES:
        np.testing.assert_allclose(one.channels[r], other.channels[r], atol=atol, rtol=1e-4)


def with_units(names: dict[str, str]) -> ChannelMap:
    """Map of identifiers to the package's channels, unit by heading."""
    entries = {}
    for name, heading in names.items():
        own, unit = heading[:-1].split(" [")
        side = own[-1] if own[-2:] in ("_L", "_R") else None
        quantity = own[:-2] if side else own
        entries[name] = [{"quantity": quantity, "side": side, "unit": unit}]
    return channel_map(MapFile.model_validate({"map": entries}), Path(), "test")


NAMES = {h.split(" [")[0]: h for h in COLUMNS}


def test_matlab_structs_with_an_offset_to_subtract(tmp_path: Path) -> None:
    data = {n: {"data": COLUMNS[h] + 3.0, "offset": 3.0} for n, h in NAMES.items()}
    savemat(tmp_path / "v.mat", data | {"comment": "x", "matrix": np.eye(3)})
    same(read_record(tmp_path / "v.mat", "vertical", channels=with_units(NAMES)), plain(tmp_path))


def test_matlab_arrays_inside_a_struct(tmp_path: Path) -> None:
    savemat(tmp_path / "v.mat", {"vertical": {n: COLUMNS[h] for n, h in NAMES.items()}})
    found = read_record(tmp_path / "v.mat", "vertical", sheet="vertical", channels=with_units(NAMES))
    same(found, plain(tmp_path))
    with pytest.raises(InputError, match='no struct "roll"'):
        read_table(tmp_path / "v.mat", "roll", "vertical")


def rpc_bytes(*, floats: bool, scale: float = 0.01, frame: int = 64) -> bytes:
    """As the format's description has it: header blocks of 512 bytes, frames of channels in turn."""
    channels = {h: v for h, v in COLUMNS.items() if not h.startswith("time")}
    pairs = {
        "FORMAT": "BINARY_IEEE_LITTLE_END",
        "NUM_HEADER_BLOCKS": "24",
        "NUM_PARAMS": str(9 + 3 * len(channels)),
        "FILE_TYPE": "TIME_HISTORY",
        "CHANNELS": str(len(channels)),
        "DELTA_T": "0.1",
        "PTS_PER_FRAME": str(frame),
        "FRAMES": str(128 // frame),
        "DATA_TYPE": "FLOATING_POINT" if floats else "SHORT_INTEGER",
    }
    scales = {h: max(scale * 1e-3, float(np.abs(v).max()) / 32000.0) for h, v in channels.items()}
    for i, h in enumerate(channels, 1):
        name, unit = h[:-1].split(" [")
        pairs |= {f"DESC.CHAN_{i}": name, f"UNITS.CHAN_{i}": unit, f"SCALE.CHAN_{i}": repr(scales[h])}
    head = b"".join(struct.pack("32s96s", k.encode(), v.encode()) for k, v in pairs.items())
    values = np.stack([v if floats else np.round(v / scales[h]) for h, v in channels.items()])
    blocks = values.reshape(len(channels), -1, frame).transpose(1, 0, 2)
    return head.ljust(24 * 512, b"\x00") + blocks.astype("<f4" if floats else "<i2").tobytes()


@pytest.mark.parametrize("floats", [True, False])
def test_rpc(tmp_path: Path, floats: bool) -> None:
    (tmp_path / "v.rsp").write_bytes(rpc_bytes(floats=floats))
    same(read_record(tmp_path / "v.rsp", "vertical"), plain(tmp_path), atol=0.5)
    (tmp_path / "v.rsp").write_bytes(rpc_bytes(floats=floats)[:-200])
    with pytest.raises(InputError, match="truncated"):
        read_record(tmp_path / "v.rsp", "vertical")


def write_hdf5_mat(path: Path) -> None:
    """As MATLAB saves version 7.3: a user block of 512 bytes, columns as (1, n), text as uint16."""
    import h5py

    with h5py.File(path, "w", userblock_size=512) as file:
        for n, h in NAMES.items():
            group = file.create_group(n)
            group.attrs["MATLAB_class"] = np.bytes_("struct")
            group["data"] = COLUMNS[h][np.newaxis] + 3.0
            group["offset"] = np.array([[3.0]])
            text = group.create_dataset("units", data=np.array([[ord(c)] for c in "mm"], dtype=np.uint16))
            text.attrs["MATLAB_class"] = np.bytes_("char")
        file.create_group("#refs#")["a"] = np.arange(128.0)
    header = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124, b" ") + b"\x00\x02IM"
    path.write_bytes(header.ljust(512, b"\x00") + path.read_bytes()[512:])


def test_matlab_7_3(tmp_path: Path) -> None:
    pytest.importorskip("h5py", reason="the extra hdf5 is not in")
    write_hdf5_mat(tmp_path / "v.mat")
    same(read_record(tmp_path / "v.mat", "vertical", channels=with_units(NAMES)), plain(tmp_path))
    table = read_table(tmp_path / "v.mat", None, "vertical")
    assert {heading.unit for heading in table.channels} == {"mm"}
    whole = (tmp_path / "v.mat").read_bytes()
    (tmp_path / "v.mat").write_bytes(whole[: len(whole) // 3])
    with pytest.raises(InputError, match=r"cannot be read as a MATLAB 7\.3 file"):
        read_table(tmp_path / "v.mat", None, "vertical")


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # asammdf, of a damaged file
def test_mdf(tmp_path: Path) -> None:
    asammdf = pytest.importorskip("asammdf", reason="the extra mdf is not in")
    time = np.arange(128) * 0.1
    signals = [
        asammdf.Signal(samples=v, timestamps=time, name=h.split(" [")[0], unit=h[:-1].split(" [")[1])
        for h, v in COLUMNS.items()
        if not h.startswith("time")
    ]
    with asammdf.MDF(version="4.10") as file:
        file.append(signals)
        file.save(tmp_path / "v.mf4")
    same(read_record(tmp_path / "v.mf4", "vertical"), plain(tmp_path))
    with pytest.raises(InputError, match=r"cannot be read as MDF.*group number"):
        read_table(tmp_path / "v.mf4", "7", "vertical")
    (tmp_path / "v.mf4").write_bytes((tmp_path / "v.mf4").read_bytes()[:900])
    with pytest.raises(InputError, match="cannot be read as MDF"):
        read_table(tmp_path / "v.mf4", None, "vertical")


def test_tdms(tmp_path: Path) -> None:
    nptdms = pytest.importorskip("nptdms", reason="the extra tdms is not in")

    def channels(group: str) -> list[object]:
        return [
            nptdms.ChannelObject(
                group, h.split(" [")[0], v, properties={"unit_string": h[:-1].split(" [")[1]}
            )
            for h, v in COLUMNS.items()
        ]

    with nptdms.TdmsWriter(tmp_path / "v.tdms") as file:
        file.write_segment([*channels("vertical"), *channels("other")])
    same(read_record(tmp_path / "v.tdms", "vertical"), plain(tmp_path))
    with pytest.raises(InputError, match='no group "roll", its groups are other, vertical'):
        read_table(tmp_path / "v.tdms", "roll", "vertical")
    (tmp_path / "v.tdms").write_bytes(b"TDSm" + bytes(200))
    with pytest.raises(InputError, match="cannot be read as TDMS"):
        read_table(tmp_path / "v.tdms", None, "vertical")


@pytest.mark.parametrize(("suffix", "module"), [("mf4", "asammdf"), ("tdms", "nptdms"), ("mat", "h5py")])
def test_a_missing_extra_is_one_sentence(
    tmp_path: Path, suffix: str, module: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    path = tmp_path / f"v.{suffix}"
    path.write_bytes(b"MATLAB 7.3 MAT-file" + bytes(600))
    with pytest.raises(InputError, match=rf"needs the package {module}.*pip install"):
        read_record(path, "vertical")


def test_pipes_and_devices_are_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "v.csv")
    for path in (tmp_path / "v.csv", Path("/dev/zero")):
        with pytest.raises(InputError, match="pipe or a device"):
            read_record(path, "vertical")


GOOD = {"rsp": rpc_bytes(floats=False)[:16000], "txt": csv_text(COLUMNS).replace(",", "\t").encode()[:3000]}


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(sorted(GOOD)), st.integers(0, 15000), st.integers(0, 60), st.binary(max_size=30))
def test_damaged_bytes_are_read_or_refused(name: str, start: int, length: int, new: bytes) -> None:
    import tempfile

    good = GOOD[name]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"v.{name}"
        path.write_bytes(good[:start] + new + good[start + length :])
        with contextlib.suppress(InputError):
            read_record(path, "vertical")


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 4000), st.binary(min_size=1, max_size=40))
def test_damaged_mat_files(at: int, new: bytes) -> None:
    import io
    import tempfile

    buffer = io.BytesIO()
    savemat(buffer, {n: COLUMNS[h] for n, h in NAMES.items()})
    data = buffer.getvalue()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "v.mat"
        path.write_bytes(data[:at] + new + data[at + len(new) :])
        with contextlib.suppress(InputError):
            read_record(path, "vertical", channels=with_units(NAMES))
