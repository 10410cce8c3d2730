"""Whatever goes wrong while a station is prepared, nobody waits for ever."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import Any

import pytest

from control.bench import cell
from sequence_planner.analysis.process import SynthesisEndedError
from sequence_planner.control.preparation import Preparation, analyse


def test_a_process_that_cannot_be_started_is_said() -> None:
    async def scenario() -> None:
        preparation = Preparation()

        def unsendable() -> None:
            """No process can be given a function that only this one has."""

        title: Any = unsendable
        await analyse(replace(cell()[0].automaton, title=title), preparation)
        with pytest.raises(SynthesisEndedError, match="could not be computed"):
            await preparation.supervisor

    asyncio.run(scenario())


def test_what_was_found_before_the_end_stays() -> None:
    async def scenario() -> None:
        preparation = Preparation()
        await analyse(cell()[0].automaton, preparation)
        assert preparation.analysis is not None
        assert preparation.analysis.supervised is True
        preparation.end(SynthesisEndedError("killed"))
        assert preparation.analysis.pending is None
        assert preparation.analysis.guards is not None
        assert (await preparation.supervisor) is not None

    asyncio.run(scenario())
