"""A station led through a draft step by step: the reference tick, what can happen next, and plans that are followed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from editor.models import bolts
from planning.advice.rules import station
from sequence_planner.automaton.automaton import Kind
from sequence_planner.automaton.tick import initial_state
from sequence_planner.editor.schemas.draft import ChoiceKind, StepsView, StepView
from sequence_planner.editor.stepping.stepper import StepError, StepMoment, Stepper, StopReason, TickStep, steps_of
from sequence_planner.editor.stepping.worker import answering
from sequence_planner.language.types import BOOLEAN, Value
from sequence_planner.model.paths import EditError
from sequence_planner.planning.planner import Planner, PlannerError
from sequence_planner.planning.problem import PlanAnswer, PlanRequest, Verdict
from sequence_planner.process.budget import Budget
from sequence_planner.synthesis.supervisor import synthesise
from support.automata import Does, automaton
from support.places import BOLT_TIGHTENING

PLACED: dict[str, Value | None] = {f"bolts[bolt_pair_{number}]": "placed" for number in (1, 2, 3)}
NAME = "bolt_tightening"


class Asking:
    """The process that a page asks."""

    def __init__(self, folder: Path) -> None:
        self._answer: Any = answering(folder)
        self._files: dict[str, str] = {}

    def __call__(
        self,
        *steps: StepView,
        files: dict[str, str] | None = None,
        follow: bool = False,
        until: str | None = None,
    ) -> StepsView:
        files = files or bolts()
        changed = {path: text for path, text in files.items() if self._files.get(path) != text}
        self._files = files
        question = (changed, "stepped", (7, BOLT_TIGHTENING, PLACED, list(steps), follow, until))
        return StepsView.model_validate_json(self._answer(question, None))


@pytest.fixture
def asked(tmp_path: Path) -> Asking:
    return Asking(tmp_path)


def test_a_start_is_taken_its_device_reacts_and_it_ends_by_itself(asked: Asking) -> None:
    begun = asked()
    assert (begun.number, begun.obstacle, begun.refused) == (7, None, None)
    assert begun.plan is not None
    assert begun.plan.starts[0].ability
    first = next(each for each in begun.choices if each.kind is ChoiceKind.START)
    assert first.planned
    started = asked(first.step)
    assert len(started.moments) == 2
    ability = first.step.starts[0]
    assert started.moments[1].changes, "what it commands"
    reaction = next(
        each for each in started.choices if each.kind is ChoiceKind.DEVICE and each.resource == first.resource
    )
    over = asked(first.step, reaction.step)
    assert ability in over.moments[-1].running, "now that the device moves"
    assert over.moments[-1].seconds >= started.moments[-1].seconds


def test_what_cannot_happen_is_refused_by_its_place_and_the_steps_before_stay(asked: Asking) -> None:
    first = next(each.step for each in asked().choices if each.kind is ChoiceKind.START)
    nonsense = StepView(starts=["robot.flies"])
    view = asked(first, nonsense, first)
    assert view.refused is not None
    assert (view.refused.index, len(view.moments)) == (1, 2)
    assert str(view.refused.why) == "there is no ability robot.flies"
    twice = asked(first, first)
    assert twice.refused is not None
    assert "may not start here" in str(twice.refused.why)


@pytest.mark.parametrize(
    ("sets", "why"),
    [
        ({"robot.wings": True}, "there is no variable robot.wings"),
        ({"robot.target_pose": "home"}, "written by the station itself"),
        ({"robot.pose": "moon"}, "no value of robot.pose"),
        ({"bolts[bolt_pair_1]": None}, "not measured"),
    ],
)
def test_what_cannot_be_set_is_refused_with_why(asked: Asking, sets: dict[str, Value | None], why: str) -> None:
    view = asked(StepView(sets=sets))
    assert view.refused is not None
    assert why in str(view.refused.why)


def test_a_plan_is_followed_until_a_condition_holds(asked: Asking) -> None:
    until = "bolts[bolt_pair_1] == tightened"
    view = asked(follow=True, until=until)
    assert view.stopped == "until"
    last = view.moments[-1]
    assert any(change.name == "bolts[bolt_pair_1]" and change.after == "tightened" for change in last.changes)
    again = asked(follow=True)
    assert again.stopped == "done"
    assert any(moment.completed for moment in again.moments)
    with pytest.raises(EditError) as refused:
        asked(follow=True, until="bolts[bolt_pair_1] == tigtened")
    assert "tigtened" in str(refused.value)


def test_the_steps_that_come_back_can_be_asked_for_again(asked: Asking) -> None:
    """So a page goes on from any of them, in a branch of its own."""
    followed = asked(follow=True)
    steps = [moment.step for moment in followed.moments[1:]]
    again = asked(*steps)
    assert again.refused is None
    assert again.moments == followed.moments


def test_somebody_brings_the_station_outside_its_safe_states(asked: Asking) -> None:
    view = asked(StepView(sets={"robot.pose": "bolt_pair_1"}))
    assert view.refused is None
    assert not view.moments[-1].safe
    assert view.moments[-1].violated
    assert not [each for each in view.choices if each.kind is ChoiceKind.START], "nothing starts from there"


def test_a_draft_that_cannot_be_used_says_why_and_is_used_once_it_can(asked: Asking) -> None:
    view = asked(files=bolts(operations=("priority: 1", "priority: one")))
    assert view.obstacle is not None
    assert "operations.yaml" in str(view.obstacle)
    assert asked().obstacle is None


@given(st.data())
def test_only_what_the_reference_tick_allows_is_offered_and_all_of_it_can_be_taken(data: st.DataObject) -> None:
    made = station(NAME)
    stepper = Stepper(made.automaton, made.supervisor)
    moment = stepper.first_moment(initial_state(made.automaton))
    for _ in range(data.draw(st.integers(0, 12))):
        effects = [TickStep(effects=(effect.name,)) for effect, _ in stepper.possible_effects(moment.state)]
        starts = [TickStep(starts=(ability.name,)) for ability in stepper.possible_starts(moment.state)]
        kept = {ability.name for ability, _ in stepper.kept_back(moment.state)}
        assert kept.isdisjoint(name for step in starts for name in step.starts)
        for name in sorted(kept)[:3]:
            with pytest.raises(StepError):
                stepper.step_on(moment, TickStep(starts=(name,)))
        if not effects + starts:
            return
        safe = made.supervisor.safe.includes(moment.state)
        step = data.draw(st.sampled_from(effects + starts))
        moment = stepper.come_to_rest(stepper.step_on(moment, step))
        assert not safe or made.supervisor.safe.includes(moment.state), "what is expected does not lead out"


def test_a_plan_that_is_followed_reaches_its_goals() -> None:
    made = station(NAME)
    stepper = Stepper(made.automaton, made.supervisor)
    moment = stepper.first_moment(initial_state(made.automaton))
    answer = stepper.ask_plan(moment)
    assert answer is not None
    assert answer.plan is not None
    followed, _ = stepper.follow(moment, None, Budget.seconds(20.0))
    assert [each.step for each in followed] == list(steps_of(answer.plan))
    assert {name for each in followed for name in each.completed} >= moment.active - set(answer.left_out)


def test_each_value_that_is_offered_can_be_set_and_nothing_else_is_offered(asked: Asking) -> None:
    settable = asked().settable
    kinds = {name: variable.kind for name, variable in station(NAME).automaton.variables.items()}
    assert settable.keys() == {name for name, kind in kinds.items() if kind in (Kind.MEASURED, Kind.ESTIMATED)}
    for name, each in settable.items():
        assert each.unknown is (kinds[name] is Kind.MEASURED)
        for value in (each.domain[0], each.domain[-1], *([None] if each.unknown else [])):
            view = asked(StepView(sets={name: value}))
            assert view.refused is None
            assert len(view.moments) == 2


BLINKING = automaton(
    {
        "light": Does(start=("lit := true",), finish="not lit", finally_=("lit := true",)),
        "darken": Does(start=("lit := false",), finish="lit", finally_=("lit := false",)),
    },
    measured={},
    output={},
    estimated={"lit": (BOOLEAN, False)},
    effects={},
    goals={},
)


def test_a_station_that_never_rests_says_so() -> None:
    stepper = Stepper(BLINKING, synthesise(BLINKING))
    assert stepper.first_moment(initial_state(BLINKING)).restless
    assert not asked_first().restless


def asked_first() -> StepMoment:
    """The first moment of a station that rests."""
    made = station(NAME)
    return Stepper(made.automaton, made.supervisor).first_moment(initial_state(made.automaton))


def test_where_no_engine_can_answer_the_steps_are_told_without_a_plan(
    asked: Asking, monkeypatch: pytest.MonkeyPatch
) -> None:
    def answer(self: Planner, request: PlanRequest) -> PlanAnswer:
        raise PlannerError("each has failed")

    monkeypatch.setattr(Planner, "answer", answer)
    view = asked(follow=True)
    assert view.plan is not None
    assert (view.plan.verdict, view.plan.starts, view.stopped) == (Verdict.LATE, [], StopReason.NO_PLAN)
    assert view.choices, "what can happen next is known all the same"
