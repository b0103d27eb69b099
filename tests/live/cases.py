"""A session on a virtual car whose answer is known, made once."""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path
from typing import Any

from doe_kc.live.messages import read_message
from doe_kc.live.model import LiveModel, live_model
from doe_kc.live.session import Session, Update
from doe_kc.study import read_study
from doe_kc.workflow.measure import study_records

RIG = Path(__file__).parents[1] / "data" / "rig"
EXAMPLES = Path(__file__).parents[2] / "examples"


@lru_cache(maxsize=2)
def model(example: str = "front_axle") -> LiveModel:
    """The study of an example with its records reduced; the McPherson's are those of a car whose parameters
    alone differ from the axle file."""
    own = RIG / "car_b" if example == "front_axle" else None
    study = read_study(EXAMPLES / example, measurement=own)
    return live_model(study, study_records(study))


def session(example: str = "front_axle") -> Session:
    """A fresh session of that study."""
    return Session(model(example))


def say(live: Session, **message: Any) -> Update:
    """The session told a message of the page."""
    return live.handle(read_message(json.dumps(message)))
