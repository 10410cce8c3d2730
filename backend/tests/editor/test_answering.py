"""A process that is asked about the draft again and again ends when nobody asks, and knows everything when it is."""

from __future__ import annotations

import asyncio
import json

from sequence_planner.editor.processes import DraftProcess
from sequence_planner.forking.child import Child
from sequence_planner.forking.starting import children
from sequence_planner.model.files import read_files
from support.places import BOLT_TIGHTENING
from support.waiting import until_async


def living() -> list[Child]:
    return [child for child in children() if child.name == "editing_worker"]


def test_it_ends_when_nobody_asks_and_is_told_everything_again_with_the_next_question() -> None:
    files = read_files(BOLT_TIGHTENING)

    async def shown(editing: DraftProcess) -> object:
        answer = await editing.ask(files, "shown", 1, None)
        assert isinstance(answer, str)
        return json.loads(answer)

    async def scenario() -> None:
        editing = DraftProcess("editing_worker", rests_after=2.0)
        try:
            first = await shown(editing)
            (before,) = living()
            assert await shown(editing) == first
            assert [each.pid for each in living()] == [before.pid], "it is kept as long as somebody asks"
            await until_async(lambda: not living())
            assert await shown(editing) == first
        finally:
            editing.close()
        assert living() == []

    asyncio.run(scenario())
