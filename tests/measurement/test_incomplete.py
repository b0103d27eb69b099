"""What rigs leave out: a channel, a wheel, the time; said in `absent`, never guessed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from doe_kc.ground.errors import InputError
from doe_kc.measurement import load_manifest, reduce_measurement
from doe_kc.measurement.reduction import case_records
from tests.cli.runner import succeeds, write_study
from tests.measurement.synthetic import EXAMPLE

CASES = ("vertical", "roll")


def rig(folder: Path, drop: list[str], absent: str, cases: tuple[str, ...] = CASES) -> Path:
    """Main run and a repeat of the example without the columns that begin as said."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ['name = "a"', "[channels]", 'preset = "doe_kc"', f"absent = {absent}", "[records]"]
    for case in cases:
        names = [f"{case}.csv", f"{case}_repeat1.csv"]
        for name in names:
            frame = pd.read_csv(EXAMPLE / name)
            kept = [c for c in frame.columns if not any(d in c for d in drop)]
            frame[kept].to_csv(folder / name, index=False)
        lines.append(f"{case} = {names}")
    (folder / "test.toml").write_text("\n".join(lines) + "\n")
    return folder / "test.toml"


def test_a_rig_without_caster_and_time(tmp_path: Path) -> None:
    measurement = reduce_measurement(rig(tmp_path, ["caster", "time"], '["caster", "time"]'))
    full = reduce_measurement(EXAMPLE / "test.toml")
    assert "spin" not in measurement.curves.cases["vertical"].mean
    assert np.isnan(measurement.characteristics["vertical.caster_compensation"].value)
    known = measurement.characteristics["vertical.bump_steer"].value
    assert known == pytest.approx(full.characteristics["vertical.bump_steer"].value, abs=0.1)


def test_a_channel_that_is_missing_unsaid_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'lacks "caster_L \[deg\]".*absent'):
        reduce_measurement(rig(tmp_path, ["caster"], "[]"))


@pytest.mark.parametrize("case", CASES)
def test_one_wheel_is_mirrored(tmp_path: Path, case: str) -> None:
    path = rig(tmp_path, ["_R ["], '["R"]', (case,))
    manifest = load_manifest(path)
    record = case_records(path, manifest, case)[0]
    whole = case_records(EXAMPLE / "test.toml", load_manifest(EXAMPLE / "test.toml"), case)[0]
    assert len(record.mirrored) == 7 and "toe_R" in record.mirrored
    for response, share in (("camber", 0.03), ("wc_y", 0.1), ("wc_z", 0.01), ("tyre_load", 0.01)):
        span = np.ptp(whole.channels[response][1])
        np.testing.assert_allclose(
            record.channels[response][1], whole.channels[response][1], atol=share * span
        )


def test_reduce_without_caster_from_end_to_end(tmp_path: Path) -> None:
    study = write_study(tmp_path / "s", records={"vertical": ["vertical.csv"]})
    rig(study / "rig", ["caster"], '["caster"]', ("vertical",))
    succeeds("reduce", study, "--out", tmp_path / "o")
    assert (tmp_path / "o" / "reduce" / "curves.csv").is_file()


def test_fifteen_points_a_branch(tmp_path: Path) -> None:
    path = rig(tmp_path, [], "[]", ("vertical",))
    for file in tmp_path.glob("*.csv"):
        frame = pd.read_csv(file)
        frame.iloc[:: len(frame) // 30].to_csv(file, index=False)
    coarse = reduce_measurement(path)
    fine = reduce_measurement(EXAMPLE / "test.toml")
    for name in ("vertical.bump_steer", "vertical.ride_rate"):
        ours, theirs = coarse.characteristics[name], fine.characteristics[name]
        assert ours.value == pytest.approx(theirs.value, abs=max(4.0 * ours.sd, 0.02 * abs(theirs.value)))
        assert ours.sd > theirs.sd


def test_reduce_of_one_branch_from_end_to_end(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    study = write_study(tmp_path / "s", records={"vertical": ["vertical.csv"]})
    file = study / "rig" / "vertical.csv"
    frame = pd.read_csv(file)
    frame.iloc[: int(frame["pad_z [mm]"].argmin()) + 1].to_csv(file, index=False)
    succeeds("reduce", study, "--out", tmp_path / "o")
    assert "one branch" in caplog.text
    assert list((tmp_path / "o" / "reduce").glob("*.png"))
