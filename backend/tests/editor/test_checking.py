"""What is found in a draft: piece by piece, in a process that can be killed."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import tempfile
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

from editor.models import bolts
from sequence_planner.editor.checks import checked
from sequence_planner.editor.processes import CheckDesk, DraftProcess, working
from sequence_planner.editor.schemas.check import CheckState, CheckView
from sequence_planner.forking.starting import children
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.process.task import WorkerError
from support.places import BOLT_TIGHTENING
from support.told import as_message
from support.waiting import PATIENCE, until_async


def last(tmp_path: Path, files: dict[str, str]) -> CheckView:
    *_, found = checked(1, files, BOLT_TIGHTENING, StartNeeds(), tmp_path)
    return found


def test_a_model_is_found_fit_with_what_its_supervisor_adds(tmp_path: Path) -> None:
    found = list(checked(7, bolts(), BOLT_TIGHTENING, StartNeeds(), tmp_path))
    assert [each.state for each in found[:-1]] == [CheckState.CHECKING] * (len(found) - 1)
    assert found[0].doing == "reading it"
    for each in found[:-1]:
        assert each.doing_message is not None
        assert each.doing == as_message(each.doing_message)
    done = found[-1]
    assert (done.number, done.state, done.doing, done.findings) == (7, CheckState.DONE, "", [])
    assert done.hindrance(done.number) is None
    assert done.summary is not None
    assert (done.summary.abilities, done.summary.operations) == (13, 8)
    assert done.summary.examples == 0
    assert [each.what for each in done.looked] == list(dict.fromkeys(each.doing for each in found[:-1]))
    assert all(each.seconds >= 0 for each in done.looked)
    assert done.analysis is not None
    assert done.analysis.guards


def test_errors_stand_at_their_places_in_the_files_of_the_model(tmp_path: Path) -> None:
    done = last(tmp_path, bolts(operations=("goal: robot.tool_is_attached", "goal: robot.tool_is_atached")))
    (finding,) = done.findings
    assert (finding.severity, finding.file) == ("error", "operations.yaml")
    assert (finding.line, finding.column) != (1, 1)
    assert "did you mean `robot.tool_is_attached`" in finding.message
    assert (done.state, done.summary) == (CheckState.DONE, None)
    assert finding.said is not None
    assert finding.message == as_message(finding.said)
    hindrance = done.hindrance(1)
    assert hindrance is not None
    assert as_message(hindrance.why).arguments["what"] == finding.said
    assert hindrance.slug == "check-found-errors"
    assert f"operations.yaml:{finding.line}:{finding.column}: {finding.message.rstrip('.')}" in hindrance.why
    ahead = done.hindrance(2)
    assert ahead is not None
    assert ahead.slug == "not-checked"


def test_what_cannot_be_met_is_shown_with_a_run_and_cannot_be_deployed(tmp_path: Path) -> None:
    done = last(
        tmp_path,
        bolts(station=("nutrunner.set_tool_idle and", "nutrunner.set_tool_idle and nutrunner.run_tool_forward and")),
    )
    assert done.analysis is not None
    assert done.analysis.supervised is False
    (finding,) = [each for each in done.findings if each.kind == "specification-cannot-be-met"]
    assert finding.said is not None
    assert finding.message == as_message(finding.said)
    hindrance = done.hindrance(done.number)
    assert hindrance is not None
    assert as_message(hindrance.why).id == "hindrance.no-supervisor.because"
    assert hindrance.slug == "no-supervisor"
    assert finding.message.rstrip(".") in hindrance.why
    assert "`rest`" in finding.message
    assert finding.trace is not None


def test_an_initial_state_that_is_forbidden_is_an_error_at_the_specification(tmp_path: Path) -> None:
    files = bolts()
    line = files["specifications.yaml"].count("\n") + 1
    files["specifications.yaml"] += "never_home:\n  title: Never home\n  forbidden: robot.pose == home\n"
    done = last(tmp_path, files)
    (finding,) = done.findings
    assert (finding.severity, finding.file, finding.line) == ("error", "specifications.yaml", line)
    assert finding.message.startswith("`never_home` forbids the initial state, in which robot.pose == home:")
    assert done.hindrance(done.number) is not None


def test_an_example_that_fails_is_an_error(tmp_path: Path) -> None:
    files = bolts()
    example = (
        "    every: 0.5\n    examples:\n      - name: idle\n"
        "        given: {set_tool_idle: true, run_tool_forward: false}\n"
        "        gives: {set_tool_idle: false}\n"
    )
    path = "resources/nutrunner.yaml"
    files[path] = files[path].replace("    every: 0.5\n", example)
    done = last(tmp_path, files)
    assert [each.severity for each in done.findings] == ["error"]
    assert done.findings[0].file == path


def test_an_empty_station_is_a_station(tmp_path: Path) -> None:
    done = last(tmp_path, {"station.yaml": "name: empty\n"})
    assert done.hindrance(done.number) is None
    assert [each.severity for each in done.findings if each.severity == "error"] == []


class Desk:
    """A desk, and what it tells."""

    def __init__(self) -> None:
        self.told: list[CheckView] = []
        self.process = DraftProcess()
        self.desk = CheckDesk(BOLT_TIGHTENING, StartNeeds(), self.process, self.told.append)

    async def until(self, what: Callable[[CheckView], bool]) -> CheckView:
        await until_async(lambda: bool(self.told) and what(self.told[-1]))
        return self.told[-1]


def run(scenario: Callable[[Desk], Awaitable[None]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))

    async def live() -> None:
        desk = Desk()
        try:
            await scenario(desk)
        finally:
            await desk.desk.close()
            desk.process.close()

    asyncio.run(live())
    assert list(tmp_path.glob("sequence-planner-*")) == []
    assert [each for each in children() if each.name == "checked"] == []


def test_only_the_newest_is_checked_to_its_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    async def scenario(desk: Desk) -> None:
        desk.desk.check(1, bolts())
        await desk.until(lambda view: view.state is CheckState.CHECKING)
        desk.desk.check(2, bolts(operations=("priority: 1", "priority: one")))
        desk.desk.check(3, bolts())
        done = await desk.until(lambda view: view.state is CheckState.DONE)
        assert (done.number, done.findings) == (3, [])
        numbers = [each.number for each in desk.told]
        assert numbers == sorted(numbers)
        assert not any(each.state is CheckState.DONE for each in desk.told[:-1])

    run(scenario, tmp_path, monkeypatch)


def test_a_check_whose_process_is_killed_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    async def scenario(desk: Desk) -> None:
        desk.desk.check(1, bolts())
        await desk.until(lambda view: view.state is CheckState.CHECKING)
        (process,) = [each for each in children() if each.name == "checked"]
        assert process.pid is not None
        os.kill(process.pid, signal.SIGKILL)
        failed = await desk.until(lambda view: view.state is CheckState.FAILED)
        assert "ended without an answer" in failed.doing
        assert failed.doing_message is not None
        assert failed.doing == as_message(failed.doing_message)
        hindrance = failed.hindrance(failed.number)
        assert hindrance is not None
        assert hindrance.slug == "not-checked"
        assert failed.doing in hindrance.why
        desk.desk.check(2, bolts())
        assert (await desk.until(lambda view: view.state is CheckState.DONE)).hindrance(2) is None

    run(scenario, tmp_path, monkeypatch)


def test_work_that_fails_is_not_waited_for() -> None:
    async def live() -> None:
        async with (
            asyncio.timeout(PATIENCE),
            working("comparing.comparison:compared", None, None, None) as found,
        ):
            with pytest.raises(WorkerError):
                await anext(found)

    asyncio.run(live())


def test_a_process_that_is_not_waited_for_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))

    async def live() -> None:
        for seconds in (0.0, 0.01, 0.3):
            process = DraftProcess()
            asked = asyncio.create_task(process.errors(bolts()))
            await asyncio.sleep(seconds)
            asked.cancel()
            with contextlib.suppress(asyncio.CancelledError):  # a quick machine has answered by then
                await asked
            process.close()
            assert [each for each in children() if each.name == "language_worker"] == []

    asyncio.run(live())
    assert list(tmp_path.glob("sequence-planner-*")) == []
