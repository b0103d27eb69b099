"""The words of statistics and of the method that a page uses, for those who want to know."""

from __future__ import annotations

from collections.abc import Mapping

from doe_kc.reports.render.page import Section, render

GLOSSARY: Mapping[str, str] = {
    "noise": (
        "What a response scatters between repeat runs on the same rig, with what its sensors leave open."
    ),
    "times the noise": (
        "Root mean square of model minus measured, divided by the noise of each point; 1 × means that "
        "model and car differ as much as two runs of the same car. In files: gap, whitened RMS."
    ),
    "± uncertainty": "One standard deviation: in two of three cases the true value is inside.",
    "sure (98 %)": (
        "Probability of the effect against every other effect of the library in its place, against "
        "none, and against something that the library does not list."
    ),
    "odds": (
        "log10 odds: how many powers of ten likelier than its best alternative; above 6 no more is said."
    ),
    "evidence": (
        "ln evidence: logarithm of how probable the records are under a model, all its parameters "
        "re-tuned; it charges for added freedom. The gain is that over the model without the effect."
    ),
    "best other effect": (
        "The refit of another effect in place of the one found, for comparison; in files: decoy."
    ),
    "standard deviations beyond noise": (
        "How far a deviation of a certain shape is outside what noise makes; beyond 4 it is hardly "
        "ever noise."
    ),
    "held out": (
        "A load case that was not used in a fit and is predicted from all others: what is right "
        "predicts what it has not seen."
    ),
    "adequacy": (
        "How often noise alone would leave as much as remains; a small share means that something "
        "else is at work."
    ),
    "interval": (
        "Band about a target in which a characteristic counts as met: equations 5.1 and 5.2 of the "
        "thesis, about ± 15 %."
    ),
    "rating": "Weighted sum of all deviations from the targets, equation 2.2 of the thesis; 0 is best.",
    "improvement": "Share of the first deviation from a target that is gone; 100 % is on target.",
    "not visible": ("The records do not tell the parameter at least twice as well as was assumed before."),
    "scatter": ("What cars of one design differ by in a parameter: one standard deviation, of either side."),
    "first order": "By the slopes of the unchanged axle alone, as if every characteristic were a plane.",
    "total share": (
        "Share of a variance that a parameter takes part in, alone or with others; an interaction counts for "
        "each of its partners."
    ),
    "95 % interval": "Of a counted share: where the true one is with 95 % confidence (Wilson).",
    "prior": (
        "What is assumed of a parameter before the records: its nominal value and the scatter of production."
    ),
}
"""Term as the pages write it -> what it means."""


def glossary_section(*terms: str) -> Section:
    """The words of one page, folded. KeyError for one that is not in the glossary."""
    html = render("glossary.html", terms={term: GLOSSARY[term] for term in terms})
    return Section("Words", html, folded="What the words of statistics mean")
