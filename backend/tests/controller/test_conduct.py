"""Modes, steps, service, forces, time-outs and errands: what a person asks for, and what the station does then."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from sequence_planner.automaton.automaton import Automaton, Operation, Timeouts
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.core.clock import Timestamp
from sequence_planner.core.immutable import replace
from sequence_planner.execution.events import CalledOff, Heard, ModeChanged
from sequence_planner.execution.executor import Executor
from sequence_planner.execution.state import InitialState, OperatorPlan, OperatorPlanKind
from sequence_planner.execution.vocabulary import Mode, PlanStatus, ServiceKind
from sequence_planner.language.types import BOOLEAN, EnumerationType, Value
from sequence_planner.planning.planner import Planner
from sequence_planner.planning.problem import Contract, Goal, Plan, PlanRequest
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton, predicate_of

SAFE = Supervisor(StateSet((), ()), {})
PLACES = EnumerationType(("home", "aside", "work"))

# A cart goes to work, directly or by the way aside; a drill turns there and is called off by letting it stand.
CART = automaton(
    {
        "go": Does(
            start=("target := work",),
            enabled="at == target and at != work",
            executing="at != target",
            finish="at == target and target == work",
            timeouts=Timeouts(react=None, finish=5.0, retries=1, replan=True),
            cancel=("target := at",),
        ),
        "detour": Does(start=("target := aside",), enabled="at == target and at == home"),
        "onwards": Does(start=("target := work",), enabled="at == target and at == aside"),
        "home": Does(start=("target := home",), enabled="at == target and at != home"),
        "drill": Does(
            start=("drill := true",),
            enabled="not drill and at == work and target == work",
            executing="turns and not done",
            finish="drill and turns and at == work",
            finally_=("drill := false", "done := true"),
            cancel=("drill := false",),
        ),
        "rescue": Does(start=("target := home",), enabled="at != target", restart=True),
    },
    measured={"at": (PLACES, "home"), "turns": (BOOLEAN, False)},
    output={"target": (PLACES, "home"), "drill": (BOOLEAN, False)},
    estimated={"done": (BOOLEAN, False)},
    effects={
        "reaches_work": ("target == work and at != work", ("at := work",)),
        "steps_aside": ("target == aside and at != aside", ("at := aside",)),
        "comes_home": ("target == home and at != home", ("at := home",)),
        "spins": ("drill and not turns", ("turns := true",)),
        "stops": ("not drill and turns", ("turns := false",)),
    },
    goals={"make": "done"},
)


class Station:
    """The cart, told what to measure; `seconds` pass as they are told to."""

    def __init__(self, made: Automaton = CART, supervisor: Supervisor = SAFE) -> None:
        self.execution = Executor(made, supervisor)
        self.planner = Planner(made, supervisor)
        self.seconds = 0.0
        self.heard: list[Heard] = []
        self.execution.listeners.append(self.heard.append)
        self.measured: dict[str, Value | None] = {"at": "home", "turns": False}

    @property
    def now(self) -> Timestamp:
        return Timestamp(1000.0 + self.seconds, self.seconds)

    def tick(self, silent: frozenset[str] = frozenset(), **measured: Value | None) -> tuple[str, ...]:
        """The abilities that a tick starts, with a plan whenever one is asked for."""
        self.measured |= measured
        started = self.execution.tick(self.measured, self.now, silent=silent).started
        self.plan()
        return started

    def plan(self) -> None:
        request = self.execution.request(20)
        if request is not None:
            self.execution.adopt(request, self.planner.answer(request))

    def begin(self) -> None:
        self.execution.start_production()
        self.tick()

    def errand(self, goal: str, *, restart: bool = False, unsupervised: bool = False, **more: object) -> OperatorPlan:
        """A plan to `goal` from here, as a person would be shown it."""
        target = predicate_of(self.execution.automaton, goal)
        errand = OperatorPlan(OperatorPlanKind.GOAL, goal, Plan((), False, False), target, restart=restart, **more)  # type: ignore[arg-type]
        circumstances = replace(self.execution.circumstances, restart=restart)
        request = PlanRequest(
            dict(self.execution.state), (errand.pursued,), 20, contract=Contract.MINIMAL, circumstances=circumstances
        )
        planner = Planner(CART, SAFE) if unsupervised else self.planner
        plan = planner.answer(request).plan
        assert plan is not None
        return replace(errand, plan=plan, unsupervised=unsupervised, by="Eva")

    def take(self, goal: str, **more: bool) -> None:
        self.execution.start_operator_plan(self.errand(goal, **more), self.now)


@pytest.fixture
def station() -> Station:
    made = Station()
    made.begin()
    return made


def test_hold_calls_off_what_runs_and_pausing_lets_it_finish(station: Station) -> None:
    assert station.tick() == ("go",)
    assert station.tick(at="work") == ("drill",)
    station.execution.change_mode(Mode.PAUSED, "Eva", station.now)
    assert station.execution.state["drill"] is True
    station.execution.change_mode(Mode.HOLD, "Eva", station.now)
    assert station.execution.state["drill"] is False
    assert not station.execution.plan.order.running
    assert station.tick() == ()
    station.execution.change_mode(Mode.AUTOMATIC, "Eva", station.now)
    assert station.tick() + station.tick() == ("drill",), "it is planned anew"


def test_in_restart_mode_nothing_is_planned_or_started_for_operations(station: Station) -> None:
    station.execution.change_mode(Mode.RESTART, "Eva", station.now)
    assert station.execution.plan.status is PlanStatus.IDLE
    assert [station.tick() for _ in range(3)] == [(), (), ()]
    assert station.execution.request(5) is None
    assert station.execution.better(5) is None
    station.execution.change_mode(Mode.PAUSED, "Eva", station.now)
    station.plan()
    assert station.tick() == (), "it is paused now"
    station.execution.change_mode(Mode.AUTOMATIC, "Eva", station.now)
    assert station.tick() == ("go",)


def test_an_errand_is_carried_out_as_it_is_and_ends_with_its_goal(station: Station) -> None:
    execution = station.execution
    execution.change_mode(Mode.RESTART, "Eva", station.now)
    station.take("at == aside")
    assert station.tick() == ("detour",)
    assert execution.plan.status is PlanStatus.FOLLOWED
    assert station.tick(at="aside") == ()
    assert execution.operator_plan is None
    last = execution.conduct.last_operator_plan
    assert last is not None
    assert (last.done, last.title) == (True, "at == aside")
    assert execution.mode is Mode.RESTART, "to leave it is another act"
    execution.change_mode(Mode.PAUSED, "Eva", station.now)
    execution.change_mode(Mode.AUTOMATIC, "Eva", station.now)
    station.plan()
    assert station.tick() == ("go",) or execution.plan.order.names


def test_an_errand_ends_when_the_station_departs_from_it_and_is_never_made_anew(station: Station) -> None:
    execution = station.execution
    execution.change_mode(Mode.RESTART, "Eva", station.now)
    station.take("at == aside")
    execution.set_service(ServiceKind.ABILITY, "detour", False, "Adam", "the way aside is blocked", station.now)
    assert station.tick() == ()
    assert execution.operator_plan is None
    last = execution.conduct.last_operator_plan
    assert last is not None
    assert not last.done
    assert last.by is None, "the station itself"
    assert [station.tick() for _ in range(3)] == [(), (), ()]


def test_an_errand_waits_while_a_device_is_silent_and_goes_on(station: Station) -> None:
    station.execution.change_mode(Mode.RESTART, "Eva", station.now)
    station.take("at == aside")
    assert station.tick(at=None) == ()
    assert station.execution.operator_plan is not None
    assert station.tick(at="home") == ("detour",)


def test_restart_abilities_start_on_errands_in_restart_mode_only(station: Station) -> None:
    execution = station.execution
    assert station.tick() == ("go",)
    station.tick(at="aside")
    assert execution.startable("rescue") is None
    execution.change_mode(Mode.RESTART, "Eva", station.now)
    assert execution.startable("rescue") is None
    station.take("at == home and target == home", restart=True)
    assert execution.startable("rescue") is not None
    assert station.tick() == ("rescue",)
    station.tick(at="home")
    assert execution.startable("rescue") is None


def test_a_goal_by_hand_is_carried_out_in_paused_mode_and_ended_by_going_on(station: Station) -> None:
    execution = station.execution
    execution.change_mode(Mode.PAUSED, "Eva", station.now)
    station.take("at == aside")
    assert station.tick() == ("detour",)
    execution.change_mode(Mode.AUTOMATIC, "Eva", station.now)
    assert execution.operator_plan is None


def test_from_outside_the_safe_states_only_what_a_person_has_confirmed_is_started() -> None:
    made = replace(
        CART,
        specifications=automaton(
            {}, measured={"at": (PLACES, "home")}, forbidden={"not_aside": "at == aside"}
        ).specifications,
    )
    supervisor = synthesise(made)
    station = Station(made, supervisor)
    station.begin()
    station.execution.change_mode(Mode.RESTART, "Eva", station.now)
    station.execution.correct({}, "Eva", "nothing", station.now)
    station.tick(at="aside")
    station.execution.state = {**station.execution.state, "target": "aside"}
    station.tick()
    assert not station.execution.safe
    station.execution.start_operator_plan(
        replace(station.errand("at == home", unsupervised=True), unsupervised=False), station.now
    )
    assert station.tick() == ()
    station.take("at == home", unsupervised=True)
    assert station.tick() == ("home",)
    station.tick(at="home")
    assert station.execution.safe
    assert station.execution.startable("detour") is None, "from inside none leads out"


PRESS = automaton(
    {
        "free": Does(start=("let_go := true",), enabled="not let_go"),
        "push": Does(start=("press := true",), enabled="not press and let_go and ready"),
    },
    measured={"stuck": (BOOLEAN, False), "gate": (BOOLEAN, False), "ready": (BOOLEAN, False)},
    output={"press": (BOOLEAN, False), "let_go": (BOOLEAN, False)},
    effects={
        "loosens": ("let_go and stuck", ("stuck := false",)),
        "opens": ("not press and not gate", ("gate := true",)),
        "closes": ("not press and gate", ("gate := false",)),
        "gets_ready": ("not ready", ("ready := true",)),
    },
    forbidden={"jam": "stuck", "trapped": "press and gate"},
)


@pytest.mark.parametrize("stuck", [None, False])
@pytest.mark.parametrize(("gate", "starts"), [(True, ()), (False, ("push",))])
def test_from_the_first_safe_state_on_the_supervisor_has_its_say_again(
    stuck: bool | None, gate: bool, starts: tuple[str, ...]
) -> None:
    """Also where nobody can say any more whether the state is a safe one."""
    execution = Executor(PRESS, synthesise(PRESS))
    execution.start_production()
    now = Timestamp(1000.0, 0.0)
    measured: dict[str, Value | None] = {"stuck": True, "gate": False, "ready": False}
    execution.tick(measured, now)
    execution.change_mode(Mode.RESTART, "Eva", now)
    goal = predicate_of(PRESS, "press")
    plan = Planner(PRESS, SAFE).answer(PlanRequest(dict(execution.state), (Goal("errand", goal),), 20)).plan
    assert plan is not None
    errand = OperatorPlan(
        OperatorPlanKind.WAY_BACK, "free it", plan, goal, restart=True, unsupervised=True, by="Eva", taken=now
    )
    execution.start_operator_plan(errand, now)
    assert execution.tick(measured, now).started == ("free",)
    assert not execution.safe
    assert execution.tick({**measured, "stuck": False}, now).started == ()
    assert execution.safe
    outcome = execution.tick({"stuck": stuck, "gate": gate, "ready": True}, now)
    assert outcome.started == (starts if stuck is False else ())


def test_with_stepping_every_start_waits_for_a_step(station: Station) -> None:
    station.execution.set_stepping(True)
    assert [station.tick(), station.tick()] == [(), ()]
    station.execution.take_step()
    assert station.tick() == ("go",)
    assert station.tick(at="work") == ()
    station.execution.take_step()
    station.execution.take_step()
    assert station.tick() == ("drill",)
    assert station.execution.conduct.steps == 0, "steps are not saved up"
    station.execution.set_stepping(False)
    assert station.execution.conduct.may_start


def test_a_step_is_not_kept_for_another_mode(station: Station) -> None:
    execution = station.execution
    execution.set_stepping(True)
    execution.change_mode(Mode.PAUSED, "Eva", station.now)
    execution.take_step()
    execution.change_mode(Mode.AUTOMATIC, "Eva", station.now)
    assert [station.tick(), station.tick()] == [(), ()]


def test_an_ability_out_of_service_is_planned_without(station: Station) -> None:
    station.execution.set_service(ServiceKind.ABILITY, "go", False, "Eva", "it slips", station.now)
    assert station.execution.startable("go") is None
    station.execution.set_service(ServiceKind.ABILITY, "go", True, "Eva", "repaired", station.now)
    assert station.execution.startable("go") is not None
    station.execution.set_service(ServiceKind.ABILITY, "go", False, "Eva", "it slips again", station.now)
    assert station.tick() + station.tick() == ("detour",)


def test_a_resource_out_of_service_starts_nothing(station: Station) -> None:
    station.execution.set_service(ServiceKind.RESOURCE, "station", False, "Eva", "cleaning", station.now)
    assert [station.tick() for _ in range(3)] == [(), (), ()]
    assert station.execution.circumstances.offline == {"station"}


def test_an_operation_out_of_service_is_not_active(station: Station) -> None:
    execution = station.execution
    assert execution.active == {"make"}
    execution.set_service(ServiceKind.OPERATION, "make", False, "Eva", "no orders", station.now)
    assert station.tick() == ()
    assert execution.active == frozenset()
    assert execution.plan.status is PlanStatus.IDLE
    execution.set_service(ServiceKind.OPERATION, "make", True, "Eva", "orders", station.now)
    station.tick()
    assert execution.active == {"make"}


def once(made: Automaton) -> Automaton:
    operation: Operation = made.operations["make"]
    return replace(made, operations={"make": replace(operation, repeat=False)})


def test_an_operation_that_does_not_repeat_waits_to_be_reset() -> None:
    station = Station(once(CART))
    station.begin()
    execution = station.execution
    execution.correct({"done": True}, "Eva", "seen", station.now)
    station.tick()
    execution.correct({"done": False}, "Eva", "a new part", station.now)
    station.tick()
    assert execution.active == frozenset()
    assert execution.conduct.done == {"make"}
    execution.change_mode(Mode.RESTART, "Eva", station.now)
    execution.start_operator_plan(replace(station.errand("true"), operation="make"), station.now)
    station.tick()
    station.tick()
    assert execution.active == {"make"}


def test_what_is_overdue_is_called_off_tried_again_and_given_up_and_the_work_goes_another_way(
    station: Station,
) -> None:
    execution = station.execution
    assert station.tick() == ("go",)
    station.seconds = 6.0
    assert execution.is_due(station.now)
    assert station.tick() == ()
    assert execution.state["target"] == "home", "its cancel actions were taken"
    assert station.tick() == ("go",), "it is tried again"
    station.seconds = 12.0
    outcome = execution.tick(station.measured, station.now)
    assert (outcome.called_off, outcome.given_up) == (("go",), ("go",))
    given_up = execution.conduct.service[ServiceKind.ABILITY, "go"]
    assert given_up.by is None
    assert "5 s" in given_up.why
    station.plan()
    assert station.tick() == ("detour",)


def test_calling_off_what_is_overdue_leaves_a_forced_output_as_it_is(station: Station) -> None:
    execution = station.execution
    assert station.tick() == ("go",)
    execution.force("target", "aside", Timestamp(1060.0, 60.0), "Eva", "out of the way")
    station.seconds = 6.0
    outcome = execution.tick(station.measured, station.now)
    assert outcome.called_off == ("go",)
    assert execution.state["target"] == "aside", "whatever an ability says"
    execution.release("target")
    assert execution.state["target"] == "home", "and then it is not sent there again"


def test_a_measured_variable_is_forced_for_a_time(station: Station) -> None:
    execution = station.execution
    execution.force("at", "work", Timestamp(1010.0, 10.0), "Eva", "the sensor is dirty")
    assert station.tick() == ()
    assert execution.state["at"] == "work"
    assert execution.conduct.forces["at"].real == "home"
    station.seconds = 10.0
    assert execution.is_due(station.now)
    station.tick()
    assert execution.state["at"] == "home"
    assert not execution.conduct.forces


def test_a_forced_output_stays_and_what_would_change_it_does_not_start(station: Station) -> None:
    execution = station.execution
    execution.force("target", "home", Timestamp(1010.0, 10.0), "Eva", "somebody stands there")
    assert "go" in execution.circumstances.barred
    assert [station.tick() for _ in range(3)] == [(), (), ()]
    execution.release("target")
    assert station.tick() + station.tick() == ("go",)


def test_what_an_ability_writes_to_a_forced_output_is_what_it_would_be(station: Station) -> None:
    execution = station.execution
    station.tick()
    station.tick(at="work")
    execution.force("drill", True, Timestamp(1010.0, 10.0), "Eva", "the drill is looked at")
    station.tick(turns=True)
    assert execution.state["done"] is True
    assert execution.state["drill"] is True
    execution.release("drill")
    assert execution.state["drill"] is False


def test_holding_ends_forces(station: Station) -> None:
    station.execution.force("drill", True, Timestamp(1010.0, 10.0), "Eva", "a look")
    station.execution.change_mode(Mode.HOLD, "Adam", station.now)
    assert not station.execution.conduct.forces
    assert station.execution.state["drill"] is False


@pytest.mark.parametrize("cancel", [True, False])
def test_holding_sets_nothing_in_motion_that_a_force_has_kept_still(cancel: bool) -> None:
    """Somebody has forced the cart to stand, and it must not drive off because somebody else presses Hold."""
    go = CART.abilities["go"]
    station = Station(
        replace(CART, abilities={**CART.abilities, "go": go if cancel else replace(go, cancel_actions=())})
    )
    station.begin()
    execution = station.execution
    assert station.tick() == ("go",)
    execution.force("target", "home", Timestamp(1010.0, 10.0), "Eva", "somebody stands there")
    station.tick()
    execution.change_mode(Mode.HOLD, "Adam", station.now)
    assert execution.state["target"] == "home"
    assert not execution.conduct.forces
    station.tick()
    assert execution.state["target"] == "home"


def test_holding_in_restart_mode_calls_off_and_stays_there(station: Station) -> None:
    station.tick()
    station.tick(at="work")
    station.execution.change_mode(Mode.RESTART, "Eva", station.now)
    station.execution.call_off("Adam", station.now)
    assert station.execution.mode is Mode.RESTART
    assert station.execution.state["drill"] is False
    assert isinstance(station.heard[-1].happening, CalledOff)
    assert station.heard[-1].called_off == ("drill",), "who reads the journal is told what does not go on"


def test_what_came_back_is_where_it_begins() -> None:
    values: Mapping[str, Value] = {"done": True, "target": "work"}
    beginning = InitialState(values, 990.0, (), frozenset(), Timestamp(1000.0, 0.0))
    execution = Executor(CART, SAFE, beginning)
    assert (execution.state["done"], execution.state["target"]) == (True, "work")
    assert execution.state["at"] is None
    assert execution.conduct.returned == {"target", "drill"} & values.keys()
    execution.correct({"target": "home"}, "Eva", "it stands there", Timestamp(1001.0, 1.0))
    assert not execution.conduct.returned


def test_each_happening_is_told_and_counts_the_revision_up(station: Station) -> None:
    execution = station.execution
    revision = execution.revision
    execution.change_mode(Mode.PAUSED, "Eva", station.now)
    assert isinstance(station.heard[-1].happening, ModeChanged)
    assert execution.revision > revision
    station.tick()
    revision = execution.revision
    for _ in range(3):
        station.tick()
    assert execution.revision == revision, "ticks that change nothing are no news"
    station.tick(turns=True)
    assert execution.revision > revision
