"""A deployment that fails to start gives way to the model before, to the byte, and never at the cost of a model."""

from __future__ import annotations

import asyncio
import os
import shutil
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import cast

import pytest

from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.execution import Deploy
from sequence_planner.controller.deployment_folder import (
    NAME,
    DeploymentFolder,
    DeploymentNote,
    undo_what_was_cut_off,
)
from sequence_planner.controller.preparation import Deploying, LastDeployment
from sequence_planner.controller.restore import RestoredState
from sequence_planner.controller.views.part import ControlView
from sequence_planner.model import files
from sequence_planner.model.exchange import exchanging
from sequence_planner.model.files import put_in_place, read_contents, read_files, write_files
from sequence_planner.process.parent_watch import DEPLOYED, OVERTAKEN
from sequence_planner.startup import deployment
from sequence_planner.startup.deployment import LONGEST_START, UnderWay
from sequence_planner.startup.station_process import Executed, StationProcess
from sequence_planner.texts.message import message
from support.people import EVA
from support.places import SINGLE_BOLT

NOTE = DeploymentNote(revision="1" * 40, name="Repaired", by="anna", time=1.0)


class Controller:
    """The launcher's view of a process: how it has ended, and what was done to it."""

    def __init__(self) -> None:
        self.ended: int | None = None
        self.done: list[str] = []

    def stop(self) -> None:
        self.done.append("stop")

    def spawn(self, *more: str) -> None:
        self.done.append("spawn")

    def said(self, code: int) -> str:
        return f"it ended with {code}"


class Now:
    def __init__(self) -> None:
        self.seconds = 1000.0

    def monotonic(self) -> float:
        return self.seconds


@pytest.fixture
def model(tmp_path: Path) -> Path:
    return Path(shutil.copytree(SINGLE_BOLT, tmp_path / "model"))


@pytest.fixture
def beside(tmp_path: Path) -> Path:
    made = tmp_path / "beside"
    made.mkdir()
    return made


@pytest.fixture
def now(monkeypatch: pytest.MonkeyPatch) -> Now:
    clock = Now()
    monkeypatch.setattr(deployment, "time", clock)
    return clock


def begun(model: Path, beside: Path, controller: Controller) -> UnderWay:
    """What watches over a deployment whose files are in place."""
    DeploymentFolder(beside).begin(NOTE, read_contents(model))
    put_in_place({**read_files(model), "station.yaml": "title: new\n"}, model)
    watch = UnderWay(model, beside, cast(StationProcess, controller), None)
    controller.ended = DEPLOYED
    watch.look()
    controller.ended = None
    return watch


def test_files_come_back_to_the_byte_and_with_their_modes_though_they_are_no_text(model: Path, beside: Path) -> None:
    latin = "# Förare\r\n".encode("latin-1")
    (model / "station.yaml").write_bytes(b"\xef\xbb\xbf" + (model / "station.yaml").read_bytes() + latin)
    name, *_ = sorted(path.name for path in (model / "resources").iterdir())
    crlf = b"\xef\xbb\xbf" + (model / "resources" / name).read_bytes().replace(b"\n", b"\r\n")
    (model / "resources" / name).write_bytes(crlf)
    (model / "station.yaml").chmod(0o640)
    (model / "resources" / name).chmod(0o600)
    before, folder = read_contents(model), DeploymentFolder(beside)
    folder.begin(NOTE, before)
    put_in_place({"station.yaml": "title: new\n", "resources/another.yaml": "title: another\n"}, model)
    assert read_contents(model) != before
    folder.bring_back(model, "why")
    assert read_contents(model) == before
    assert (model / "station.yaml").stat().st_mode & 0o777 == 0o640
    assert (model / "resources" / name).stat().st_mode & 0o777 == 0o600, "it was removed, and is as it was"
    note = folder.note()
    assert note is not None
    assert note.undone == "why"


@pytest.mark.parametrize("lost", ["", "note.json", "before", "before/station.yaml"])
def test_a_model_keeps_its_files_where_what_was_kept_has_vanished(model: Path, beside: Path, lost: str) -> None:
    folder = DeploymentFolder(beside)
    folder.begin(NOTE, read_contents(model))
    put_in_place({**read_files(model), "station.yaml": "title: new\n"}, model)
    there, gone = read_contents(model), beside / NAME / lost
    shutil.rmtree(gone) if gone.is_dir() else gone.unlink()
    with pytest.raises(FileNotFoundError):
        folder.bring_back(model, "why")
    assert read_contents(model) == there


def test_a_model_that_had_no_files_has_none_again(tmp_path: Path, beside: Path) -> None:
    empty, folder = tmp_path / "empty", DeploymentFolder(beside)
    empty.mkdir()
    folder.begin(NOTE, {})
    put_in_place({"station.yaml": "title: new\n"}, empty)
    folder.bring_back(empty, "why")
    assert read_contents(empty) == {}


def test_nothing_is_undone_once_the_folder_has_vanished(model: Path, beside: Path, now: Now) -> None:
    controller = Controller()
    watch, there = begun(model, beside, controller), read_contents(model)
    DeploymentFolder(beside).remove()
    watch.look()
    now.seconds += LONGEST_START + 1
    controller.ended = 1
    watch.look()
    assert (read_contents(model), controller.done) == (there, [])


def test_one_that_is_overtaken_while_it_starts_gets_all_the_time_again(model: Path, beside: Path, now: Now) -> None:
    controller = Controller()
    watch = begun(model, beside, controller)
    now.seconds += LONGEST_START + 1
    controller.ended = OVERTAKEN
    watch.look()
    controller.ended = None
    now.seconds += LONGEST_START - 1
    watch.look()
    assert controller.done == []
    now.seconds += 2
    watch.look()
    assert controller.done == ["stop", "spawn"]
    assert read_contents(model) == read_contents(SINGLE_BOLT)


def test_one_that_waits_as_somebody_else_commands_has_not_failed(model: Path, beside: Path, now: Now) -> None:
    controller = Controller()
    watch = begun(model, beside, controller)
    last = LastDeployment(beside / "socket")
    last.tell_that_it_waits(waits=True)
    for _ in range(5):
        now.seconds += LONGEST_START + 1
        watch.look()
    assert controller.done == []
    last.tell_that_it_waits(waits=False)
    now.seconds += LONGEST_START + 1
    watch.look()
    assert controller.done == ["stop", "spawn"], "it has all the time again, and no more"


def test_one_that_dies_while_it_waits_has_failed(model: Path, beside: Path, now: Now) -> None:
    controller = Controller()
    watch = begun(model, beside, controller)
    LastDeployment(beside / "socket").tell_that_it_waits(waits=True)
    controller.ended = 1
    watch.look()
    assert controller.done == ["stop", "spawn"]
    assert read_contents(model) == read_contents(SINGLE_BOLT)


def test_what_ends_between_two_looks_is_seen_by_who_watches_over_the_deployment_first(
    model: Path, beside: Path
) -> None:
    """A controller that makes room just after the launcher has looked at the deployment."""
    DeploymentFolder(beside).begin(NOTE, read_contents(model))
    program = f"import sys; sys.stdin.read(); raise SystemExit({DEPLOYED})"
    part = StationProcess("controller", Executed([sys.executable, "-c", program]))
    part.spawn()
    watch, first = UnderWay(model, beside, part, None), part.process
    assert first is not None
    part.look()
    watch.look()
    part.hang_up()
    first.wait()
    assert part.look_after() == 0
    assert (part.process, watch.was) == (first, False), "it is the next turn that sees it"
    part.look()
    watch.look()
    assert part.look_after() == 0
    assert watch.was
    assert part.process not in (None, first)
    part.stop()


def test_only_an_accepted_deployment_keeps_others_from_commanding(model: Path, beside: Path) -> None:
    command = Deploy(actor=EVA, reason="better", revision="1" * 40, name="Titled", staged=f"deploy-{'0' * 16}")

    async def scenario() -> None:
        deploying = Deploying(model, beside / "socket", emulated=True, dual=False)
        assert deploying.refusal() is None
        with pytest.raises(CommandRefused, match="Try once more to deploy"):
            await deploying.carry_out(command, None, 1.0)
        assert deploying.refusal() is None, "all is as it was"
        write_files({**read_files(model), "station.yaml": "title: new\n"}, beside / command.staged)
        await deploying.carry_out(command, None, 1.0)
        refusal = deploying.refusal()
        assert refusal is not None
        assert (refusal.slug, refusal.status) == ("deployment-under-way", 503)
        assert "Eva has deployed Titled" in refusal.detail

    asyncio.run(scenario())


def test_only_its_own_deployment_is_forgotten(beside: Path) -> None:
    folder = DeploymentFolder(beside)
    folder.begin(NOTE.model_copy(update={"undone": "why"}), {})
    last = LastDeployment(beside / "socket")
    folder.begin(NOTE.model_copy(update={"revision": "2" * 40}), {})
    last.forget()
    assert folder.exists, "a newer one has begun"
    folder.begin(NOTE.model_copy(update={"undone": "why"}), {})
    last.forget()
    assert not folder.exists


def test_who_has_stood_by_for_another_begins_with_what_that_one_has_done(beside: Path) -> None:
    control = ControlView(session="s", person="anna", name="Anna", since=1.0, taken_from=None)
    DeploymentFolder(beside).begin(NOTE.model_copy(update={"reset": True, "control": control}), {})
    last = LastDeployment(beside / "socket")
    last.tell_that_it_stands_by()
    assert DeploymentFolder(beside).runs
    left_out = (message("restored.repeats", name="polish"),)
    known = last.known(RestoredState(left_out=left_out))
    assert (known.left_out, known.control) == (left_out, None)


NEW = {"station.yaml": "title: new\n", "resources/another.yaml": "title: another\n"}


def killed(work: Callable[[], None], writes: int) -> None:
    """Let another process do this, which is killed, as by a power failure, once it has written so many files."""
    if (child := os.fork()) == 0:
        left, put = iter(range(writes)), files._put

        def put_or_die(path: Path, content: bytes, mode: int | None = None) -> None:
            if next(left, None) is None:
                patched.setattr(Path, "replace", lambda *_: os.kill(os.getpid(), signal.SIGKILL))
            put(path, content, mode)

        try:
            with pytest.MonkeyPatch.context() as patched:
                patched.setattr(files, "_put", put_or_die)
                work()
            os._exit(0)
        finally:
            os._exit(1)
    assert os.waitpid(child, 0)[1] in (0, signal.SIGKILL)


def deployed_and_killed(model: Path, beside: Path, writes: int) -> None:
    """A deployment whose process is killed so."""
    staged = f"deploy-{'0' * 16}"
    write_files({**read_files(model), **NEW}, beside / staged)
    command = Deploy(actor=EVA, reason="better", revision="1" * 40, name="New", staged=staged)
    deploying = Deploying(model, beside / "socket", emulated=True, dual=False)
    killed(lambda: asyncio.run(deploying.carry_out(command, None, 1.0)), writes)


@pytest.mark.parametrize("writes", [0, 1, 2])
def test_whoever_starts_after_a_cut_off_finds_the_model_whole(model: Path, beside: Path, writes: int) -> None:
    before = read_contents(model)
    deployed_and_killed(model, beside, writes)
    whole = writes == len(NEW)
    assert (read_contents(model) == before) is (writes == 0)
    undone = undo_what_was_cut_off(model)
    assert (undone is None) is whole
    if undone is not None:
        assert (undone.name, undone.undone) == ("New", "the station was ended before all of its files were in place")
        assert read_contents(model) == before
    assert undo_what_was_cut_off(model) is None, "once is enough"
    if not whole:
        assert sorted(each.name for each in model.rglob("*")) == sorted(each.name for each in SINGLE_BOLT.rglob("*"))


def test_a_model_that_is_half_brought_back_is_brought_back(model: Path, beside: Path) -> None:
    before, folder = read_contents(model), DeploymentFolder(beside)
    folder.begin(NOTE, before)
    put_in_place({**read_files(model), **NEW}, model)
    killed(lambda: folder.bring_back(model, "nobody knows it"), 0)
    undone = undo_what_was_cut_off(model)
    assert undone is not None
    assert undone.undone == "nobody knows it"
    assert read_contents(model) == before


def test_nobody_disturbs_who_exchanges_the_files_just_now(model: Path) -> None:
    before = read_contents(model)
    with exchanging(model, before, NOTE.model_dump_json()):
        put_in_place({**read_files(model), **NEW}, model)
        assert undo_what_was_cut_off(model) is None
    assert read_files(model)["station.yaml"] == NEW["station.yaml"]


@pytest.mark.parametrize("writes", [0, 1, 2])
def test_a_controller_that_dies_at_it_leaves_a_whole_model(model: Path, beside: Path, writes: int) -> None:
    before = read_contents(model)
    deployed_and_killed(model, beside, writes)
    controller = Controller()
    watch = UnderWay(model, beside, cast(StationProcess, controller), None)
    controller.ended = -signal.SIGKILL
    watch.look()
    assert controller.done == [], "it is started again as after any other end"
    last = LastDeployment(beside / "socket").view()
    assert last is not None
    if writes == len(NEW):
        assert (watch.was, last.state) == (True, "starting")
        controller.ended = 1
        watch.look()  # and what fails then is undone
        assert controller.done == ["stop", "spawn"]
        last = LastDeployment(beside / "socket").view()
    else:
        assert watch.was is False
    assert read_contents(model) == before
    assert last is not None
    assert last.state == "undone"


def test_a_controller_that_dies_before_it_has_begun_has_deployed_nothing(model: Path, beside: Path) -> None:
    DeploymentFolder(beside).begin(NOTE, read_contents(model))
    controller = Controller()
    watch = UnderWay(model, beside, cast(StationProcess, controller), None)
    controller.ended = -signal.SIGKILL
    watch.look()
    assert not DeploymentFolder(beside).exists
    assert LastDeployment(beside / "socket").refusal() is None
