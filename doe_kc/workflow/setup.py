"""How the rig was set up, beside how the model is."""

from __future__ import annotations

from doe_kc.axle import Axle
from doe_kc.load_cases import LOAD_CASES
from doe_kc.measurement import Manifest


def setup_differences(axle: Axle, manifest: Manifest) -> list[str]:
    """Where the rig's set-up is not the model's, in sentences."""
    setup, offset = manifest.setup, getattr(axle.load_cases.get("lateral_offset"), "offset", None)
    pairs = [
        ("rack_mm_per_rev", setup.rack_mm_per_rev, axle.rack_mm_per_rev, "[steering] rack_mm_per_rev"),
        ("lateral_offset_mm", setup.lateral_offset_mm, offset, "[load_cases.lateral_offset] offset"),
        (
            "reference_wheel_load_N",
            setup.reference_wheel_load_N,
            axle.values["tyre.static_load"],
            "[tyre] static_load",
        ),
    ]
    told = [
        f"{manifest.name}: the rig's {key} is {rig:g}, the model's {ours:g}; set {where} of the axle file."
        for key, rig, ours, where in pairs
        if rig is not None and ours and abs(rig - ours) > 1e-6 * abs(ours)
    ]
    left_out = [case for case in manifest.records if case in LOAD_CASES and case not in axle.load_cases]
    if left_out:
        told.append(
            f"{manifest.name}: has records of {', '.join(left_out)}, no load case of the axle: left out. "
            "Is the axle file that of this car?"
        )
    return told
