"""A car with something hidden in it: its true axle, and what the rig reads of it without noise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.discovery import rig
from benchmarks.discovery.hidden import Hidden
from benchmarks.discovery.outside import Outside
from benchmarks.discovery.path import Bench, triangle
from doe_kc.axle import Axle
from doe_kc.axle.force_curve import curve_values
from doe_kc.axle.model import BUSHINGS, both
from doe_kc.curves import TYRE_LOAD
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import LoadCase


@dataclass(frozen=True)
class Car:
    """axle: scattered, without effects. hidden: what is to be found; clutter: what is small; outside: what
    no library has. warp: load case -> uneven speed of the rig, see `triangle`."""

    axle: Axle
    hidden: tuple[Hidden, ...]
    clutter: tuple[Hidden, ...]
    outside: Outside | None
    warp: Mapping[str, float]

    def true_axle(self, load: float = 0.0) -> Axle:
        """With all effects. load: -1 as soft as compliances are unloaded, 1 as stiff as under full load."""
        axle = self.axle
        tables = {k: v for h in self.hidden for k, v in h.tables.items()}
        if tables:
            axle = with_tables(axle, tables)
        for member in (*self.clutter, *self.hidden):
            axle = member.applied(axle, load)
        return self.outside.axle(axle) if self.outside is not None else axle

    def clean(self) -> CleanRecords:
        """What a rig without noise reads. NotConverged when the axle has no equilibrium somewhere."""
        stiffens = any(h.stiffening for h in (*self.hidden, *self.clutter))
        benches = [Bench(self.true_axle(load)) for load in ((-1.0, 1.0) if stiffens else (0.0,))]
        static = benches[0].static
        loops = {}
        for name, case in benches[0].axle.load_cases.items():
            inputs = triangle(case.amplitude, self.warp.get(name, 0.0))
            done, path = rig.driven(case, inputs, self.axle, self.hidden)
            ends = [bench.loop(done, path) for bench in benches]
            relative = inputs[:-1] / case.amplitude
            channels = _blended(ends, [bench.static for bench in benches], np.abs(relative))
            channels = rig.read(case, inputs[:-1], channels, static, self.hidden)
            if self.outside is not None:
                channels = self.outside.read(name, relative, channels)
            loops[name] = CleanLoop(case, inputs[:-1], channels)
        return CleanRecords(loops, static)


@dataclass(frozen=True)
class CleanLoop:
    """One load case: inputs (n,) and response -> (2, n), absolute."""

    case: LoadCase
    input: FloatArray
    channels: Mapping[str, FloatArray]

    def change(self, response: str) -> FloatArray:
        """(2, n) from the middle of the falling branch, near static: what a gain error multiplies."""
        middle = self.input.size // 4
        values = self.channels[response]
        return np.asarray(values - values[:, middle : middle + 1])


@dataclass(frozen=True)
class CleanRecords:
    """loops: load case -> loop. static: response -> (2,) at rest."""

    loops: Mapping[str, CleanLoop]
    static: Mapping[str, FloatArray]

    def recorded(self, case: str, response: str) -> FloatArray:
        """(2, n) as records hold it: change from static, tyre load absolute."""
        values = self.loops[case].channels[response]
        return values if response == TYRE_LOAD else values - self.static[response][:, None]


def _blended(
    ends: list[dict[str, FloatArray]], statics: list[Mapping[str, FloatArray]], load: FloatArray
) -> dict[str, FloatArray]:
    """Between the axle unloaded and under full load, as the load goes (n,): equilibria of springs whose
    stiffness follows the load. The state at rest is one: what a preloaded spring has sagged stays."""
    if len(ends) == 1:
        return ends[0]
    out = {}
    for response in ends[0]:
        rest = [static.get(response, np.zeros(2))[:, None] for static in statics]
        changes = [end[response] - at for end, at in zip(ends, rest, strict=True)]
        out[response] = (rest[0] + rest[1]) / 2.0 + (1.0 - load) * changes[0] + load * changes[1]
    return out


def with_tables(axle: Axle, tables: Mapping[tuple[str, str], list[list[float]]]) -> Axle:
    """The axle with some bushing axes tabulated, [[d, F], ...] in mm and N."""
    values: dict[str, float] = {}
    for (name, of), points in tables.items():
        x, y = np.array(points).T
        for key, value in curve_values(f"{name}.table.{of}", x, y).items():
            values |= both(key, value)
    order = list(BUSHINGS)
    entries = sorted(
        ((name, of, len(points)) for (name, of), points in tables.items()),
        key=lambda e: (order.index(e[0]), e[1]),
    )
    return replace(axle.changed(values), topology=replace(axle.topology, tables=tuple(entries)))
