"""Prints the numbers by which discovery decides as docs/thresholds.md: `python reports/thresholds.py`."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from report_text import table

from doe_kc.discovery import thresholds

PAGE = Path(__file__).parents[1] / "docs" / "thresholds.md"
HEAD = """# The numbers by which discovery decides

Printed from `doe_kc/discovery/thresholds.py` by `python reports/thresholds.py`; the terms are those of
the [glossary](glossary.md), the steps those of [discovery](discovery.md). "A choice" says that neither
statistics nor the accuracy of rigs and benches fixes the number; what speaks for it follows. What other
values give is measured by `python -m benchmarks.thresholds`.
"""


@dataclass(frozen=True)
class Threshold:
    """One number. unit: `-` without one. decides: what it bounds or sets; reason: where it comes from."""

    section: str
    name: str
    value: str
    unit: str
    decides: str
    reason: str


def thresholds_of(source: str) -> Iterator[Threshold]:
    """Every constant of the module's source, in its order, with the section comment above it.

    ValueError for a constant whose docstring is not `unit, decision. Reason.`
    """
    lines, section = source.splitlines(), ""
    body = ast.parse(source).body
    for node, words in pairwise(body):
        if not isinstance(node, ast.Assign):
            continue
        above = [line[2:] for line in lines[: node.lineno - 1] if line.startswith("# ")]
        section = above[-1] if above else section
        (target,) = node.targets
        name, value = ast.unparse(target), ast.unparse(node.value)
        text = _docstring(words)
        unit, _, rest = text.partition(", ")
        decides, _, reason = rest.partition(". ")
        if not (unit and decides and reason):
            raise ValueError(f"{name}: its docstring is not `unit, decision. Reason.`: {text!r}")
        yield Threshold(section, name, value, unit, decides, reason)


def _docstring(node: ast.stmt) -> str:
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return " ".join(str(node.value.value).split())
    return ""


def page() -> str:
    """The page in Markdown, a table for each section."""
    rows = list(thresholds_of(Path(thresholds.__file__).read_text("utf-8")))
    parts = [HEAD]
    for section in dict.fromkeys(r.section for r in rows):
        cells = [
            [f"`{r.name}`", _escaped(r.value), _escaped(r.unit), _escaped(r.decides), _escaped(r.reason)]
            for r in rows
            if r.section == section
        ]
        head = ("name", "value", "unit", "what it decides", "why, or from where")
        parts.append(f"## {section}\n\n{table(head, cells)}\n")
    return "\n".join(parts)


def _escaped(text: str) -> str:
    return text.replace("|", r"\|")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
