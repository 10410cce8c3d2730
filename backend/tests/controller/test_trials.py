"""An ability tried alone: what it takes, what is refused, how it ends, and what is told of it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import pytest

from controller.carrying_out import carry_out
from sequence_planner.automaton.automaton import Operation, Timeouts
from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.commands.queries import AskDefinition
from sequence_planner.controller.commands.recovery import TryAbility
from sequence_planner.controller.features.variables import Beliefs
from sequence_planner.controller.recovery.explain import ConditionContext
from sequence_planner.controller.recovery.trials import Trials
from sequence_planner.controller.views.details import AbilityDefinitionView, TrialView
from sequence_planner.controller.views.execution import last_operator_plan_view, operator_plan_view
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.record.codec import Codec
from sequence_planner.execution.record.recorder import Memory, RunRecorder, model_digest
from sequence_planner.execution.record.replay import Player
from sequence_planner.execution.state import OperatorPlanKind
from sequence_planner.execution.vocabulary import Mode, ServiceKind
from sequence_planner.journal.run_journal import RunRecord
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.synthesis.guards import SupervisorGuard, shown_guards
from sequence_planner.synthesis.supervisor import supervised, supervisor
from support.automata import Does, automaton, predicate_of
from support.people import EVA

PLACES = EnumerationType(("up", "between", "down"))
LATE = Timeouts(react=1.0, finish=5.0)


class Press:
    """A press that must not be down, nor be told to, while its door is open. Its ram passes through between."""

    def __init__(self, cancel: tuple[str, ...] = ("ram := up",)) -> None:
        made = automaton(
            {
                "press": Does(
                    ("ram := down",),
                    "ram == up and at == up and not jammed",
                    executing="ram == down and at != down",
                    finish="ram == down and at == down",
                    cancel=cancel,
                    timeouts=LATE,
                ),
                "lift": Does(("ram := up",), "ram == down and at == down", executing="at != up", finish="at == up"),
                "open": Does(("door := true",), "not door"),
                "free": Does(("jammed := false",), "jammed", restart=True),
            },
            measured={"at": (PLACES, "up")},
            output={"ram": (PLACES, "up"), "door": (BOOLEAN, False)},
            estimated={"jammed": (BOOLEAN, False)},
            effects={
                "press.leaves": ("ram != at and at != between", ("at := between",)),
                "press.arrives": ("ram != at and at == between", ("at := ram",)),
                "press.jams": ("at == between", ("at := up",)),
            },
            faults=("press.jams",),
            forbidden={"shut": "door and (ram == down or at != up)"},
        )
        rests = Operation("rest", "Rest", predicate_of(made, "door"), predicate_of(made, "not door"))
        reactions = {"press": ("press.leaves", "press.arrives", "press.jams")}
        self.station = replace(made, reactions=reactions, operations={"rest": rests})
        supervision = supervised(self.station)
        self.supervisor = supervisor(supervision)
        self.guards: Mapping[str, SupervisorGuard] = shown_guards(supervision)
        self.seconds = 0.0
        self.at: Value = "up"
        self.execution = Executor(self.station, self.supervisor)
        self.records: list[RunRecord] = []
        RunRecorder(self.execution, self._write, model_digest(self.station), None, lambda: self.now.epoch, 50)
        around = ConditionContext(
            {"at": "/press/state"}, lambda name: 7.0, Beliefs(self.execution), lambda: self.guards
        )
        self.real: list[str] = []
        self.trials = Trials(self.execution, around, self._real)

    def _real(self) -> Sequence[str]:
        return self.real

    def _write(self, kind: str, time: float, content: str) -> int:
        self.records.append(RunRecord(len(self.records) + 1, time, kind, content, ""))
        return len(self.records)

    def called_off(self) -> list[tuple[str, list[str]]]:
        """What the journal says was called off, each with the kind of its record."""
        told = [(each.kind, json.loads(each.content).get("called_off")) for each in self.records]
        return [(kind, names) for kind, names in told if names]

    @property
    def now(self) -> Timestamp:
        return Timestamp(1000.0 + self.seconds, self.seconds)

    def tick(self, at: Value | None = None, seconds: float = 0.1, obstacles: tuple[str, ...] = ()) -> tuple[str, ...]:
        """The abilities that a tick starts."""
        self.seconds += seconds
        self.at = at or self.at
        return self.execution.tick({"at": self.at}, self.now, obstacles).started

    def enter(self, mode: Mode) -> None:
        self.execution.change_mode(mode, "Eva", self.now)

    def attempt(self, ability: str = "press", *, real: bool = False) -> None:
        command = TryAbility(actor=EVA, ability=ability, real_devices=real, reason="to see it")
        carry_out(self.trials, command, self.now)

    def refused(self, slug: str, ability: str = "press") -> str:
        """What is said; nothing has changed then."""
        conduct = self.execution.conduct
        with pytest.raises(CommandRefused) as found:
            self.attempt(ability)
        assert found.value.slug == slug
        assert self.execution.conduct == conduct
        return found.value.detail

    def definition(self, name: str = "press") -> AbilityDefinitionView:
        return self.trials.definition(AskDefinition(ability=name))

    def trial(self) -> TrialView:
        trial = self.definition().trial
        assert trial is not None
        return trial


def paused(press: Press) -> Press:
    """The press, paused, with production started."""
    press.tick()
    press.enter(Mode.PAUSED)
    press.execution.start_production()
    press.tick()
    return press


@pytest.fixture
def press() -> Press:
    return paused(Press())


def test_it_runs_once_and_is_done_when_it_has_finished(press: Press) -> None:
    press.attempt()
    execution = press.execution
    assert execution.operator_plan is not None
    assert (execution.operator_plan.kind, execution.operator_plan.by) == (OperatorPlanKind.TRIAL, "Eva")
    shown = operator_plan_view(execution)
    assert shown is not None
    assert (shown.ability, shown.title, shown.ends) == ("press", "Try: press", "ram == down and at == down")
    assert press.tick() == ("press",)
    assert press.tick("between") == ()
    assert execution.operator_plan is not None
    assert press.tick("down") == ()
    assert execution.operator_plan is None
    ended = last_operator_plan_view(execution.conduct)
    assert ended is not None
    assert (ended.done, ended.why, ended.ability) == (True, "", "press")
    assert execution.mode is Mode.PAUSED
    assert press.tick() == ()


def test_an_ability_that_is_done_at_its_start_ends_with_it(press: Press) -> None:
    press.attempt("open")
    assert press.tick() == ("open",)
    assert press.execution.operator_plan is None
    assert press.definition("open").trial is not None


def test_it_takes_the_paused_mode_and_production(press: Press) -> None:
    press.enter(Mode.AUTOMATIC)
    assert "automatic" in press.refused("wrong-mode")
    press.enter(Mode.RESTART)
    press.refused("wrong-mode")
    press.enter(Mode.HOLD)
    press.refused("wrong-mode")
    fresh = Press()
    fresh.tick()
    fresh.enter(Mode.PAUSED)
    assert "start production" in fresh.refused("production-not-started")
    fresh.execution.start_production()
    fresh.attempt()
    assert fresh.tick() == ("press",)


def test_what_its_guard_lacks_is_said(press: Press) -> None:
    press.tick("down")
    assert press.refused("not-startable") == "“press” waits for at == up."
    assert press.definition().obstacle == "“press” waits for at == up."
    assert press.refused("unknown-ability", "pres").startswith("The station has no ability `pres`")


def test_the_supervisor_is_asked_as_ever(press: Press) -> None:
    press.attempt("open")
    press.tick()
    detail = press.refused("not-startable")
    assert detail == "“press” waits for not door, because of: shut."
    assert press.definition().allowed is False
    assert press.definition("open").allowed is True


def test_restart_abilities_steps_and_service_are_no_exception(press: Press) -> None:
    press.execution.correct({"jammed": True}, "Eva", "seen", press.now)
    press.tick()
    assert "restart mode" in press.refused("not-startable", "free")
    press.execution.set_stepping(True)
    assert "a step" in press.refused("not-startable", "open")
    press.execution.take_step()
    press.attempt("open")
    assert press.tick() == ("open",)
    press.execution.set_stepping(False)
    press.execution.correct({"jammed": False}, "Eva", "seen", press.now)
    press.execution.set_service(ServiceKind.ABILITY, "press", False, "Eva", "worn", press.now)
    assert "back in service" in press.refused("not-startable")


def test_one_thing_is_carried_out_at_a_time(press: Press) -> None:
    press.attempt()
    assert press.refused("plan-running", "open") == "Try: press is being carried out. Wait for its end, or stop it."


def test_real_devices_have_to_be_confirmed(press: Press) -> None:
    press.real.append("/press/state is published by /plc")
    assert "/plc" in press.refused("real-devices")
    assert press.definition().real_devices == press.real
    press.attempt(real=True)
    assert press.tick() == ("press",)


def test_what_cannot_start_at_once_does_not_start_later(press: Press) -> None:
    press.attempt()
    assert press.tick("down") == ()
    assert press.execution.operator_plan is None
    ended = press.execution.conduct.last_operator_plan
    assert ended is not None
    assert (ended.done, ended.why, ended.by) == (False, "press could not start any more", None)
    assert press.tick("up") == ()
    press.attempt()
    assert press.tick(obstacles=("the network",)) == ()
    assert press.execution.operator_plan is None


def test_an_overdue_run_is_called_off(press: Press) -> None:
    press.attempt()
    press.tick()
    press.tick("between")
    press.tick(seconds=4)
    assert press.execution.operator_plan is not None
    press.seconds += 2
    assert press.execution.is_due(press.now)
    press.tick()
    assert (press.trial().done, press.trial().why) == (False, "press has not finished within 5 s")
    assert press.execution.state["ram"] == "up"
    assert not press.execution.plan.order.running
    assert not press.execution.conduct.service
    assert not press.execution.is_due(press.now)
    assert press.called_off() == [("ticked", ["press"])]


def test_stopping_it_calls_it_off_where_it_says_how(press: Press) -> None:
    press.attempt()
    press.tick()
    press.execution.stop_operator_plan("Adam", press.now)
    assert press.execution.state["ram"] == "up"
    assert press.execution.operator_plan is None
    assert press.trial().why == "Adam stopped it"
    assert press.tick() == ()
    assert press.execution.published["ram"] == "up"
    assert press.called_off() == [("errand-stopped", ["press"])]


def test_without_cancel_actions_it_goes_on_to_its_end() -> None:
    press = paused(Press(cancel=()))
    press.attempt()
    press.tick()
    press.execution.stop_operator_plan("Adam", press.now)
    assert press.execution.state["ram"] == "down"
    assert [step.ability for step in press.execution.plan.order.running] == ["press"]
    press.tick("between")
    press.tick("down")
    assert not press.execution.plan.order.running


def test_it_is_told_when_what_came(press: Press) -> None:
    assert press.definition().trial is None
    press.attempt()
    press.tick()
    press.tick("between")
    press.tick("down")
    trial = press.trial()
    times = (trial.accepted, trial.started, trial.executing, trial.ended)
    assert times == pytest.approx((1000.2, 1000.3, 1000.3, 1000.5))
    reactions = {each.name: (each.due, each.came) for each in trial.reactions}
    assert reactions["press.leaves"] == pytest.approx((1000.3, 1000.4))
    assert reactions["press.arrives"] == pytest.approx((1000.4, 1000.5))
    assert reactions["press.jams"][1] is None
    assert press.definition("lift").trial is None
    press.attempt("lift")
    assert press.definition().trial is None


def test_a_definition_says_what_of_it_holds(press: Press) -> None:
    view = press.definition()
    assert [(part.text, part.holds) for part in view.enabled.parts] == [
        ("ram == up", True),
        ("at == up", True),
        ("not jammed", True),
    ]
    assert (view.start.text, view.start.holds, view.start.parts) == ("true", True, [])
    assert (view.finished.text, view.finished.holds, view.finished.parts) == ("false", False, [])
    assert [(each.text, each.done) for each in view.start_actions] == [("ram := down", False)]
    assert view.finish is not None
    assert [part.holds for part in view.finish.parts] == [False, False]
    assert view.supervised is not None
    assert view.supervised.guard is not None
    assert (view.supervised.guard.text, view.supervised.specifications[0].name) == ("not door", "shut")
    assert (view.timeouts.react, view.timeouts.finish, view.timeouts.replan) == (1.0, 5.0, False)
    assert [(each.name, each.fault) for each in view.reactions] == [
        ("press.leaves", False),
        ("press.arrives", False),
        ("press.jams", True),
    ]
    assert view.obstacle is None
    assert press.definition("open").finish is None
    (door,) = press.definition("open").enabled.parts
    assert [(each.name, each.kind, each.value) for each in door.reads] == [("door", "output", False)]
    with pytest.raises(CommandRefused):
        press.definition("close")


def test_trials_are_replayed_bit_for_bit(press: Press) -> None:
    press.attempt()
    press.tick()
    press.execution.stop_operator_plan("Adam", press.now)
    press.tick("between")
    press.tick("up")
    press.attempt()
    press.tick()
    press.tick("between", seconds=9)
    press.tick()
    player = Player(press.station, press.supervisor)
    for record in press.records:
        assert player.play(record) is None
    again = player.execution
    memory = Memory(press.station, Codec(press.station))
    assert json.dumps(memory.document(again)) == json.dumps(memory.document(press.execution))
