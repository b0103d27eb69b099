"""Wall time of the influence study of all parameters, one at a time and exact, over all cores."""

from __future__ import annotations

from _common import example_axle, machine, publish

from doe_kc.parameter_influence.study import influence_study


def main() -> None:
    axle = example_axle()
    first, again = influence_study(axle), influence_study(axle)
    runs = 1 + 2 * len(again.parameters)
    publish(
        "influence_speed",
        [
            "# Influence study",
            "",
            f"{len(again.parameters)} parameters, {runs} true-solver runs and all exact sensitivities. "
            f"{machine()}.",
            "",
            f"- first in a process (assembles the equations): {first.seconds:.2f} s",
            f"- again: {again.seconds:.2f} s (goal: below 5 s on 2 cores)",
        ],
    )


if __name__ == "__main__":
    main()
