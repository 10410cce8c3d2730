"""A draft that is tried: emulated devices and a clock that somebody leads, on, back, and otherwise."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from editor.models import bolts
from sequence_planner.editor.draft import AddEntry, applied
from sequence_planner.editor.schemas.simulation import (
    Advance,
    NoSimulationError,
    ScenarioExpectation,
    ScenariosView,
    SimulationMomentView,
    SimulationStop,
    SimulationView,
    WrittenScenarioView,
)
from sequence_planner.editor.simulating import simulation
from sequence_planner.editor.simulating.scenarios import found_scenarios
from sequence_planner.editor.simulating.worker import MOST_TRIED, answering
from sequence_planner.language.types import Value
from sequence_planner.model.paths import EditError
from support.places import BOLT_TIGHTENING

TIGHT = " and ".join(f"bolts[bolt_pair_{number}] == tightened" for number in (1, 2, 3))


class Trying:
    """The process that a page asks, and the simulation that it has begun last."""

    def __init__(self, folder: Path) -> None:
        self._answer: Any = answering(folder)
        self._files: dict[str, str] = {}
        self.id: str | None = None

    def begin(
        self, present: Mapping[str, Value | None] | str | None = None, files: dict[str, str] | None = None
    ) -> SimulationView:
        begun = self._ask(None, present or {}, Advance(), files or bolts())
        self.id = begun.id
        return begun

    def __call__(
        self,
        seconds: float = 0.0,
        *,
        files: dict[str, str] | None = None,
        **asked: Any,  # noqa: ANN401
    ) -> SimulationView:
        """Let so many seconds pass, however busy the machine is."""
        view = self._ask(self.id, {}, Advance(seconds=seconds, **asked), files or self._files)
        ends = asked.get("at", view.since) + seconds
        kept = {name: asked[name] for name in ("until", "once", "people_wait") if name in asked}
        while view.stopped is SimulationStop.LATE:
            rest = Advance(seconds=max(0.0, ends - view.seconds), **kept)
            more = self._ask(self.id, {}, rest, self._files)
            view = more.model_copy(update={"since": view.since, "moments": [*view.moments, *more.moments]})
        return view

    def _ask(
        self, id: str | None, present: Mapping[str, Value | None] | str, advance: Advance, files: dict[str, str]
    ) -> SimulationView:
        changed = {path: text for path, text in files.items() if self._files.get(path) != text}
        self._files = files
        question = (changed, "simulated", (7, BOLT_TIGHTENING, id, present, advance))
        return SimulationView.model_validate_json(self._answer(question, None))

    def kept(self, **expected: Any) -> dict[str, Any]:  # noqa: ANN401
        """The scenario that the simulation becomes."""
        question: Any = ({}, "scenario", (self.id, ScenarioExpectation(**expected)))
        return WrittenScenarioView.model_validate_json(self._answer(question, None)).document


@pytest.fixture
def trying(tmp_path: Path) -> Trying:
    return Trying(tmp_path)


def test_the_station_goes_on_by_itself_to_its_goals_and_people_do_what_they_are_asked(trying: Trying) -> None:
    begun = trying.begin()
    assert begun.model is not None
    assert begun.model.before["bolts[bolt_pair_1]"] == "empty"
    assert set(begun.model.failing) == {"robot", "nutrunner"}
    over = trying(300, until=TIGHT)
    assert over.stopped is SimulationStop.UNTIL
    assert values(begun, over)["bolts[bolt_pair_3]"] == "tightened"
    started = [ability for moment in over.moments for ability in moment.started]
    ended = [ability for moment in over.moments for ability in moment.ended]
    assert "nutrunner.run_nut" in started
    assert "nutrunner.run_nut" in ended
    assert [moment.seconds for moment in over.moments] == sorted(moment.seconds for moment in over.moments)
    assert 10 < over.seconds < 200, "devices and people take the time that the model says"


def test_what_is_planned_is_told_with_its_times(trying: Trying) -> None:
    trying.begin()
    view = trying(5)
    assert view.plan
    assert all(view.seconds - 60 < each.start <= each.end for each in view.plan)


def test_people_may_wait_until_somebody_says_that_their_task_is_done(trying: Trying) -> None:
    trying.begin()
    waiting = trying(60, people_wait=True)
    (task,) = waiting.tasks
    assert task.ability.startswith("operator.place_bolt_pair")
    assert trying(60, people_wait=True).tasks == [task]
    done = trying(5, people_wait=True, done=[task.task])
    assert any(task.ability in moment.ended for moment in done.moments)
    assert done.moments[0].did == [f"“{task.title}” is done"]
    assert trying(0, done=[task.task]).moments == [], "it is over"


def test_a_device_that_says_nothing_is_unknown_once_its_deadline_is_over_and_known_again(trying: Trying) -> None:
    begun = trying.begin()
    silent = trying(3, faults=["robot silent"])
    assert silent.moments[0].did == ["Robot UR10 says nothing"]
    assert [(fault.line, fault.target) for fault in silent.faults] == [("robot silent", "robot")]
    unknown = next(each for each in silent.moments if any(change.name == "robot.pose" for change in each.changes))
    assert unknown.seconds == pytest.approx(1.0, abs=0.2)
    assert values(begun, silent)["robot.pose"] is None
    again = trying(1, faults=["clear"])
    assert again.faults == []
    known = next(change for each in again.moments for change in each.changes if change.name == "robot.pose")
    assert known.after is not None


@pytest.mark.parametrize(
    ("line", "seconds"),
    [("nutrunner stuck", 60.0), ("nutrunner offline", 60.0), ("nutrunner.programmed_torque_reached wrong false", 60.0)],
)
def test_with_a_fault_of_the_nutrunner_no_bolt_is_tightened(trying: Trying, line: str, seconds: float) -> None:
    trying.begin()
    faulty = trying(seconds, faults=[line], until="bolts[bolt_pair_1] == tightened")
    assert faulty.stopped is None
    assert faulty.seconds == pytest.approx(seconds)


def test_a_slow_device_takes_longer(trying: Trying) -> None:
    trying.begin()
    usual = trying(300, until=TIGHT).seconds
    trying.begin()
    assert trying(300, until=TIGHT, faults=["nutrunner slow 3"]).seconds > usual + 3


def test_a_fault_or_value_that_cannot_be_is_refused_and_nothing_is_done(trying: Trying) -> None:
    trying.begin()
    with pytest.raises(EditError, match="did you mean `robot`"):
        trying(5, faults=["robott silent"])
    with pytest.raises(EditError, match=r"no emulated device tells nutrunner\.run_tool_forward"):
        trying(5, sets={"nutrunner.run_tool_forward": True})
    with pytest.raises(EditError, match=r"no value of robot\.pose"):
        trying(5, sets={"robot.pose": "moon"})
    with pytest.raises(EditError):
        trying(5, until="bolts[bolt_pair_1] == tigtened")
    assert (trying(0).seconds, trying(0).faults) == (0, [])


def test_who_moves_a_device_by_hand_sees_what_the_station_makes_of_it(trying: Trying) -> None:
    begun = trying.begin()
    moved = trying(0.1, sets={"nutrunner.tool_is_running_forward": True})
    assert "tool_is_running_forward" in str(moved.moments[0].did)
    assert values(begun, moved)["nutrunner.tool_is_running_forward"] is True


def test_back_at_a_moment_it_can_go_on_otherwise(trying: Trying) -> None:
    begun = trying.begin()
    first = trying(30)
    at = first.moments[len(first.moments) // 2].seconds
    back = trying(0, at=at)
    assert back.seconds == at
    assert back.since <= at
    kept = [moment for moment in first.moments if moment.seconds <= back.since]
    assert values(begun, back, kept) == values(begun, None, [m for m in first.moments if m.seconds <= at])
    otherwise = trying(60, faults=["nutrunner offline"], until="bolts[bolt_pair_3] == tightened")
    assert otherwise.stopped is None


@given(st.lists(st.floats(0.1, 6.0), min_size=1, max_size=6), st.floats(0.0, 1.0))
def test_it_is_the_same_however_time_is_cut_and_gone_back_in(
    tmp_path_factory: pytest.TempPathFactory, cuts: list[float], back: float
) -> None:
    # One pair is left, so that plans that are as good as each other start the same, if in another order in a tick.
    left: dict[str, Value | None] = {f"bolts[bolt_pair_{number}]": "tightened" for number in (1, 2)}
    pieces = [round(cut, 1) for cut in cuts]
    trying = Trying(tmp_path_factory.mktemp("trying"))
    trying.begin(left)
    whole = ordered(trying(sum(pieces)).moments)
    trying.begin(left)
    told: list[SimulationMomentView] = []
    for piece in pieces:
        told += trying(piece).moments
    assert ordered(told) == whole
    at = round(back * sum(pieces), 1)
    again = trying(0, at=at)
    told = [moment for moment in told if moment.seconds <= again.since] + again.moments
    assert ordered(told + trying(sum(pieces) - at).moments) == whole


def test_what_is_refused_leaves_the_present_and_the_news_of_an_edit_as_they_were(trying: Trying) -> None:
    trying.begin()
    passed = trying(20).seconds
    with pytest.raises(EditError):
        trying(1, at=5.0, faults=["robott silent"])
    assert trying(0).seconds == passed, "it has not gone back"
    edited = bolts(nutrunner=("Run the nutrunner", "Let it turn"))
    with pytest.raises(EditError):
        trying(1, files=edited, until="bolts[bolt_pair_1] == tigtened")
    told = trying(0)
    assert told.model is not None
    assert told.model.titles["nutrunner.run_nut"] == "Let it turn"


def test_one_step_ends_with_the_next_thing_that_happens(trying: Trying) -> None:
    trying.begin()
    seen = [trying(60, once=True).moments for _ in range(4)]
    assert all(1 <= len(moments) <= 3 for moments in seen), "what happens in one tick, or in those right after it"
    assert seen[-1][0].seconds > 0


def test_an_edit_is_taken_over_on_the_way_and_one_that_cannot_be_used_waits(trying: Trying) -> None:
    begun = trying.begin()
    before = trying(10)
    broken = trying(5, files=bolts(nutrunner=("duration: [2, 4]", "duration: [2, x]")))
    assert broken.obstacle is not None
    assert (broken.seconds, broken.moments) == (before.seconds, [])
    edited = trying(5, files=bolts(nutrunner=("Run the nutrunner", "Let it turn")))
    assert edited.obstacle is None
    assert edited.model is not None
    assert edited.model.titles["nutrunner.run_nut"] == "Let it turn"
    assert edited.model.before == values(begun, before), "it goes on where it was"
    assert edited.seconds == pytest.approx(15)
    assert trying(1).model is None, "told once"


def test_a_draft_that_cannot_be_used_is_not_tried(trying: Trying) -> None:
    view = trying.begin(files=bolts(nutrunner=("duration: [2, 4]", "duration: [2, x]")))
    assert view.id is None
    assert "nutrunner.yaml" in str(view.obstacle)


def test_those_asked_for_last_are_kept(trying: Trying) -> None:
    trying.begin()
    first = trying.id
    for _ in range(MOST_TRIED):
        trying.begin()
    assert trying(1).seconds == pytest.approx(1)
    trying.id = first
    with pytest.raises(NoSimulationError):
        trying(1)


def run(tmp_path: Path, files: dict[str, str], names: list[str] | None) -> ScenariosView:
    """What is found of the scenarios of a draft."""
    (folder := tmp_path / "run").mkdir()
    (text,) = found_scenarios(7, files, None, names, folder)
    assert isinstance(text, str)
    return ScenariosView.model_validate_json(text)


def test_a_scenario_is_carried_out_and_what_failed_is_told_at_its_place(trying: Trying) -> None:
    files = bolts() | {"tests/own.yaml": "late:\n  steps:\n    - completes: new_engine\n      within: 3\n"}
    view = trying.begin("late", files)
    assert view.scenario is not None
    assert view.scenario.failure is not None
    assert (view.scenario.failure.file, view.scenario.failure.line) == ("tests/own.yaml", 3)
    assert view.seconds == pytest.approx(3)
    assert view.moments, "it is looked at as any other simulation"
    assert trying(2).seconds == pytest.approx(5), "and goes on"
    assert trying(0, at=1.0).seconds == pytest.approx(1), "and back"
    passed = trying.begin("an_engine_is_tightened", files).scenario
    assert passed is not None
    assert passed.failure is None
    with pytest.raises(EditError, match="did you mean `late`"):
        trying.begin("lat", files)


def test_what_was_tried_is_kept_as_a_scenario_that_passes(trying: Trying, tmp_path: Path) -> None:
    trying.begin({"bolts[bolt_pair_1]": "placed", "bolts[bolt_pair_2]": "tightened", "bolts[bolt_pair_3]": "tightened"})
    trying(1)
    trying(0, faults=["robot silent for 5 s"])
    trying(2)
    trying(0, sets={"robot.pose": "unknown"})
    trying(30, until="bolts[bolt_pair_1] == tightened")
    document = trying.kept(holds="bolts[bolt_pair_1] == tightened", title="It goes on")
    assert document["given"] == {
        "bolts[bolt_pair_1]": "placed",
        "bolts[bolt_pair_2]": "tightened",
        "bolts[bolt_pair_3]": "tightened",
    }
    assert [set(step) for step in document["steps"]] == [{"wait"}, {"fault"}, {"wait"}, {"set"}, {"holds", "within"}]
    assert [step["wait"] for step in document["steps"] if "wait" in step] == [1.0, 2.0]
    edit = AddEntry(file="tests/kept.yaml", path=["it_goes_on"], value=document)
    files = applied(bolts(), [edit])
    found = run(tmp_path, files, ["it_goes_on"])
    assert found.wrong == []
    assert [(each.name, each.failure) for each in found.runs] == [("it_goes_on", None)]


def test_people_who_wait_and_starts_as_they_were_are_kept(trying: Trying, tmp_path: Path) -> None:
    trying.begin()
    view = trying(20, people_wait=True)
    (task,) = view.tasks
    trying(0, done=[task.task], people_wait=True)
    trying(20, until=TIGHT, people_wait=True)
    document = trying.kept(starts=True)
    assert document["people"] == "wait"
    done, starts = (step for step in document["steps"] if "wait" not in step)
    assert done == {"done": task.ability}
    assert "nutrunner.run_nut" in starts["starts"]
    files = applied(bolts(), [AddEntry(file="tests/kept.yaml", path=["by_hand"], value=document)])
    (kept,) = run(tmp_path, files, ["by_hand"]).runs
    assert kept.failure is None


def test_what_was_done_is_still_done_where_few_moments_are_kept(
    trying: Trying, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(simulation, "MOST_KEPT", 6)
    trying.begin()
    lines = ["robot offline", "nutrunner offline", "robot.pose wrong home", "robot slow 3"]
    for line in lines:
        trying(0.5)
        trying(0, faults=[line])
    trying(20)
    for number in range(len(lines), 0, -1):
        view = trying(0, at=number * 0.5 + 0.1)
        assert [each.line for each in view.faults] == lines[:number]


def test_a_test_expects_something(trying: Trying) -> None:
    trying.begin()
    trying(1)
    with pytest.raises(EditError, match="a test expects something"):
        trying.kept()
    with pytest.raises(EditError, match="tigtened"):
        trying.kept(holds="bolts[bolt_pair_1] == tigtened")


def test_the_scenarios_of_a_draft_are_listed_and_carried_out(tmp_path: Path) -> None:
    (other := tmp_path / "listed").mkdir()
    listed = run(other, bolts(), None)
    assert [each.name for each in listed.scenarios] == [
        "an_engine_is_tightened",
        "the_operator_takes_a_break",
        "the_robot_falls_silent",
    ]
    assert listed.scenarios[0].file == "tests/work.yaml"
    assert listed.runs == []
    wrong = bolts() | {"tests/own.yaml": "broken:\n  steps:\n    - completes: new_engin\n"}
    found = run(tmp_path, wrong, [])
    assert [each.name for each in found.runs] == [each.name for each in listed.scenarios]
    assert all(each.failure is None for each in found.runs)
    (place,) = found.wrong
    assert (place.file, place.line) == ("tests/own.yaml", 3)
    assert "robot.move_to_previous" in found.not_exercised["abilities"]


def test_one_that_is_asked_for_and_cannot_be_carried_out_is_refused(tmp_path: Path) -> None:
    (refused,) = found_scenarios(7, bolts(), None, ["the_robot_fals_silent"], tmp_path)
    assert isinstance(refused, EditError)
    assert "did you mean `the_robot_falls_silent`" in str(refused.why)


def test_a_draft_that_cannot_be_used_says_so_of_its_scenarios(tmp_path: Path) -> None:
    view = run(tmp_path, bolts(nutrunner=("duration: [2, 4]", "duration: [2, x]")), [])
    assert "nutrunner.yaml" in str(view.obstacle)


def ordered(moments: list[SimulationMomentView]) -> list[SimulationMomentView]:
    """The moments with what starts in one of them by its name."""
    return [moment.model_copy(update={"started": sorted(moment.started)}) for moment in moments]


def values(
    begun: SimulationView, view: SimulationView | None, moments: list[SimulationMomentView] | None = None
) -> dict[str, Value | None]:
    """The values after these moments and those of a view."""
    assert begun.model is not None
    found = dict(begun.model.before)
    for moment in [*(moments or []), *(view.moments if view else [])]:
        found |= {change.name: change.after for change in moment.changes}
    return found
