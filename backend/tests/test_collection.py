"""When reference cycles are looked for."""

from __future__ import annotations

import gc

from sequence_planner.process.gc_tuning import collection_put_off, collection_seldom


def test_collection_is_seldom_while_a_command_answers_and_as_usual_afterwards() -> None:
    usual = gc.get_threshold()
    try:
        with collection_seldom():
            assert gc.isenabled()
            assert gc.get_threshold()[0] > 100 * usual[0]
        assert gc.get_threshold() == usual
        assert gc.get_freeze_count() > 0
    finally:
        gc.unfreeze()


def test_collection_that_is_put_off_is_taken_up_again() -> None:
    assert gc.isenabled()
    with collection_put_off():
        assert not gc.isenabled()
    assert gc.isenabled()
