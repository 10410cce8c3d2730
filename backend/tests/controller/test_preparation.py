"""Whatever goes wrong while a station is prepared, nobody waits for ever."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from sequence_planner.analysis.store import known_supervisor
from sequence_planner.cli.analysing import Limits, checked, supervisor_of
from sequence_planner.controller.preparation import Preparation, analyse
from sequence_planner.process.task import TooLargeError, WorkerError
from support.cell import cell


def test_a_process_that_cannot_be_started_is_said(tmp_path: Path) -> None:
    async def scenario() -> None:
        preparation = Preparation()

        def unsendable() -> None:
            """No process can be given a function that only this one has."""

        title: Any = unsendable
        await analyse(replace(cell()[0].automaton, title=title), preparation, tmp_path)
        with pytest.raises(WorkerError, match="could not be computed"):
            await preparation.supervisor

    asyncio.run(scenario())


def test_a_model_of_which_it_is_not_known_what_is_safe_stays_and_can_be_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A controller that ended with it would be started again for ever, and the first one would end the station."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))

    async def scenario() -> None:
        preparation = Preparation()
        monkeypatch.setattr("sequence_planner.controller.preparation.ANALYSIS_DEADLINE", 0.001)
        await analyse(cell()[0].automaton, preparation, tmp_path)
        assert await preparation.supervisor is None
        assert preparation.analysis is not None
        assert preparation.analysis.supervised is False
        refusal = preparation.refusal()
        assert (refusal.slug, refusal.title) == ("no-supervisor", "It is not known what is safe")
        assert "could not be computed within 0.001 s" in refusal.detail
        other = Preparation()
        other.end(TooLargeError("it takes more than 2 GB of memory"))
        assert (await other.supervisor, other.trouble) == (None, "it takes more than 2 GB of memory")

    asyncio.run(scenario())


def test_what_was_found_before_the_end_stays(tmp_path: Path) -> None:
    async def scenario() -> None:
        preparation = Preparation()
        await analyse(cell()[0].automaton, preparation, tmp_path)
        assert preparation.analysis is not None
        assert preparation.analysis.supervised is True
        preparation.end(WorkerError("killed"))
        assert preparation.analysis.pending is None
        assert preparation.analysis.guards is not None
        assert (await preparation.supervisor) is not None

    asyncio.run(scenario())


def test_at_the_next_start_it_is_there_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tmp_path.chmod(0o700)

    async def scenario() -> None:
        first = Preparation()
        await analyse(cell()[0].automaton, first, tmp_path)
        monkeypatch.setattr("sequence_planner.controller.preparation.analysing", None)  # nothing is computed again
        second = Preparation()
        await analyse(cell()[0].automaton, second, tmp_path)
        assert await second.supervisor == await first.supervisor
        assert second.analysis == first.analysis

    asyncio.run(scenario())


@pytest.mark.parametrize("command", ["plan", "check"])
def test_what_is_safe_is_there_at_once_where_a_command_has_found_it(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A model whose safe states take longer than a station waits for them can be run after such a command."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    automaton = cell()[0].automaton
    if command == "plan":
        found = supervisor_of(automaton)
    else:
        checked(automaton, None, Limits())
        known = known_supervisor(automaton)
        assert known is not None
        found = known

    async def scenario() -> None:
        monkeypatch.setattr("sequence_planner.controller.preparation.ANALYSIS_DEADLINE", 0.001)
        monkeypatch.setattr("sequence_planner.controller.preparation.PUT_OFF", 0.0)
        preparation = Preparation()
        await analyse(automaton, preparation, tmp_path)
        assert await preparation.supervisor == found
        assert preparation.analysis is not None
        assert preparation.analysis.supervised is True
        assert preparation.trouble is None

    asyncio.run(scenario())
