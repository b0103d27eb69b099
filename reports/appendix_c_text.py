"""The words of the report on Appendix C."""

from __future__ import annotations

import pandas as pd

HEAD = """# The influence matrix beside the published one

The influence matrix of `examples/front_axle` (one at a time, ±1 mm and ±10 %, central) beside Appendix C
of E. Wendeberg, *Using optimization to auto-correlate suspension characteristics to K&C measurements*,
Chalmers 2013. Both in percent of each column's largest entry, over the published 57 rows. Made by `python
reports/appendix_c.py`, which also asserts the figures below.

| over the 21 columns | mean |
|---|---|
| correlation of the magnitudes, 57 rows | {absolute:.3f} |
| the same without the three slip rows | {without:.3f} |
| signed correlation, up to one sign a column | {signed:.3f} |
| the same with the rows of x reversed ([why](#signs-and-digits)) | {reversed_signed:.3f} |
| equal signs among entries of {strong:g} % and more in both | {same} of {entries} |

| characteristic | magnitudes | without slips | signed | sign | equal signs | strongest, published \
| strongest, here |
|---|---|---|---|---|---|---|---|
"""

TAIL = """
"Sign" is the one overall sign of the column: − means that the published column has the opposite sign
throughout. Strongest entries leave the slip rows out.

![side by side](appendix_c.png)

## What the differences are due to

| change of the example | mean of 21 | roll camber | lateral camber | drive steer | brake steer |
|---|---|---|---|---|---|
{causes}

- **Another axle.** The published car's hardpoints and bushings are not given; the example is an invented,
  plausible McPherson axle. Kinematics follow from the topology and agree almost fully. Compliances follow
  from ratios of stiffnesses and from small lever arms, and do not: the published drive and brake steer are
  led by `llr Fx`, here by `llf Fx`. Moving the example's inner tie-rod joint 30 mm back, or softening the
  rear arm bush, brings these two columns from about 0.45 to 0.65 and more (table): it is the car, not the
  solver.
- **Copying slip.** `upb Tz`, `sff Tz` and `sfr Tz` repeat the row `Fy` of the same bushing. A torsion
  stiffness about a nearly vertical axis does next to nothing; without these rows the mean rises.
- **Top mount.** `upb Fy` (and its copy) has 60 % of the published roll camber change, 17 % here. That is
  what keeps roll camber change below the other kinematic columns: without these two rows it rises as the
  table shows.
- **Coarse numbers.** Several published columns take few values: roll camber change only multiples of 20
  %, lateral camber change of 33 %, with 30 mm offset of 25 %, steering ratio of 5 %, lateral toe change
  of 9 %. The outputs had few digits, so that one last digit is up to a third of the largest change: 20 %
  for parameters that do nothing, such as `LLR x` in roll camber change. Rounding the example likewise
  changes its columns little (table): what costs is the rounding noise in the published ones.
- **Signs.** Whole columns have the opposite sign (−), from the convention of their load case. Beyond that
  the rows of x have the opposite sign of all others: with them reversed the signed mean is
  {reversed_signed:.3f}, and what is left of it is the other axle.
- **Caster.** The published caster change is the kingpin's: with it the column correlates at {kingpin:.3f},
  with the angle that the knuckle carries, which is what a rig sees, only at {knuckle:.3f}, because that
  angle also answers to `LWD x`, on which the published column has 0 %.
- **What does not matter.** Wider fit windows (table).
"""

STRONG = 20.0


def markdown(
    table: pd.DataFrame,
    causes: pd.DataFrame,
    knuckle_caster: float,
    reversed_signed: pd.Series,
    section: str,
) -> str:
    """The report: means, the table by column, the reasons for the differences, and the section on signs."""
    turned = float(reversed_signed.mean())
    head = HEAD.format(
        absolute=table["absolute"].mean(),
        without=table["absolute_without_slips"].mean(),
        signed=table["signed"].mean(),
        reversed_signed=turned,
        same=table["same_sign"].sum(),
        entries=table["strong_entries"].sum(),
        strong=STRONG,
    )
    rows = "\n".join(_row(str(name), entry) for name, entry in table.iterrows())
    kingpin = table.loc["vertical.caster_change", "absolute"]
    lines = "\n".join(_cause(str(name), entry) for name, entry in causes.iterrows())
    tail = TAIL.format(kingpin=kingpin, knuckle=knuckle_caster, causes=lines, reversed_signed=turned)
    return head + rows + "\n" + tail + section


def _cause(name: str, entry: pd.Series) -> str:
    columns = (
        "mean",
        "roll.camber_change",
        "lateral.camber_change",
        "drive.drive_steer",
        "brake.brake_steer",
    )
    return f"| {name} | " + " | ".join(f"{entry[c]:.3f}" for c in columns) + " |"


def _row(name: str, entry: pd.Series) -> str:
    return (
        f"| `{name}` | {entry['absolute']:.3f} | {entry['absolute_without_slips']:.3f} "
        f"| {entry['signed']:.3f} | {'+' if entry['overall_sign'] > 0 else '−'} "
        f"| {entry['same_sign']} of {entry['strong_entries']} "
        f"| {entry['strongest_published']} | {entry['strongest_own']} |"
    )
