"""The garbage collector stands still inside, and goes on as before."""

from __future__ import annotations

import gc

import pytest

from doe_kc.ground.garbage_collection import no_garbage_collection


def test_the_collector_stands_still_inside_and_goes_on_afterwards() -> None:
    assert gc.isenabled()
    with pytest.raises(ValueError, match="inside"), no_garbage_collection():
        assert not gc.isenabled()
        with no_garbage_collection():
            assert not gc.isenabled()
        assert not gc.isenabled()
        raise ValueError("inside")
    assert gc.isenabled()


def test_a_collector_that_stood_still_before_does_so_afterwards() -> None:
    gc.disable()
    try:
        with no_garbage_collection():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()
