"""What is wrong is told with kind and channel; what is sound is left alone."""

from __future__ import annotations

import numpy as np
import pytest

from doe_kc.measurement import load_manifest
from doe_kc.measurement.checks import CHECKS, RecordFinding
from doe_kc.measurement.manifest import CheckOptions
from tests.measurement.checks.cases import Columns, Edit, findings
from tests.measurement.synthetic import EXAMPLE


def idents(told: tuple[RecordFinding, ...]) -> list[str]:
    return [f.ident for f in told]


def scaled(heading: str, factor: float, *, run: int | None = None) -> Edit:
    def edit(case: str, k: int, columns: Columns) -> None:
        for name in columns:
            if name.startswith(heading) and run in (None, k):
                columns[name] = factor * columns[name]

    return edit


def main_run(heading: str, change: object) -> Edit:
    def edit(case: str, k: int, columns: Columns) -> None:
        if k == 0:
            columns[heading] = change(columns[heading].copy())  # type: ignore[operator]

    return edit


def exchanged(one: str, other: str) -> Edit:
    def edit(case: str, k: int, columns: Columns) -> None:
        for a in [c for c in columns if c.startswith(one)]:
            b = other + a[len(one) :] if a.split(" ")[1] == "[deg]" else a
            columns[a], columns[b] = columns[b], columns[a]

    return edit


def test_the_shipped_car_is_sound_with_every_check() -> None:
    assert set(CHECKS) >= {
        "signs",
        "repeats",
        "outlier",
        "flat",
        "gap",
        "drift",
        "noisy",
        "copies",
        "alignment",
    }
    assert findings() == ()


@pytest.mark.parametrize(
    ("edit", "changed", "ident"),
    [
        (scaled("toe_", -1.0), None, "sign.*.toe"),
        (scaled("wc_y_R", -1.0), None, "sign.*.wc_y_R"),
        (scaled("tyre_load", 1e-3), None, "unit.*.tyre_load"),
        (scaled("camber", np.pi / 180.0), None, "unit.*.camber"),
        (exchanged("toe_", "camber_"), None, "columns.*.toe/camber"),
        (scaled("pad_z", -1.0), ("vertical",), "input_sign.vertical.pad_z"),
        (scaled("force_x", -1.0), ("brake",), "input_sign.brake.force_x"),
        (scaled("toe_L", 10.0, run=1), ("vertical",), "repeat.vertical.toe_L"),
        (scaled("pad_z", -1.0, run=0), ("vertical",), "repeat.vertical.*"),
    ],
)
def test_identity_and_repeats(edit: Edit, changed: tuple[str, ...] | None, ident: str) -> None:
    assert ident in idents(findings(edit, changed=changed))


def spike(value: float) -> object:
    def change(v: np.ndarray) -> np.ndarray:
        v[100] = value
        return v

    return change


def held(first: int, length: int) -> object:
    def change(v: np.ndarray) -> np.ndarray:
        v[first : first + length] = v[first]
        return v

    return change


@pytest.mark.parametrize(
    ("heading", "change", "ident"),
    [
        ("toe_L [deg]", spike(1e6), "outlier.lateral.toe_L"),
        ("toe_L [deg]", spike(1e300), "outlier.lateral.toe_L"),
        ("toe_L [deg]", lambda v: 0.0 * v, "dead.lateral.toe_L"),
        ("wc_y_R [mm]", held(200, 100), "stuck.lateral.wc_y_R"),
        ("wc_z_R [mm]", lambda v: np.minimum(v, np.quantile(v, 0.9)), "clipped.lateral.wc_z_R"),
        ("camber_L [deg]", lambda v: v + np.linspace(0.0, 0.15, v.size), "drift.lateral.camber_L"),
        (
            "caster_L [deg]",
            lambda v: v + 0.03 * np.random.default_rng(0).normal(size=v.size),
            "noise.lateral.caster_L",
        ),
    ],
)
def test_faults_of_one_channel_of_one_run(heading: str, change: object, ident: str) -> None:
    assert ident in idents(findings(main_run(heading, change), changed=("lateral",)))


def beside(slope: float, width: float) -> object:
    """Noise of 0.01 about -0.03, and in units of it a slope over the sweep with the channel and a loop."""

    def change(v: np.ndarray) -> np.ndarray:
        noise = np.random.default_rng(1).normal(size=v.size)
        loop = np.where(np.arange(v.size) < v.size / 2, 0.5, -0.5)
        return -0.03 + 0.01 * (slope * (v - v.mean()) / np.ptp(v) + width * loop + noise)

    return change


def test_a_channel_of_noise_alone_is_dead_and_one_of_a_wheel_that_moves_little_is_not() -> None:
    def told(slope: float, width: float) -> list[str]:
        changed = findings(main_run("wc_y_R [mm]", beside(slope, width)), changed=("lateral",))
        return [f.evidence for f in changed if f.kind == "dead"]

    (noise,) = told(0.0, 0.0)
    assert "wc_y_R shows noise alone about -0.03" in noise
    assert told(1.5, 0.0) == told(0.0, 1.0) == []


def test_an_outlier_does_not_move_the_curve() -> None:
    from tests.measurement.checks.cases import runs_of

    clean = runs_of("vertical")[0].mean("toe")
    spiked = runs_of("vertical", main_run("toe_L [deg]", spike(1e6)))[0].mean("toe")
    np.testing.assert_allclose(spiked, clean, atol=0.003)


def test_a_hole_an_offset_a_copy_and_files_exchanged() -> None:
    def hole(case: str, k: int, columns: Columns) -> None:
        for name in columns:
            columns[name] = np.delete(columns[name], slice(100, 160))

    assert "gap.lateral.*" in idents(findings(hole, changed=("lateral",)))

    def shifted(case: str, k: int, columns: Columns) -> None:
        columns["pad_z [mm]"] = columns["pad_z [mm]"] + 5.0

    (offset,) = findings(shifted, changed=("vertical",))
    assert offset.ident == "input_offset.vertical.pad_z" and "-5" in offset.cure + offset.evidence

    def copied(case: str, k: int, columns: Columns) -> None:
        columns["toe_R [deg]"] = columns["toe_L [deg]"]

    assert "copy.brake.toe_R" in idents(findings(copied, changed=("brake",)))

    def other_case(case: str, k: int, columns: Columns) -> None:
        from tests.measurement.checks.cases import sound

        other = {"drive": "brake", "brake": "drive"}[case]
        columns.update(sound(other)[k])

    assert "load_case.drive.*" in idents(findings(other_case, changed=("drive", "brake")))


def test_a_finding_that_is_accepted_is_a_warning() -> None:
    manifest = load_manifest(EXAMPLE / "test.toml")
    accepting = manifest.model_copy(update={"checks": CheckOptions(accept=("sign.*",))})
    found = findings(scaled("wc_x_", -1.0), manifest=accepting)
    assert ("sign.*.wc_x", "warning") in [(f.ident, f.severity) for f in found]
    refused = findings(scaled("wc_x_", -1.0))
    assert ("sign.*.wc_x", "error") in [(f.ident, f.severity) for f in refused]


def test_the_benchs_caster_against_steer() -> None:
    manifest = load_manifest(EXAMPLE / "test.toml")
    assert manifest.alignment is not None and manifest.alignment.left is not None
    left = manifest.alignment.left.model_copy(update={"caster_deg": -4.3})
    wrong = manifest.model_copy(update={"alignment": manifest.alignment.model_copy(update={"left": left})})
    (finding,) = findings(manifest=wrong)
    assert finding.ident == "alignment.static.caster" and "4.2" in finding.evidence
