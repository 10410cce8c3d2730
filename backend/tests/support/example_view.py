"""A small station to show: two resources, a task, a plan of two starts, one alarm."""

from __future__ import annotations

from sequence_planner.controller.commands.approvals import CorrectionAct
from sequence_planner.controller.views.station import (
    AbilityView,
    AlarmGroup,
    AlarmMessages,
    AlarmState,
    AlarmView,
    ApprovalState,
    ApprovalView,
    BeliefView,
    BreakpointView,
    ForceView,
    InstructionView,
    JobStepState,
    JobStepView,
    JobView,
    NextMovesView,
    OperationView,
    OverrideFieldView,
    OverrideView,
    PackML,
    PlanStepView,
    PlanView,
    Priority,
    ResourceView,
    StationIdentity,
    StationStanding,
    StationView,
    StepStatus,
    TaskView,
    TopicView,
    UndecidedOutputView,
    VariableKind,
    VariableView,
)
from sequence_planner.execution.vocabulary import JobState, Mode, PlanStatus, Production
from sequence_planner.planning.problem import Contract
from sequence_planner.texts.message import Sentence, Wording, as_it_was, message


def ability(resource: str, title: str) -> AbilityView:
    return AbilityView(
        resource=resource,
        title=title,
        human=resource == "operator",
        moves=True,
        restart=False,
        enabled=True,
        executing=False,
        finished=False,
        running_since=None,
    )


def example_job(**more: object) -> JobView:
    """A job that runs, with `more` in place of what it has."""
    view = JobView(
        title="",
        work_master="truck_engine",
        state=JobState.RUNNING,
        stopping=False,
        taken=1.0,
        begun=1.0,
        ended=None,
        waits_for=[],
        waits_for_messages=[],
        sentence=None,
        steps={},
    )
    return view.model_copy(update=more)


def step(name: str, resource: str, status: StepStatus, tick: int) -> PlanStepView:
    return PlanStepView(
        id=f"{name}@{tick}",
        ability=f"{resource}.{name}",
        title=name,
        resource=resource,
        status=status,
        tick=tick,
        started=None,
        ended=None,
        expected_start=None,
        expected_end=None,
        after=None,
        new=False,
        waits_for=[],
        waits_for_messages=[],
        sentence=None,
    )


def example_view(**changes: object) -> StationView:
    """The station at tick 1, with `changes` to its members."""
    view = StationView(
        station=StationIdentity(
            name="bolting",
            title="Bolting",
            titles={"en": "Bolting", "sv": "Skruvning"},
            description="Tightens a bolt pair.",
            transport="cyclonedds",
            emulated=True,
        ),
        tick=1,
        time=1000.0,
        revision=1,
        mode=Mode.AUTOMATIC,
        packml=PackML.EXECUTE,
        standing=StationStanding.WORKING,
        silent=[],
        failing=[],
        stepping=False,
        cycle_stop=None,
        breakpoints={
            "1": BreakpointView(
                condition="robot.pose == home",
                sentence=message(
                    "sentence.so", condition=Sentence({"en": "the robot is at home"}, "robot.pose == home")
                ),
                by="Eva",
                since=1700000000.0,
                hits=0,
                last=None,
                stopped=False,
            )
        },
        production=Production.STARTED,
        unconfirmed=False,
        undecided={
            "robot.target_pose": UndecidedOutputView(
                value="home",
                reacts=["robot reacts: robot.moving"],
                reacts_messages=[as_it_was("robot reacts: robot.moving", "reacts.")],
                quiet=["above"],
                unsafe=["at_bolt"],
            )
        },
        resources={
            "robot": ResourceView(title="Robot", online=True, awaited_topics=[]),
            "operator": ResourceView(title="Operator", online=True, awaited_topics=[]),
        },
        variables={
            "robot.pose": VariableView(
                resource="robot",
                kind=VariableKind.MEASURED,
                value="home",
                domain=["home", "above_engine", "unknown"],
                dual_approval=False,
                since=999.0,
                awaits=None,
                last_known=None,
                belief=None,
                commanded_by=None,
            ),
            "bolts[bolt_pair_1]": VariableView(
                resource=None,
                kind=VariableKind.ESTIMATED,
                value="empty",
                domain=["empty", "placed", "tightened"],
                dual_approval=True,
                since=None,
                awaits=None,
                last_known=None,
                belief=BeliefView(writer="the beginning", at=900.0, evidence=[], unconfirmed_since=None),
                commanded_by=None,
            ),
        },
        abilities={
            "robot.move": ability("robot", "Move"),
            "operator.place": ability("operator", "Place bolt pair"),
        },
        operations={
            "tighten": OperationView(
                title="Tighten bolt pair 1",
                active=True,
                active_since=990.0,
                completed=0,
                began=None,
                ended=None,
                first_step=None,
                last_step=None,
                steps=[],
                work=[],
                goal="bolts[bolt_pair_1] = tightened",
                precondition="true",
                sentence=message("sentence.goal", condition=Wording({"en": "bolt pair 1 is tight"})),
                left_out=False,
                repeat=True,
                for_jobs=True,
                job="4711",
            )
        },
        by_order=True,
        jobs={
            "4711": JobView(
                title="Engine 4711",
                work_master="truck_engine",
                state=JobState.RUNNING,
                stopping=False,
                taken=980.0,
                begun=981.0,
                ended=None,
                waits_for=[],
                waits_for_messages=[],
                sentence=None,
                steps={"tighten": JobStepView(state=JobStepState.ACTIVE, waits_for=[], started=990.0, ended=None)},
            )
        },
        plan=PlanView(
            status=PlanStatus.FOLLOWED,
            since=990.0,
            reason="planned for tighten",
            reason_message=as_it_was("planned for tighten", "plan."),
            steps=[
                step("place", "operator", StepStatus.RUNNING, 0),
                step("move", "robot", StepStatus.NEXT, 2),
            ],
            ticks=4,
            minimal_ticks=True,
            minimal_starts=True,
            replanned=0,
            replacement=None,
            contract=Contract.MINIMAL,
            engine="bounded model checking",
            milliseconds=1.5,
            why=None,
        ),
        errand=None,
        last_errand=None,
        forces={"robot.pose": ForceView(value="home", real="unknown", until=1700000100.0, by="Eva", why="a look")},
        out_of_service=[],
        questions=[],
        last_correction=None,
        who_can=None,
        approvals={
            "a-1": ApprovalView(
                act=CorrectionAct(values={"bolts[bolt_pair_1]": "placed"}),
                revision=1,
                person="eva",
                by="Eva",
                why="seen with my own eyes",
                since=1000.0,
                until=1120.0,
                state=ApprovalState.WAITING,
                answered_by=None,
                answer=None,
            )
        },
        tasks={
            "7": TaskView(
                revision=3,
                ability="operator.place",
                resource="operator",
                title="Place bolt pair 1",
                text="Place it on the cover plate",
                created=995.0,
                next_moves=["Move above the engine"],
                movers=[NextMovesView(name="robot", title="Robot", moves=["Move above the engine"])],
                begins=["Tighten"],
                instruction=InstructionView(
                    text={
                        "en": "Put both bolts into the marked holes.",
                        "sv": "Sätt båda skruvarna i de markerade hålen.",
                    },
                    image="instructions/place_bolts.svg#bolt_pair_1",
                    video=None,
                ),
                problem=None,
            )
        },
        topics={
            "/robot/state": TopicView(
                type="bolting_msgs/msg/RobotState",
                direction="in",
                resource="robot",
                last=999.9,
                messages=12,
                deadline=0.5,
                fresh=True,
                peers=1,
                trouble=None,
                trouble_message=None,
            )
        },
        overrides={
            "robot.speed": OverrideView(
                pipeline="/robot/command",
                resource="robot",
                expires=60.0,
                fields={"speed": OverrideFieldView(type="real", between=(0.05, 0.5), among=None, value=0.1)},
                actor="local",
                until=1030.0,
            )
        },
        control=None,
        alarms={
            "slow": AlarmView(
                kind="slow",
                subject="",
                group=AlarmGroup.DEVICE,
                messages=AlarmMessages(as_it_was("The robot is slow"), None, None, ()),
                resources=["robot"],
                topics=[],
                priority=Priority.LOW,
                state=AlarmState.UNACKNOWLEDGED,
                text="The robot is slow",
                consequence="The work takes longer",
                action="Look at it",
                since=998.0,
                ended=None,
                by=None,
                until=None,
                why=None,
                count=1,
                parts=[],
            )
        },
        named_alarm=None,
        way_back=None,
        analysis=None,
        standby=None,
        deployment=None,
    )
    return view.model_copy(update=changes)
