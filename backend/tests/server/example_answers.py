"""What a controller could answer when it is asked about the small station of `example_view`."""

from __future__ import annotations

from typing import Any

from sequence_planner.controller.commands.command import CommandRefused, Query
from sequence_planner.controller.commands.queries import (
    AboutMimic,
    AboutNames,
    AboutShifts,
    AboutWorkMasters,
    AskAbilityBlockers,
    AskAdvice,
    AskCorrection,
    AskDefinition,
    AskFigures,
    AskGoal,
    AskGoalBlockers,
    AskOperationBlockers,
    AskOperationDefinition,
    AskReset,
    AskTrace,
)
from sequence_planner.controller.tracing.schemas import (
    TracedChangeView,
    TracedPipelineView,
    TracedReaderView,
    TracedStepView,
    TraceView,
)
from sequence_planner.controller.views.details import (
    AbilityActionView,
    AbilityDefinitionView,
    ChangerView,
    ConditionView,
    ConjunctView,
    CorrectedView,
    CorrectionPreview,
    InvolvedView,
    NamesView,
    OperationDefinitionView,
    PredicateView,
    ReactionView,
    ReadValueView,
    ReasonTreeView,
    ReasonView,
    ShiftsView,
    SupervisedView,
    TimeoutsView,
    TrialView,
    TriedReactionView,
    WhyNotView,
    WorkAbilityView,
    WorkMastersView,
    WorkMasterView,
    WorkOperationView,
    WrittenPlaceView,
)
from sequence_planner.controller.views.metrics import (
    DistributionView,
    FiguresView,
    JournalFiguresView,
    PlannerFiguresView,
)
from sequence_planner.controller.views.proposals import (
    AdviceView,
    EffortView,
    OfferView,
    PlanPreviewView,
    PreviewStepView,
    ValueChangeView,
)
from sequence_planner.controller.views.station import BeliefView, SpecificationView, VariableKind
from sequence_planner.core.data_models import DataModel
from sequence_planner.core.distribution import Distribution
from sequence_planner.mimic.views import MimicView
from sequence_planner.texts.message import as_it_was, message

WORK_MASTERS = WorkMastersView(
    work_masters={
        "truck_engine": WorkMasterView(
            title="Engine",
            brings=["bolts[bolt_pair_1] := empty"],
            brought=["bolts[bolt_pair_1]"],
            operations={"tighten": WorkOperationView(title="Tighten", after=[], goal_reads=["bolts[bolt_pair_1]"])},
            alternatives=[],
            arbitrary=[],
        )
    },
    abilities={"robot.move": WorkAbilityView(title="Move", writes=["robot.pose"], instant=False)},
)
STEP = PreviewStepView(
    tick=1,
    start=0.0,
    end=2.0,
    ability="robot.move",
    title="Move",
    resource="robot",
    human=False,
    restart=True,
    moves=True,
)
PAUSE_FIRST = message("refused.wrong-mode.try", mode=message("mode.automatic"))
PLAN = PlanPreviewView(ticks=2, steps=[STEP], minimal_ticks=True, minimal_starts=False)
OFFER = OfferView(
    id="81a0a8-1",
    revision=7,
    kind="combined",
    title="Correct bolts[bolt_pair_1] to placed, then start Move",
    title_message=as_it_was("Correct bolts[bolt_pair_1] to placed, then start Move", "offer."),
    physical=[],
    online=[],
    in_service=[],
    assumed=[],
    corrections=[
        ValueChangeView(
            name="bolts[bolt_pair_1]", now="empty", then="placed", so=as_it_was("pair 1 is placed"), by_hand=None
        )
    ],
    errand=PLAN,
    ends="robot.pose == home",
    ends_message=as_it_was("robot.pose == home"),
    into_safe=False,
    operation=None,
    needs_restart=True,
    unsupervised=False,
    at_rest=True,
    breaks=[],
    then=PLAN,
    goals=["tighten"],
    left_out=[],
    claims=[],
    records=[],
    only_if_checked=False,
    effort=EffortView(cost=36.5, corrections=1, physical=0, returns=0, starts=1, seconds=4.5, time=36.5),
    obstacle=None,
    obstacle_message=None,
)
CLAIM = OFFER.model_copy(update={"kind": "correction", "errand": None, "claims": ["tighten"], "only_if_checked": True})
NO_NAMES = NamesView(
    variables={},
    values=[],
    station={},
    resources={},
    abilities={},
    tasks={},
    operations={},
    specifications={},
    work_masters={},
)
ADVICE = AdviceView(revision=7, offers=[OFFER], if_checked=[CLAIM], reasons=None, complete=True, seconds=0.4)
POSE = InvolvedView(
    name="robot.pose",
    kind="measured",
    resource="robot",
    value=None,
    wanted=["home"],
    since=999.5,
    topic="/robot/state",
    unconfirmed_since=None,
    changers=[
        ChangerView(
            how="message", name="/robot/state", title="a message on /robot/state", title_message=None, running=False
        )
    ],
)
CONDITION = ConditionView(
    kind="written",
    text="a message on /robot/state",
    text_message=as_it_was("a message on /robot/state"),
    expanded=None,
    involved=[POSE],
    sentence=as_it_was("waits for a message on /robot/state"),
)


REASONS = ReasonTreeView(
    about="enabled",
    specifications=[],
    rest=False,
    sequence=None,
    tree=ReasonView(
        kind="leaf",
        text="robot.pose == home",
        sentence=as_it_was("the robot is at home", "sentence."),
        predicate=None,
        holds=None,
        decides=True,
        wanted=True,
        reads=[ReadValueView(name="robot.pose", kind="measured", value=None)],
        involved=[POSE],
        parts=[],
    ),
)

TRACE = TraceView(
    name="robot.pose",
    kind=VariableKind.MEASURED,
    resource="robot",
    value=None,
    since=None,
    time=1000.0,
    revision=7,
    incoming=[
        TracedPipelineView(
            name="/robot/state",
            role="incoming",
            resource="robot",
            message="robot_msgs/msg/State",
            sources=[],
            last=None,
            fresh=False,
            deadline=1.0,
            trouble=None,
            steps=[
                TracedStepView(
                    kind=None, summary="", place=None, passes=False, fields=None, at=None, held=0, troubles=[]
                )
            ],
            becomes={"pose": "robot.pose"},
        )
    ],
    outgoing=[],
    written_by=None,
    belief=None,
    acknowledges=[],
    writers=[],
    readers=[
        TracedReaderView(
            of="ability",
            name="robot.move",
            title="Move",
            part="enabled",
            sentence=as_it_was("the robot is at home", "sentence."),
            holds=None,
            decides=True,
        )
    ],
    more_readers=0,
    from_beginning=True,
    changes=[TracedChangeView(name="bolts[left]", value="placed", since=999.0, same_tick=False, by=None, sent={})],
    more_changes=0,
)


CORRECTION = CorrectionPreview(
    revision=7,
    changes=[
        CorrectedView(
            name="bolts[left]",
            now="empty",
            then="placed",
            belief=BeliefView(writer="the journal", at=900.0, evidence=[], unconfirmed_since=900.0),
            related=["robot.pose == home", "operator.acknowledged is unknown"],
            related_messages=[
                message("value.unknown", name="the pose"),
                message("value.unknown", name="the acknowledgement"),
            ],
        )
    ],
    safe=True,
    safe_now=True,
    violates=[],
    startable=["robot.move"],
    no_longer_startable=[],
    activated=["tighten"],
    completed=[],
    contradictions_gone=[],
    contradictions_new=[],
    contradiction_messages=[],
    plan=PLAN,
    goals=["tighten"],
    left_out=[],
    reason="",
    reason_message=None,
    obstacle="Enter restart mode first.",
    obstacle_message=as_it_was("Enter restart mode first."),
)


HOME = PredicateView(
    text="pose == home",
    holds=None,
    parts=[
        ConjunctView(
            text="robot.pose == home",
            sentence=as_it_was("the robot is at home", "sentence."),
            holds=None,
            reads=[ReadValueView(name="robot.pose", kind="measured", value=None)],
        )
    ],
    place=WrittenPlaceView(file="resources/robot.yaml", line=12),
)
DEFINITION = AbilityDefinitionView(
    name="robot.move",
    title="Move",
    resource="robot",
    arguments=[],
    place=WrittenPlaceView(file="resources/robot.yaml", line=10),
    restart=False,
    task=None,
    acknowledgement=None,
    duration=(1.0, 2.0),
    revision=7,
    enabled=HOME,
    start=HOME,
    start_actions=[AbilityActionView(text="robot.target := above", variable="robot.target", done=False)],
    supervised=SupervisedView(
        guard=HOME, specifications=[SpecificationView(name="apart", title="Apart")], rest=False, blocked=[]
    ),
    allowed=True,
    executing=HOME,
    finished=HOME,
    finish=None,
    finish_actions=[],
    cancel_actions=[],
    timeouts=TimeoutsView(react=None, finish=3.0, retries=0, replan=False),
    reactions=[
        ReactionView(
            name="robot.move.arrives", kind="executing", guard=HOME, actions=[], shortest=1.0, longest=2.0, fault=False
        )
    ],
    obstacle=str(PAUSE_FIRST),
    obstacle_message=PAUSE_FIRST,
    real_devices=[],
    trial=TrialView(
        by="Eva",
        reason="",
        accepted=990.0,
        started=990.1,
        executing=None,
        ended=993.0,
        done=True,
        why="",
        reactions=[TriedReactionView(name="robot.move.arrives", due=990.2, came=992.0)],
    ),
)


SHIFTS = ShiftsView(shifts={})


def example_figures(*, behind: bool = False) -> FiguresView:
    """Of four ticks, three records and two plans."""
    ticks, latency = Distribution((0.001, 0.1)), Distribution((0.01,))
    for seconds in (0.0005, 0.001, 0.05, 2.0):
        ticks.note(seconds)
    for seconds in (0.002, 0.004, 0.02):
        latency.note(seconds)
    plans = Distribution((0.1,))
    plans.note(0.05)
    plans.note(0.2)
    return FiguresView(
        began=1_700_000_000.0,
        ticks=DistributionView.of(ticks),
        journal=JournalFiguresView(waiting=2, latency=DistributionView.of(latency), behind=behind),
        planner=[PlannerFiguresView(question="plan", outcome="found", took=DistributionView.of(plans))],
        replaced={"planner": 1, "adviser": 0},
    )


def example_answer(ask: Query[Any]) -> DataModel:
    """An answer of the kind that is asked for. Raises `CommandRefused` for what the station does not have."""
    match ask:
        case AboutWorkMasters():
            return WORK_MASTERS
        case AboutMimic():
            return MimicView(made_from="model", width=872, height=346, symbols=[], findings=[])
        case AboutNames():
            return NO_NAMES
        case AboutShifts():
            return SHIFTS
        case AskAdvice():
            return ADVICE
        case AskCorrection():
            return CORRECTION
        case AskFigures():
            return example_figures()
        case AskGoal() | AskReset():
            return OFFER
        case AskDefinition(ability=name):
            if name != DEFINITION.name:
                raise CommandRefused("unknown-ability", "Look at what it has.", 404)
            return DEFINITION
        case AskAbilityBlockers(name=name):
            return _blockers("ability", name)
        case AskOperationBlockers(name=name):
            return _blockers("operation", name)
        case AskOperationDefinition(name=name):
            if name != "tighten":
                raise CommandRefused("unknown-operation", "Look at what it has.", 404)
            return OperationDefinitionView(
                name=name, title="Tighten", revision=7, precondition=HOME, turns={"in_order": HOME}, goal=HOME
            )
        case AskTrace(name=name):
            if name != TRACE.name:
                raise CommandRefused("unknown-variable", "Look at what it has.", 404)
            return TRACE
        case AskGoalBlockers(predicate=name):
            return _blockers("goal", name)
    raise AssertionError(f"nobody has thought of an answer to {ask.kind}")


def _blockers(of: str, name: str) -> WhyNotView:
    if of != "goal" and name not in ("robot.move", "tighten"):
        raise CommandRefused(f"unknown-{of}", "Look at what it has.", 404)
    return WhyNotView(
        of=of,
        name=name,
        title="Move",
        revision=7,
        summary="It waits for a message on /robot/state.",
        summary_message=as_it_was("It waits for a message on /robot/state.", "blocked.", "waits."),
        conditions=[CONDITION],
        trees=[REASONS],
        plan=PLAN if of == "goal" else None,
        reasons=None,
    )
