"""Runs every peer with every seed once; each result is a JSON file, so an interrupted benchmark goes on.

Files of our own methods lie in a folder named by the fingerprint of the product's source, those of the others
in one named by the problem's answers: runs of different code or problems never mix.
"""

from __future__ import annotations

import hashlib
import json
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from optimizers import bayesian, least_squares, ours, scalar
from optimizers.asked import asked
from optimizers.counting import BudgetSpent, CountingSolver, watched
from optimizers.peer import Peer

import doe_kc
from doe_kc.correlation.problem import Problem
from tests.correlation import cases

CAR = "car_b"


def fingerprint() -> str:
    """Of every source file of the imported package."""
    root = Path(doe_kc.__file__).parent
    found = hashlib.sha256()
    for place in sorted(root.rglob("*.py")):
        found.update(str(place.relative_to(root)).encode() + place.read_bytes())
    return found.hexdigest()[:12]


CODE = fingerprint()
"""Taken before the first run: sources may change under a long benchmark."""
PEERS: tuple[Peer, ...] = (*ours.PEERS, *bayesian.PEERS, *least_squares.PEERS, *scalar.PEERS)


@dataclass(frozen=True)
class Result:
    """One run. rating, deviation, feasible: an entry an evaluation. Seconds are of this process's CPU.

    expansions: exact sensitivities asked for, expansion_cpu: seconds of one. own_cpu: without the solver and
    sensitivities.
    """

    peer: str
    seed: int
    rating: list[float]
    deviation: list[float]
    feasible: list[bool]
    own_cpu: float
    solver_cpu: float
    expansions: int
    expansion_cpu: float
    stopped: str


def problem() -> Problem:
    """All default variables of the example axle against the car's records."""
    return cases.problem(CAR)


def run(peer: Peer, seed: int, on: Problem | None = None) -> Result:
    """One search."""
    asked = watched(on or problem())
    cases.solver(asked.axle)([asked.space.values(asked.space.start)])  # compiles the kernels
    solver = CountingSolver(asked, cases.solver(asked.axle), peer.budget, seconds=peer.seconds)
    started = time.process_time()
    try:
        stopped = peer.search(solver, seed)
    except BudgetSpent:
        full = len(solver.log.rating) >= peer.budget
        stopped = "budget used up" if full else f"{peer.seconds:g} s used up"
    slopes = sum(asked.asked)
    own = time.process_time() - started - solver.cpu - slopes
    return Result(
        peer=peer.id,
        seed=seed,
        **asdict(solver.log),
        own_cpu=own,
        solver_cpu=solver.cpu,
        expansions=len(asked.asked),
        expansion_cpu=slopes / max(len(asked.asked), 1),
        stopped=stopped,
    )


def folder_of(out: Path, peer: Peer, question: str) -> Path:
    """Where a peer's results lie."""
    return out / (CODE if peer.ours else f"problem_{question}")


def run_missing(out: Path, names: Sequence[str], most_seeds: int) -> None:
    """Every installed peer of `names` that has no result yet, seed by seed."""
    question = asked(problem())
    for peer in PEERS:
        if peer.id not in names or not peer.installed:
            continue
        folder = folder_of(out, peer, question)
        folder.mkdir(parents=True, exist_ok=True)
        for seed in range(1, min(peer.seeds, most_seeds) + 1):
            place = folder / f"{peer.id}_{seed}.json"
            if place.exists():
                continue
            result = run(peer, seed)
            place.write_text(json.dumps(asdict(result)))
            sys.stderr.write(
                f"{peer.id} {seed}: {len(result.rating)} evaluations, rating {max(result.rating):.3f}, "
                f"deviation {min(result.deviation) / result.deviation[0]:.2e}, {result.own_cpu:.1f} s, "
                f"{result.stopped}\n"
            )


def results(out: Path) -> Iterator[Result]:
    """All results of this code and problem so far."""
    question = asked(problem())
    for peer in PEERS:
        for place in sorted(folder_of(out, peer, question).glob(f"{peer.id}_[0-9].json")):
            yield Result(**json.loads(place.read_text()))
