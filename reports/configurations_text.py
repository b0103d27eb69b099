"""The words of the report on configurations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pandas as pd
from configurations_findings import HERE, THESIS
from report_text import number, spread, table

Entries = tuple[str, tuple[tuple[str, str], ...]]

HEAD = """# How the set-up of a correlation bears on its convergence

Figures 5 to 9 of E. Wendeberg, *Using optimization to auto-correlate suspension characteristics to K&C
measurements*, Chalmers 2013, repeated on `examples/front_axle`: the records of car_a, which the model
cannot match fully. Budget {budget} evaluations (the baseline among them), {seeds} seeds a configuration.
Everything that a figure does not vary is as shipped: `ego` (`gradients = false`), all variables,
standard bounds, 101 levels,
uniform; but every method opens with a sample of a third of the variables, at least 20 designs. Targets,
objectives and constraints are the same throughout (but in 9b), so ratings compare. Made by
`python reports/configurations.py`, which also asserts what is stated.

The example leaves out the lateral camber, which the car has four times as soft as any value of the
variables makes the model. Without it the baseline meets all {constraints} constraints, and the rating is a
matter of objectives that counteract each other. 9b has those targets in: an axle that cannot be correlated.

Rating: equation 2.2, best so far, 0 = every target met; {baseline} at the baseline, {baseline_all} in 9b.
Median of the seeds, at the end with the range.

{rows}

Constraints met: runs whose final design meets all; missed, at a bound: constraints and variables of it.
Seconds of one core.
"""


def markdown(runs: pd.DataFrame, figures: Mapping[str, Entries], constraints: int) -> str:
    """The report."""
    first = runs.iloc[0]
    head = HEAD.format(
        budget=int(runs["evaluations"].max()),
        seeds=int(runs["seed"].max()),
        baseline=number(first["rating_1"]),
        baseline_all=number(runs["rating_1"].min(), 4),
        rows=_table(runs, figures),
        constraints=constraints,
    )
    return head + "".join(
        _section(k, *figures[k])
        for k in figures
        if set(runs["configuration"]) & {n for n, _ in figures[k][1]}
    )


def file_name(k: str, what: str) -> str:
    """Of a figure, without its suffix."""
    return f"configurations_{k}_{what.replace(', ', '_').replace(' ', '_')}"


def _section(k: str, what: str, _: Sequence[tuple[str, str]]) -> str:
    picture = f"{file_name(k, what)}.png"
    words = f"**Thesis.** {THESIS[k]}\n\n**Here.** {HERE[k]}"
    return f"\n## Figure {k}: {what}\n\n{words}\n\n![Figure {k}]({picture})\n"


def _table(runs: pd.DataFrame, figures: Mapping[str, Entries]) -> str:
    head = (
        "figure", "configuration", "variables", "rating at 25", "at 50", "at 100", "evaluations",
        "constraints met", "missed", "at a bound", "mean improvement [%]", "seconds",
    )  # fmt: skip
    rows = []
    for k, (_, entries) in figures.items():
        for name, label in entries:
            own = runs[runs["configuration"] == name]
            if len(own):
                rows.append([k, label.format(n=own["variables"].iloc[0]), *_row(own)])
    return table(head, rows)


def _row(own: pd.DataFrame) -> list[str]:
    return [
        str(own["variables"].iloc[0]),
        number(own["rating_25"].median()),
        number(own["rating_50"].median()),
        spread(own["rating_100"].tolist()),
        number(own["evaluations"].median()),
        f"{(own['constraints_missed'] == 0).sum()} of {len(own)}",
        number(own["constraints_missed"].median()),
        number(own["at_bound"].median()),
        number(own["mean_improvement_percent"].median()),
        number(own["seconds"].median(), 2),
    ]
