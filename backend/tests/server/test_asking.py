"""What the server asks the controller over the socket: no answer is waited for too long, and no command by it."""

from __future__ import annotations

import asyncio
import json
import time
from pathlib import Path
from typing import Any, ClassVar

import pytest

from sequence_planner.controller.commands.command import CommandRefused, Query
from sequence_planner.controller.commands.execution import SetMode
from sequence_planner.controller.commands.queries import AboutFlows, AboutPipelines
from sequence_planner.controller.ipc import MOST_ASKS, ControllerClient, ControllerLink
from sequence_planner.controller.views.part import View
from sequence_planner.controller.views.pipelines import FlowsView, PipelinesView
from sequence_planner.core.data_models import DataModel
from sequence_planner.execution.vocabulary import Mode
from support.example_view import example_view
from support.waiting import patience, until_async

from .test_link import ACTOR, accept, connected, path, peer_of

__all__ = ["path"]  # the fixture


class Answers:
    """A controller that answers at once, and what passes only when it is let."""

    def __init__(self) -> None:
        self.let = asyncio.Event()
        self.waiting = 0
        self.given_up = 0

    async def answer(self, ask: Query[Any]) -> DataModel:
        if isinstance(ask, AboutPipelines):
            return PipelinesView(pipelines={})
        self.waiting += 1
        try:
            await self.let.wait()
        except asyncio.CancelledError:
            self.given_up += 1
            raise
        finally:
            self.waiting -= 1
        return FlowsView(time=1.0, pipelines={})


class Hasty(AboutFlows):
    """Somebody who does not wait for long."""

    patience: ClassVar[float | None] = 0.2


def test_answers_come_as_the_documents_they_are_and_no_command_waits_for_one(path: Path) -> None:
    async def scenario() -> None:
        answers = Answers()
        async with ControllerLink(path, accept, answers.answer) as link:
            link.publish(example_view())
            client = ControllerClient(path)
            running = await connected(client)
            flows = [asyncio.create_task(client.ask(AboutFlows())) for _ in range(MOST_ASKS)]
            await until_async(lambda: answers.waiting == MOST_ASKS)
            with pytest.raises(CommandRefused) as refused:
                await client.ask(AboutPipelines())
            assert (refused.value.slug, refused.value.status) == ("controller-busy", 503)
            await client.send(SetMode(actor=ACTOR, mode=Mode.PAUSED))
            answers.let.set()
            assert await asyncio.gather(*flows) == [FlowsView(time=1.0, pipelines={})] * MOST_ASKS
            assert await client.ask(AboutPipelines()) == PipelinesView(pipelines={})
            running.cancel()

    asyncio.run(scenario())


def test_an_answer_that_would_come_too_late_is_given_up(path: Path) -> None:
    async def scenario() -> None:
        answers = Answers()
        async with ControllerLink(path, accept, answers.answer) as link:
            link.publish(example_view())
            client = ControllerClient(path)
            running = await connected(client)
            began = time.monotonic()
            with pytest.raises(CommandRefused, match="Nothing was changed by asking") as refused:
                await client.ask(Hasty())
            assert (refused.value.slug, refused.value.status) == ("answer-timeout", 504)
            assert time.monotonic() - began < patience(2)
            assert (answers.waiting, answers.given_up) == (0, 1)
            running.cancel()

    asyncio.run(scenario())


def test_who_leaves_is_looked_for_no_longer(path: Path) -> None:
    async def scenario() -> None:
        answers = Answers()
        async with ControllerLink(path, accept, answers.answer):
            line = {"kind": "ask", "id": 1, "ask": {"kind": "about-flows"}, "expires": time.monotonic() + 60}
            async with peer_of(path) as peer:
                peer.writer.write(json.dumps(line).encode() + b"\n")
                await until_async(lambda: answers.waiting == 1)
            await until_async(lambda: answers.given_up == 1)

    asyncio.run(scenario())


def test_who_hears_nothing_is_told_that_asking_changes_nothing(path: Path) -> None:
    """The controller hangs: not even its refusal comes."""

    async def hang(ask: Query[Any]) -> View:
        time.sleep(1.5)  # noqa: ASYNC251 - that is what hanging means
        return PipelinesView(pipelines={})

    async def scenario() -> None:
        async with ControllerLink(path, accept, hang) as link:
            link.publish(example_view())
            loop = asyncio.get_running_loop()
            await loop.run_in_executor(None, asyncio.run, asking())

    async def asking() -> None:
        client = ControllerClient(path)
        running = await connected(client)
        with pytest.raises(CommandRefused, match="Nothing was changed by asking") as refused:
            await client.ask(Hasty())
        assert (refused.value.slug, refused.value.status) == ("controller-timeout", 504)
        running.cancel()

    asyncio.run(scenario())
