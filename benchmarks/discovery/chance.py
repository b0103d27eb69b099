"""Random numbers of a hidden car: one independent stream per purpose, the same on every machine."""

from __future__ import annotations

import math
import zlib

import numpy as np


def stream(seed: int, *purpose: str) -> np.random.Generator:
    """Generator that depends on the seed and the words only, so that one part's draws move no other's."""
    return np.random.default_rng([seed, *(zlib.crc32(word.encode()) for word in purpose)])


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """Between low and high, equally likely in each ratio."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def spread(rng: np.random.Generator, centre: float, sd: float) -> float:
    """Log-normal about `centre`; sd of the logarithm, cut at two and a half."""
    return centre * math.exp(sd * cut_normal(rng))


def cut_normal(rng: np.random.Generator, limit: float = 2.5) -> float:
    """Standard normal, cut at `limit`: production rejects what lies further out."""
    return float(np.clip(rng.standard_normal(), -limit, limit))


def sign(rng: np.random.Generator) -> float:
    """-1 or 1."""
    return 1.0 if rng.random() < 0.5 else -1.0
