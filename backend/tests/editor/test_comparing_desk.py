"""The desk where versions of a model are compared: once for all who ask, piece by piece, and for nobody no longer."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

from editor.models import bolts
from sequence_planner.editor import processes
from sequence_planner.editor.processes import ComparisonDesk, working
from sequence_planner.editor.schemas.diff import ComparisonView
from support.places import BOLT_TIGHTENING
from support.told import as_message
from support.waiting import until_async

PATIENCE = 60.0  # seconds
OTHER = {"operations": ("priority: 1", "priority: 2")}


def run(scenario: Callable[[ComparisonDesk], Awaitable[None]]) -> None:
    async def live() -> None:
        desk = ComparisonDesk(BOLT_TIGHTENING)
        try:
            async with asyncio.timeout(2 * PATIENCE):
                await scenario(desk)
        finally:
            await desk.close()

    asyncio.run(live())


async def ask(desk: ComparisonDesk, patience: float) -> ComparisonView:
    told = await desk.compare(bolts(), bolts(**OTHER), patience)
    return ComparisonView.model_validate_json(told)


def test_what_is_known_by_then_is_told_until_all_is() -> None:
    async def scenario(desk: ComparisonDesk) -> None:
        view = await ask(desk, 0.0)
        assert view.parts is None
        while view.doing:
            assert view.doing_message is not None
            assert view.doing == as_message(view.doing_message)
            view = await ask(desk, 0.1)
        assert list(view.text) == ["operations.yaml"]
        assert view.parts
        assert view.plans == []
        assert view.seconds > 0

    run(scenario)


def test_two_who_ask_share_the_work_and_later_ones_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    works: list[str] = []

    def counted(name: str, *arguments: object) -> object:
        works.append(name)
        return working(name, *arguments)

    monkeypatch.setattr(processes, "working", counted)

    async def scenario(desk: ComparisonDesk) -> None:
        one, other = await asyncio.gather(ask(desk, PATIENCE), ask(desk, PATIENCE))
        assert one == other == await ask(desk, 0.0)
        assert one.doing == ""
        assert works == ["comparing.comparison:comparison"]

    run(scenario)


def test_nobody_asks_and_it_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "LEFT_AFTER", 0.05)
    ended = asyncio.Event()

    async def endless(_: ComparisonDesk, *asked: object, **how: object) -> None:
        try:
            await asyncio.Event().wait()
        finally:
            ended.set()

    monkeypatch.setattr(ComparisonDesk, "_tell", endless)

    async def scenario(desk: ComparisonDesk) -> None:
        waiting = asyncio.create_task(ask(desk, 0.3))
        await asyncio.sleep(0.2)
        assert not ended.is_set(), "somebody waits for it"
        await waiting
        await ended.wait()

    run(scenario)


def test_what_others_are_compared_with_is_known_before_somebody_asks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cache = tmp_path / "cache"
    cache.mkdir(mode=0o700)
    monkeypatch.setenv("XDG_CACHE_HOME", str(cache))

    async def scenario(desk: ComparisonDesk) -> None:
        for _ in range(2):
            desk.warm_up(bolts())
        kept = cache / "sequence-planner"
        await until_async(lambda: list(kept.glob("KeptGuards-*")))

    run(scenario)


def test_only_what_is_written_is_told_soon() -> None:
    async def scenario(desk: ComparisonDesk) -> None:
        told = await desk.compare(bolts(), bolts(**OTHER), PATIENCE, written_only=True)
        view = ComparisonView.model_validate_json(told)
        assert view.doing == ""
        assert view.parts
        assert (view.behaviour, view.plans, view.guards) == (None, None, None)
        assert (await ask(desk, PATIENCE)).plans == []

    run(scenario)


def test_a_model_that_cannot_be_used_is_told_with_why(tmp_path: Path) -> None:
    async def scenario(desk: ComparisonDesk) -> None:
        told = await desk.compare(bolts(), bolts(operations=("priority: 1", "priority: one")), PATIENCE)
        view = ComparisonView.model_validate_json(told)
        assert view.doing == ""
        assert "the newer one cannot be used" in str(view.obstacle)

    run(scenario)
