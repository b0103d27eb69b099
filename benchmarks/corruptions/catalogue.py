"""Every corruption, in the order in which they are made of one car after the other."""

from __future__ import annotations

from corruptions.bench import alignments
from corruptions.channels import columns, copies, sides, signs, units
from corruptions.edit import Corruption
from corruptions.inputs import input_offsets, input_signs, input_units
from corruptions.runs import load_cases, repeats
from corruptions.samples import sample_faults

KINDS = (
    signs, input_signs, sides, columns, units, input_units, load_cases, repeats, sample_faults, input_offsets,
    copies, alignments,
)  # fmt: skip


def catalogue() -> list[Corruption]:
    """Every corruption, by kind."""
    return [corruption for kind in KINDS for corruption in kind()]
