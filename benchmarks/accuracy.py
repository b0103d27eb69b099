"""Largest difference to the independent multibody code over every curve of every reference file."""

from __future__ import annotations

from _common import publish

from doe_kc.solver.suite import solve
from tests.reference import FILES, reference_axle, reference_curves
from tests.solver.test_reference import differences

UNITS = {"deg": "_deg", "mm": "_mm", "N": "_N"}


def worst(name: str) -> dict[str, float]:
    """Largest absolute difference by unit."""
    solution, out = solve(reference_axle(name), compiled=False), dict.fromkeys(UNITS, 0.0)
    for (case, branch, side), rows in reference_curves(name).groupby(["case", "branch", "side"], sort=False):
        for column, gap in differences(solution, rows, str(case), str(branch), str(side)).items():
            for unit, suffix in UNITS.items():
                if column.endswith(suffix):
                    out[unit] = max(out[unit], float(abs(gap).max()))
    return out


def main() -> None:
    lines = [
        "# Accuracy against EXUDYN 1.13.6",
        "",
        "Largest difference over all load cases, branches, sides and 27 columns of each reference file.",
        "Wanted: 1e-3 deg, 1e-2 mm, 1 N (0.02 % of a load if that is larger).",
        "",
        "| reference file | angle [deg] | position [mm] | force [N] |",
        "|---|---|---|---|",
    ]
    for name in FILES:
        gaps = worst(name)
        lines.append(f"| {name} | {gaps['deg']:.1e} | {gaps['mm']:.1e} | {gaps['N']:.1e} |")
    publish("accuracy", lines)


if __name__ == "__main__":
    main()
