"""Solves the load cases of many designs of one topology side by side; what `suite.solve` gives one by one.

A design that has no equilibrium in this way is only marked: `suite.solve` says why, or finds the longer way.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from doe_kc.axle.model import Axle
from doe_kc.axle.topology import TOPOLOGY_CACHE, Topology
from doe_kc.curves import RESPONSE_UNITS, SIDES
from doe_kc.ground.typing import FloatArray
from doe_kc.load_cases import Datum, LoadCase
from doe_kc.solver.batch_library import BatchMarch, BatchMarcher, BatchProblem, BatchStart
from doe_kc.solver.builder import HOLD_WHEEL, LOAD_CASE
from doe_kc.solver.compiled import adaptive_kernel
from doe_kc.solver.elimination import EliminationOrder, elimination_order
from doe_kc.solver.kernel import kernel, kernel_programs
from doe_kc.solver.newton import NewtonSettings
from doe_kc.solver.program_library import ProgramFunction
from doe_kc.solver.result import Failure
from doe_kc.solver.static import FAR, control_matrix, static_state
from doe_kc.solver.suite import SEEDS, branch_inputs, ordered_cases

RESPONSE_COLUMNS = tuple(f"{response}@{side}" for response in RESPONSE_UNITS for side in SIDES)
"""Outputs that curves are made of, in the order of the columns of every y here."""


@dataclass(frozen=True)
class BatchBranch:
    """input: (n,) in the case's unit, the same for all designs; y: (d, n, columns) by `RESPONSE_COLUMNS`."""

    name: str
    input: FloatArray
    y: FloatArray


@dataclass(frozen=True)
class BatchSolution:
    """Suites of d designs. static: (d, columns) outputs at rest; cases: load case, and its branches.

    failed: (d,) designs that have no solution here, whose rows hold nothing. half_track: (d,) mm.
    counts: as in `BatchMarch`, of all marches.
    """

    axle_name: str
    static: FloatArray
    cases: Mapping[str, tuple[LoadCase, tuple[BatchBranch, ...]]]
    failed: np.ndarray
    half_track: FloatArray
    counts: np.ndarray


def solve_batch(
    axle: Axle,
    changes: Mapping[str, FloatArray],
    library: BatchMarcher,
    settings: NewtonSettings | None = None,
) -> BatchSolution:
    """All load cases of the axle with some internal values replaced: name -> (d,), at least one.

    LinAlgError where the axle itself gives no order of elimination.
    """
    return _BatchSuite(axle, changes, library, settings or NewtonSettings()).run()


class _BatchSuite:
    def __init__(
        self, axle: Axle, changes: Mapping[str, FloatArray], library: BatchMarcher, settings: NewtonSettings
    ) -> None:
        self._axle, self._changes, self._library, self._settings = axle, changes, library, settings
        self._kernel = kernel(axle.topology)
        self._designs = len(next(iter(changes.values())))
        names = self._kernel.layout.parameter_names
        base = np.array([axle.values[name] for name in names])
        parameters = np.tile(base, (self._designs, 1))
        for column, name in enumerate(names):
            if name in changes:
                parameters[:, column] = changes[name]
        self._c = library.constants(parameters)
        self._orders = _reference_orders(axle.topology, base.tobytes())
        if not self._orders.ready:
            self._orders.begin(axle, settings)
        self._columns = np.array([self._kernel.layout.output_names.index(name) for name in RESPONSE_COLUMNS])
        self._failed = np.zeros(self._designs, dtype=bool)
        self._counts = np.zeros(4, dtype=np.int64)

    def run(self) -> BatchSolution:
        x, z, y, datum = self._static_states()
        cases = {}
        for ident in ordered_cases(self._axle.load_cases):
            case = self._axle.load_cases[ident]
            cases[ident] = case, self._branches(case, x, z, y, datum)
        half_track = np.abs(self._value("WLC.y@L")[:, 0])
        return BatchSolution(self._axle.name, y, cases, self._failed, half_track, self._counts)

    def _value(self, name: str, default: float = 0.0) -> FloatArray:
        """(d, 1) an internal value of every design."""
        value = self._changes.get(name, self._axle.values.get(name, default))
        return np.broadcast_to(np.asarray(value, dtype=float).reshape(-1, 1), (self._designs, 1))

    def _march(
        self, start: BatchStart, s: FloatArray, u: FloatArray, *, full: bool = False, held: bool = False
    ) -> BatchMarch:
        order = self._orders.order(full=full, held=held)
        problem = BatchProblem(self._c, start, s, u, self._columns, self._failed, self._settings)
        path = self._library.march(self._kernel, order, problem)
        self._failed = path.failed
        self._counts += path.counts
        return path

    def _controls(self, values: Mapping[str, float | FloatArray], n: int) -> FloatArray:
        """(d, n, nu) controls, see `control_matrix`."""
        return control_matrix(self._kernel, values, n, (self._designs,))

    def _static_states(self) -> tuple[FloatArray, FloatArray, FloatArray, Datum]:
        """x (d, nx), z (d, nz), outputs (d, columns) and datum at rest: see `static.static_state`."""
        k, d = self._kernel, self._designs
        guess = np.zeros((d, 1, k.nx))
        guess[:, 0, k.index("preload")] = self._value("tyre.static_load")[:, 0]
        u0 = self._controls({"hold_load": 1.0, "hold_height": 1.0, "bilateral": 1.0}, 1)
        zero, rest = np.zeros((d, 1)), np.zeros((d, k.nz))
        x0 = self._march(BatchStart(zero, guess, u0[:, 0], rest, guess=True), zero + 1.0, u0, full=True).x
        moved = np.abs((x0 - guess)[:, 0, : k.coordinates]) * k.scale[: k.coordinates]
        self._failed = self._failed | (moved.max(axis=1) > FAR)
        left, right, preload = (x0[:, :, k.index(name)] for name in ("pad L", "pad R", "preload"))
        offset = self._value("ride_height")
        pads = (left + offset, right + offset)
        frozen = self._controls({"pad_L": left, "pad_R": right, "preload": preload}, 1)
        u = self._controls({"pad_L": pads[0], "pad_R": pads[1], "preload": preload}, 1)
        s = np.where(offset == 0.0, 1.0, offset)
        raised = self._march(BatchStart(zero, x0, frozen[:, 0], rest), s, u)
        y = raised.y[:, 0]
        heights = (y[:, [RESPONSE_COLUMNS.index("wc_z@L")]], y[:, [RESPONSE_COLUMNS.index("wc_z@R")]])
        rack = self._value("steering.rack_mm_per_rev")
        half_track = np.abs(self._value("WLC.y@L"))
        fields: tuple[Any, ...] = (pads, heights, preload, half_track, rack)
        return raised.x[:, 0], raised.z, y, Datum(*fields)

    def _branches(
        self, case: LoadCase, x: FloatArray, z: FloatArray, y: FloatArray, datum: Datum
    ) -> tuple[BatchBranch, ...]:
        """See `suite.solve`. x, z, y: at rest."""
        loop = self._kernel.topology.frictional
        done: list[BatchBranch] = []
        before, state, first = x[:, None], z, y
        seeds = np.zeros(0)
        for name, inputs in branch_inputs(case, loop=loop).items():
            values = {"preload": datum.preload, LOAD_CASE: 1.0, **case.driven(inputs, datum)}
            held = HOLD_WHEEL in values
            u = self._controls(values, len(inputs))
            s = np.broadcast_to(inputs, (self._designs, len(inputs)))
            known = np.broadcast_to(np.concatenate([seeds, inputs[:1]]), (self._designs, len(seeds) + 1))
            start = BatchStart(known, before, u[:, 0], state)
            path = self._march(start, s[:, 1:], u[:, 1:], full=held, held=held)
            done.append(BatchBranch(name, inputs, np.concatenate([first[:, None], path.y], axis=1)))
            if loop:
                before, state, first = path.x[:, -1:], path.z, path.y[:, -1]
            else:
                back = np.arange(SEEDS, 0, -1)
                seeds = inputs[back]
                before = np.concatenate([path.x[:, back - 1], x[:, None]], axis=1)
        return tuple(done)


class _ReferenceOrders:
    """Orders of elimination by what is solved for and held, from one axle at rest."""

    def __init__(self) -> None:
        self.ready = False
        self._orders: dict[tuple[bool, bool], EliminationOrder] = {}

    def begin(self, axle: Axle, settings: NewtonSettings) -> None:
        """Solve the axle, whose Jacobians the orders follow from."""
        self._kernel = k = kernel(axle.topology)
        compiled = adaptive_kernel(axle.topology)
        self._jacobian = ProgramFunction(kernel_programs(axle.topology)["jacobian"])
        self._c = k.constant_values(dict(axle.values))
        static = static_state(k, compiled, self._c, axle, settings)
        if isinstance(static, Failure):
            self._full = self._rest = np.zeros(k.nx), np.zeros(k.nu), np.zeros(k.nz)
        else:
            self._full, self._rest = (static.x0, static.u0, np.zeros(k.nz)), (static.x, static.u, static.z)
        self.ready = True

    def order(self, *, full: bool, held: bool) -> EliminationOrder:
        """full: all unknowns are solved for; held: the wheel centres are."""
        if (full, held) not in self._orders:
            x, u, z = self._rest if held or not full else self._full
            if held:
                height = {HOLD_WHEEL: 1.0, "bilateral": 1.0}
                u = u + control_matrix(self._kernel, dict(height), 1)[0]
            if not full:
                u = u + control_matrix(self._kernel, {LOAD_CASE: 1.0}, 1)[0]
            active = self._kernel.nx if full else self._kernel.nx - self._kernel.layout.tail
            nonzeros = self._jacobian(x, self._c, u, z)
            self._orders[full, held] = elimination_order(self._kernel, nonzeros, active)
        return self._orders[full, held]


@lru_cache(maxsize=TOPOLOGY_CACHE)
def _reference_orders(topology: Topology, values: bytes) -> _ReferenceOrders:
    del topology, values  # of which there is one for each
    return _ReferenceOrders()
