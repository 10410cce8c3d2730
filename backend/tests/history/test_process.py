"""The process that looks back for the server: it may be late, and it may die, and the next question is answered."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator

import pytest

from history.journalled import worked
from sequence_planner.db.database import Database
from sequence_planner.execution.record.codec import HistoryError
from sequence_planner.forking.starting import children
from sequence_planner.history.client import HistoryProcess
from sequence_planner.history.timeline import LookBack, MomentView
from support.places import BOLT_TIGHTENING

PATIENCE = 120.0


@pytest.fixture(scope="module")
def database() -> Iterator[Database]:
    with worked(3.0) as (made, _):
        yield made


def test_one_that_is_late_or_dies_is_replaced(database: Database) -> None:
    async def told() -> list[str]:
        process = HistoryProcess(BOLT_TIGHTENING, f"sqlite:///{database.place}")
        slugs = []
        try:
            for patience, act in ((0.01, "wait"), (PATIENCE, "kill"), (PATIENCE, "wait")):
                asked = asyncio.create_task(process.ask(LookBack(5), patience))
                if act == "kill":
                    await asyncio.sleep(0.1)
                    (running,) = (each for each in children() if each.name == "looking-back")
                    running.kill()
                try:
                    found = await asked
                    assert isinstance(found, MomentView)
                    slugs.append(found.record.kind)
                except HistoryError as error:
                    slugs.append(error.slug)
        finally:
            process.close()
        return slugs

    *slugs, kind = asyncio.run(told())
    assert slugs == ["history-timeout", "history-failed"]
    assert kind in ("ticked", "asked", "answered")


def test_questions_wait_for_their_turn(database: Database) -> None:
    async def told() -> list[int]:
        process = HistoryProcess(BOLT_TIGHTENING, f"sqlite:///{database.place}")
        try:
            found = await asyncio.gather(*(process.ask(LookBack(number), PATIENCE) for number in (4, 2, 3)))
        finally:
            process.close()
        return [each.record.number for each in found if isinstance(each, MomentView)]

    assert asyncio.run(told()) == [4, 2, 3]
