"""The sheet of the discovery workbook that says how to read the others."""

from __future__ import annotations

from doe_kc.discovery.thresholds import RELEVANT

DISCOVERY_LEGEND = {
    "Frame": "Chassis: X rearwards, Y to the right, Z up, ground z = 0.",
    "Signs": "Toe-in +, camber top outwards +, caster top rearwards +; forces as their load case has them.",
    "Verdict": (
        "Effect named: the records ask for it, noise explains what remains, held-out load cases are "
        "predicted better. One of several: an effect is missing, but these records cannot tell which. No "
        "effect missing: re-tuning explains all records. Unexplained: something is missing, but no effect"
        " of the library is convincing; what is listed are leads."
    ),
    "Nominal": "The axle as it is in its file.",
    "Re-tuned": "The most probable axle without any effect: parameters within their production scatter.",
    "With effect": "The most probable axle with the effects found, all parameters re-tuned with them.",
    "Best decoy": (
        "The best other effect in place of the one found, refitted alike: a gap that a decoy closes as "
        "well is no evidence for a name."
    ),
    "Gap": (
        "RMS of model minus measured in units of the records' noise, correlations of the noise respected;"
        " 1 is noise. Noise floor: what the right model would reach, as its parameters follow the noise."
    ),
    "Disagreement": (
        "How much of one shape a curve's deviation holds, in standard deviations. Gradient: slope at "
        "static; curvature: even; progression: odd and cubic; dead band: a step about zero; loop width "
        "and loop tilt: of the half-width of the loop, (falling - rising) / 2; offset: constant, tyre "
        "load only."
    ),
    "Re-tuned z": (
        "Only what no re-tuning can absorb. With effect: the shape of its law is left open as far as the "
        "records ask for."
    ),
    "Wheels": "Both alike: sum of both wheels; left against right: their difference.",
    "Size, sd": (
        "Most probable value and its standard deviation, all parameters free together. 'Not told from "
        "rigid / none': the limit that the value passes with a chance of 5 %."
    ),
    "Probability": (
        "That it is this effect, in whatever place, all other effects in the model: among it, its removal "
        "and its rivals in its place, each refitted. An effect outside the library is another question: see "
        "the adequacy."
    ),
    "log10 odds": (
        "Of the effect against the best alternative, all others in the model: 2 is a hundred to one; 6 says "
        "6 or more."
    ),
    "Adequacy": (
        "How often noise alone leaves as much as remains: on the map of disagreements, and of load cases "
        "held out. Something that the library does not list has odds of 2 % before the records; what "
        "remains can raise them to the stated probability at most."
    ),
    "Trace": f"The records show it, but it is less than {RELEVANT:g} of its typical size.",
    "ln evidence": "Gained over the model without it; the price of its extra freedom is paid.",
    "Detectability": "Standard deviations that the effect makes after re-tuning.",
    "Detectable size": (
        "Would be found in four of five cars, and is above the 95 % limit of what the records say of it, if "
        "the model is right but for this effect; of several numbers all together. For a stiffness 'below': a "
        "softer part would have been found."
    ),
    "Absorbed": (
        "Share of the effect that re-tuning hides. Hidden by: the parameters that move most for it at its"
        " typical size, in standard deviations of their prior."
    ),
    "Looks like": "Hypotheses that change the records nearly alike after re-tuning, with the correlation.",
    "Held out": (
        "Each load case is left out of the fit and predicted; RMS in standard deviations of the "
        "prediction. Law granted: with what the laws of the effects leave open among the errors; by "
        "that the verdict goes. Gain: ln predictive density won by the effect."
    ),
}
