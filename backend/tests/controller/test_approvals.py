"""Dual approval: what a variable asks two people for is done by two, or not at all."""

from __future__ import annotations

import asyncio
import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeVar

import pytest
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)

from sequence_planner.automaton.automaton import Kind
from sequence_planner.controller.build import build_controller
from sequence_planner.controller.commands.approvals import (
    Act,
    ApproveRequest,
    CorrectionAct,
    DeclineRequest,
    ForceAct,
    ForceVariable,
    OutputsAct,
    ReleaseForce,
    RequestApproval,
)
from sequence_planner.controller.commands.command import Command, CommandRefused
from sequence_planner.controller.commands.execution import ReleaseControl, TakeControl, WithdrawControl
from sequence_planner.controller.commands.recovery import (
    ConfirmEstimates,
    CorrectEstimates,
    DecideOutputs,
    ExecuteOperatorPlan,
    UndoCorrection,
)
from sequence_planner.controller.controller import Controller
from sequence_planner.controller.features.approvals import PATIENCE, SHOWN, Approvals
from sequence_planner.controller.features.control_lock import ControlLock
from sequence_planner.controller.recovery.corrections import Corrections
from sequence_planner.controller.views.station import ApprovalState, ApprovalView
from sequence_planner.core.actor import SYSTEM, Actor, ActorKind
from sequence_planner.core.clock import Timestamp
from sequence_planner.ros.transports.memory import MemoryNetwork
from sequence_planner.station import prepare_station
from sequence_planner.synthesis.supervisor import synthesise
from support.cell import IDENTITY
from support.databases import journal
from support.examples import examples
from support.people import ADAM, EVA, person
from support.places import CELL

WHY = "seen with my own eyes"
DEMO = person("Demonstration", kind=ActorKind.DEMONSTRATION)
ANOTHER_EVA = person("Eva", session="another browser")
KEY = Actor(kind=ActorKind.KEY, id="k1", name="MES")
PART, OTHER, MOVING, GOTO = "parts[left]", "parts[right]", "arm.moving", "arm.goto"
FULL = CorrectionAct(values={PART: "full"})
Kept = TypeVar("Kept")
MOVES = ForceAct(name=MOVING, value=True, seconds=60)
DUAL = {
    "station.yaml": ("type: fill, initial: empty", "type: fill, initial: empty, approval: dual"),
    "resources/arm.yaml": ("moving: {type: bool,", "moving: {approval: dual, type: bool,"),
}


@pytest.fixture(scope="module")
def controller(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Controller]:
    """The controller of the cell, where parts and what moves ask for two people. It is given commands alone."""
    model = tmp_path_factory.mktemp("models") / "cell"
    shutil.copytree(CELL, model)
    for name, (before, after) in DUAL.items():
        text = (model / name).read_text(encoding="utf-8")
        assert before in text
        (model / name).write_text(text.replace(before, after), encoding="utf-8")
    station = prepare_station(model)
    supervisor = synthesise(station.automaton)

    async def made() -> Controller:
        transport = MemoryNetwork().join(station.registry, "sequence_planner", asyncio.get_running_loop())
        return build_controller(IDENTITY, station, supervisor, transport, database)

    with journal() as database:
        one = asyncio.run(made())
        yield one
        for close in one._parts.close:  # its life was never begun, which would end them
            close()


def feature(controller: Controller, kind: type[Kept]) -> Kept:
    return next(each for each in controller.viewing._features if isinstance(each, kind))


@dataclass
class Cell:
    """It, at a time that a test moves on."""

    controller: Controller
    now: float = 1000.0

    @property
    def moment(self) -> Timestamp:
        return Timestamp(self.now, self.now)

    @property
    def revision(self) -> int:
        return self.controller.execution.revision

    @property
    def approvals(self) -> dict[str, ApprovalView]:
        shown: Any = feature(self.controller, Approvals).view_part(self.moment)["approvals"]
        return dict(shown)

    def value(self, name: str) -> object:
        return self.controller.execution.state[name]

    def do(self, command: Command) -> None:
        self.controller._parts.commands.execute(command, self.moment)

    def refusal(self, command: Command) -> str:
        with pytest.raises(CommandRefused) as refused:
            self.do(command)
        return refused.value.slug

    def control(self, actor: Actor | None) -> None:
        """Let somebody be in control, or nobody."""
        held = feature(self.controller, ControlLock).holder
        if held is not None:
            self.do(WithdrawControl(actor=SYSTEM, session=held.session))
        if actor is not None:
            self.do(TakeControl(actor=actor))

    def ask(self, act: Act, actor: Actor = EVA) -> str:
        self.do(RequestApproval(actor=actor, act=act, revision=self.revision, reason=WHY))
        return list(self.approvals)[-1]

    def approve(self, request: str, act: Act, actor: Actor = ADAM) -> ApproveRequest:
        return ApproveRequest(actor=actor, request=request, act=act, revision=self.revision)

    def tick(self, pose: str) -> None:
        execution = self.controller.execution
        measured = {
            name: execution.automaton.initial_valuation[name] for name in execution.automaton.names(Kind.MEASURED)
        }
        execution.tick({**measured, "arm.pose": pose}, self.moment)

    def begin(self) -> None:
        """As in the beginning; nothing waits, and what waited is forgotten."""
        execution = self.controller.execution
        feature(self.controller, Approvals)._requests.clear()
        for name in list(execution.conduct.forces):
            execution.release(name)
        execution.correct({PART: "empty", OTHER: "empty"}, "test", "begins", self.moment)
        self.tick("home")
        self.control(EVA)


@pytest.fixture
def cell(controller: Controller) -> Cell:
    cell = Cell(controller)
    cell.begin()
    return cell


def test_two_people_correct_what_asks_for_two(cell: Cell) -> None:
    assert cell.controller.view().variables[PART].dual_approval
    request = cell.ask(FULL)
    assert cell.value(PART) == "empty"
    shown = cell.approvals[request]
    assert (shown.by, shown.state, shown.revision, shown.why) == ("Eva", ApprovalState.WAITING, cell.revision, WHY)
    assert shown.until == cell.now + PATIENCE
    cell.do(cell.approve(request, FULL))
    assert cell.value(PART) == "full"
    assert cell.approvals[request].state is ApprovalState.APPROVED
    assert cell.approvals[request].answered_by == "Adam"
    last = feature(cell.controller, Corrections).last
    assert last is not None
    assert (last.by, last.why) == ("Eva + Adam", WHY)
    cell.now += SHOWN
    assert cell.approvals == {}


def test_two_people_force_what_asks_for_two(cell: Cell) -> None:
    cell.do(cell.approve(cell.ask(MOVES), MOVES))
    [force] = cell.controller.execution.conduct.forces.values()
    assert (force.by, force.value, force.until.monotonic) == ("Eva + Adam", True, cell.now + 60)
    cell.do(ReleaseForce(actor=EVA, name=MOVING))
    assert not cell.controller.execution.conduct.forces


def direct(cell: Cell, actor: Actor) -> tuple[Command, ...]:
    """All by which one person could do it alone."""
    values: dict[str, bool | int | str] = {PART: "full"}
    return (
        CorrectEstimates(actor=actor, reason=WHY, values=values, revision=cell.revision),
        CorrectEstimates(actor=actor, reason=WHY, values={OTHER: "full", PART: "full"}, revision=cell.revision),
        DecideOutputs(actor=actor, reason=WHY, values=values),
        ForceVariable(actor=actor, reason=WHY, name=MOVING, value=True, seconds=60),
        ExecuteOperatorPlan(actor=actor, reason=WHY, offer="1", starts=[], corrections=values),
    )


@pytest.mark.parametrize("actor", [EVA, DEMO, SYSTEM], ids=lambda actor: actor.name)
def test_nobody_does_it_alone(cell: Cell, actor: Actor) -> None:
    cell.control(None if actor is SYSTEM else actor)
    for command in direct(cell, actor):
        assert cell.refusal(command) == "approval-needed"


def test_what_two_have_corrected_one_does_not_take_back(cell: Cell) -> None:
    revision = cell.revision
    cell.do(cell.approve(cell.ask(FULL), FULL))
    assert cell.refusal(UndoCorrection(actor=EVA, reason=WHY, revision=revision)) == "approval-needed"
    cell.do(ConfirmEstimates(actor=EVA, reason=WHY, values={PART: "full"}))
    assert cell.value(PART) == "full"


@pytest.mark.parametrize("actor", [EVA, ANOTHER_EVA, DEMO, KEY], ids=lambda actor: f"{actor.kind} {actor.session}")
def test_it_takes_a_second_person(cell: Cell, actor: Actor) -> None:
    request = cell.ask(FULL)
    slug = "same-person" if actor.id == EVA.id else "not-a-person"
    assert cell.refusal(cell.approve(request, FULL, actor)) == slug
    assert cell.value(PART) == "empty"
    assert cell.approvals[request].state is ApprovalState.WAITING


def test_a_demonstration_asks_nobody(cell: Cell) -> None:
    cell.control(DEMO)
    asking = RequestApproval(actor=DEMO, act=FULL, revision=cell.revision, reason=WHY)
    assert cell.refusal(asking) == "not-a-person"


def test_who_asks_is_in_control_and_stays_it(cell: Cell) -> None:
    asking = RequestApproval(actor=ADAM, act=FULL, revision=cell.revision, reason=WHY)
    assert cell.refusal(asking) == "control-needed"
    request = cell.ask(FULL)
    cell.do(ReleaseControl(actor=EVA))
    assert cell.refusal(cell.approve(request, FULL)) == "request-gone"
    assert cell.approvals[request].state is ApprovalState.OVERTAKEN


def test_it_holds_in_one_state_alone(cell: Cell) -> None:
    request, revision = cell.ask(FULL), cell.revision
    old = RequestApproval(actor=EVA, act=FULL, revision=revision - 1, reason=WHY)
    assert cell.refusal(old) == "stale-revision"
    cell.tick("out")
    assert cell.revision > revision
    assert cell.refusal(cell.approve(request, FULL)) == "request-gone"
    assert cell.value(PART) == "empty"


def test_who_approves_says_what_and_in_which_state(cell: Cell) -> None:
    request = cell.ask(FULL)
    for other in (CorrectionAct(values={PART: "empty"}), CorrectionAct(values={PART: "full", OTHER: "full"}), MOVES):
        assert cell.refusal(cell.approve(request, other)) == "not-confirmed"
    stale = cell.approve(request, FULL).model_copy(update={"revision": cell.revision - 1})
    assert cell.refusal(stale) == "stale-revision"
    assert cell.refusal(cell.approve("another", FULL)) == "request-gone"


def test_what_could_not_be_done_is_not_asked_for(cell: Cell) -> None:
    for act, slug in (
        (CorrectionAct(values={PART: "broken"}), "not-in-domain"),
        (CorrectionAct(values={"parts[none]": "full"}), "unknown-variable"),
        (CorrectionAct(values={MOVING: True}), "not-estimated"),
        (ForceAct(name=PART, value="full", seconds=1), "not-forceable"),
        (OutputsAct(values={GOTO: "home"}), "nothing-to-confirm"),
        (ForceAct(name="arm.pose", value="home", seconds=1), "no-approval-needed"),
    ):
        asking = RequestApproval(actor=EVA, act=act, revision=cell.revision, reason=WHY)
        assert cell.refusal(asking) == slug


def test_it_is_declined_or_withdrawn(cell: Cell) -> None:
    declined = cell.ask(FULL)
    cell.do(DeclineRequest(actor=ADAM, request=declined, act=FULL, reason="it is empty"))
    assert (cell.approvals[declined].state, cell.approvals[declined].answer) == ("declined", "it is empty")
    withdrawn = cell.ask(FULL)
    cell.do(DeclineRequest(actor=EVA, request=withdrawn, act=FULL))
    assert cell.approvals[withdrawn].state is ApprovalState.WITHDRAWN
    for request in (declined, withdrawn):
        assert cell.refusal(cell.approve(request, FULL)) == "request-gone"


ACTORS = (EVA, ANOTHER_EVA, ADAM, person("Ida"), DEMO)
ACTS: tuple[Act, ...] = (FULL, CorrectionAct(values={OTHER: "full"}), MOVES)


@dataclass
class Waits:
    """A request as the model knows it."""

    actor: Actor
    act: Act
    revision: int
    until: float


class FourEyes(RuleBasedStateMachine):
    """Whatever people do: something is done exactly when two of them have wanted it, in time and in one state."""

    def __init__(self, controller: Controller) -> None:
        super().__init__()
        self.cell = Cell(controller)
        self.cell.begin()
        self.holder: Actor = EVA
        self.waits: dict[str, Waits] = {}

    @rule(pause=st.sampled_from([1.0, 30.0, 119.0, 121.0]))
    def time_passes(self, pause: float) -> None:
        self.cell.now += pause

    @rule(actor=st.sampled_from(ACTORS))
    def somebody_takes_control(self, actor: Actor) -> None:
        self.cell.control(actor)
        self.holder = actor

    @rule(pose=st.sampled_from(["home", "out", "unknown"]))
    def the_device_moves(self, pose: str) -> None:
        self.cell.tick(pose)

    @rule(act=st.sampled_from(ACTS), actor=st.sampled_from(ACTORS))
    def somebody_asks(self, act: Act, actor: Actor) -> None:
        before = set(self.cell.approvals)
        try:
            self.cell.do(RequestApproval(actor=actor, act=act, revision=self.cell.revision, reason=WHY))
        except CommandRefused as refused:
            wrong = actor.session != self.holder.session or actor is DEMO
            assert wrong or refused.slug == "force-unsafe"
            return
        assert actor.session == self.holder.session
        assert actor is not DEMO
        self.waits = {id_: each for id_, each in self.waits.items() if each.actor.id != actor.id}
        [made] = set(self.cell.approvals) - before
        self.waits[made] = Waits(actor, act, self.cell.revision, self.cell.now + PATIENCE)

    @precondition(lambda self: self.waits)
    @rule(which=st.integers(0, 5), actor=st.sampled_from(ACTORS), act=st.sampled_from([None, *ACTS]))
    def somebody_approves(self, which: int, actor: Actor, act: Act | None) -> None:
        request = list(self.waits)[which % len(self.waits)]
        waits = self.waits[request]
        said = act or waits.act
        before = self.cell.controller.execution.state
        good = self._lives(waits) and said == waits.act and actor.id != waits.actor.id and actor is not DEMO
        try:
            self.cell.do(self.cell.approve(request, said, actor))
        except CommandRefused as refused:
            assert not good or refused.slug == "force-unsafe"
            assert self.cell.controller.execution.state == before
            return
        assert good
        del self.waits[request]
        if isinstance(said, CorrectionAct):
            assert all(self.cell.value(name) == value for name, value in said.values.items())

    @rule(actor=st.sampled_from(ACTORS))
    def somebody_tries_alone(self, actor: Actor) -> None:
        self.cell.control(actor)
        self.holder = actor
        for command in direct(self.cell, actor):
            assert self.cell.refusal(command) == "approval-needed"

    @invariant()
    def what_waits_is_what_two_people_can_still_want(self) -> None:
        self.waits = {id_: each for id_, each in self.waits.items() if self._lives(each)}
        waiting = {id_ for id_, each in self.cell.approvals.items() if each.state is ApprovalState.WAITING}
        assert waiting == set(self.waits)

    def _lives(self, waits: Waits) -> bool:
        in_state = waits.revision == self.cell.revision
        return self.cell.now < waits.until and in_state and waits.actor.session == self.holder.session


def test_four_eyes(controller: Controller) -> None:
    class Here(FourEyes):
        def __init__(self) -> None:
            super().__init__(controller)

    run_state_machine_as_test(Here, settings=examples(100))
