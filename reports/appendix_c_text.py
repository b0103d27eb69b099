"""The words of the report on Appendix C."""

from __future__ import annotations

import pandas as pd

HEAD = """# The influence matrix beside the published one

The influence matrix of `examples/front_axle` (one at a time, ±1 mm and ±10 %, central) beside Appendix C of
E. Wendeberg, *Using optimization to auto-correlate suspension characteristics to K&C measurements*, Chalmers
2013. Both in percent of each column's largest entry, over the published 57 rows. Made by
`python reports/appendix_c.py`, which also asserts the figures below.

| over the 21 columns | mean |
|---|---|
| correlation of the magnitudes, 57 rows | {absolute:.3f} |
| the same without the three slip rows | {without:.3f} |
| signed correlation, up to one sign a column | {signed:.3f} |
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

- **Another axle.** The published car's hardpoints and bushings are not given; the example is an invented,
  plausible McPherson axle. Kinematics depend on the topology first, so they agree almost fully; which bushing
  dominates a compliance depends on the ratios of stiffnesses, which differ. In the published matrix `llr Fx`
  leads drive and brake steer, here `llf Fx` does: the example's front bushing is soft enough in comparison
  for the arm to turn about the rear one.
- **Coarse numbers.** Several published columns take few values: roll camber change only multiples of 20 %,
  lateral camber change of 33 %, with 30 mm offset of 25 %, steering ratio of 5 %, lateral toe change of 9 %.
  Their characteristics were read from outputs of few digits, so that the largest change is 3 to 20 last digits;
  everything below half a digit is 0. That costs roll camber change most among the kinematic columns, and
  produces the published 33 % of parameters that do next to nothing.
- **Copying slip.** `upb Tz`, `sff Tz` and `sfr Tz` repeat the row `Fy` of the same bushing. A torsion
  stiffness about a nearly vertical axis does next to nothing; without these rows the mean rises.
- **Signs.** The published toe and caster angles change sign with the load case's own convention, which gives
  whole columns the opposite sign (column "sign"). Beyond that some published signs oppose each other inside a
  column (in caster change `LLF z` and `LLR z` are opposite to the example while `UPB x` and `LWB x` are not;
  in roll camber change against vertical camber change the strut points keep their relation and others do
  not), so no choice of one sign makes them agree, and the signed mean stays near 0.69.
- **Caster.** The published caster change is the kingpin's: with it the column correlates at {kingpin:.3f}, with
  the angle that the knuckle carries, which is what a rig sees, only at {knuckle:.3f}, because that angle also
  answers to `LWD x`, on which the published column has 0 %. Brake wind-up is the knuckle's angle.
- **What does not matter.** The half-width of the fit window (5 to 80 mm), and travel of wheel or pad as
  abscissa, change no column by more than 0.005.
"""

STRONG = 20.0


def markdown(table: pd.DataFrame, knuckle_caster: float) -> str:
    """The report: means, the table by column, and the reasons for the differences."""
    head = HEAD.format(
        absolute=table["absolute"].mean(),
        without=table["absolute_without_slips"].mean(),
        signed=table["signed"].mean(),
        same=table["same_sign"].sum(),
        entries=table["strong_entries"].sum(),
        strong=STRONG,
    )
    rows = "\n".join(_row(str(name), entry) for name, entry in table.iterrows())
    kingpin = table.loc["vertical.caster_change", "absolute"]
    return head + rows + "\n" + TAIL.format(kingpin=kingpin, knuckle=knuckle_caster)


def _row(name: str, entry: pd.Series) -> str:
    return (
        f"| `{name}` | {entry['absolute']:.3f} | {entry['absolute_without_slips']:.3f} "
        f"| {entry['signed']:.3f} | {'+' if entry['overall_sign'] > 0 else '−'} "
        f"| {entry['same_sign']} of {entry['strong_entries']} "
        f"| {entry['strongest_published']} | {entry['strongest_own']} |"
    )
