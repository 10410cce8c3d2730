"""Queries about a running station; `answers` declares who answers one."""

from __future__ import annotations

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from sequence_planner.controller.commands.command import LONGEST_PREDICATE, GivenValues, Predicate, Query, Route
from sequence_planner.controller.tracing.schemas import TraceView
from sequence_planner.controller.views.details import (
    AbilityDefinitionView,
    CorrectionPreview,
    NamesView,
    OperationDefinitionView,
    ShiftsView,
    WhyNotView,
    WorkMastersView,
)
from sequence_planner.controller.views.metrics import FiguresView
from sequence_planner.controller.views.pipelines import FlowsView, PipelinesView, RecordView
from sequence_planner.controller.views.proposals import AdviceView, OfferView
from sequence_planner.mimic.views import MimicView

TOLD_WITHIN = 1.0  # seconds: who watches over the station asks again soon
ADVISED_WITHIN = 15.0  # seconds: the advisor answers one after the other

Name = Annotated[str, Field(max_length=400)]
_GOAL_TEXT = "What shall hold, in the model's language."


class AboutPipelines(Query[PipelinesView]):
    """The typed graph: topics and flows with their stages, the fields on each edge, and what they become."""

    routes = (Route("GET", "/pipelines", "pipelines", tag="pipelines", role="viewer", refusals=(504,)),)
    kind: Literal["about-pipelines"] = "about-pipelines"


class AboutMimic(Query[MimicView]):
    """The live picture of the station: what is drawn where, and the variables by which each thing moves and changes.

    It is that of `mimic.yaml`; without one, or where that cannot be read, it is made from the model. `findings` say
    what of the file is not drawn, and why.
    """

    routes = (Route("GET", "/mimic", "mimic", tag="station", role="viewer", refusals=(504,)),)
    kind: Literal["about-mimic"] = "about-mimic"


class AboutNames(Query[NamesView]):
    """What people read in place of the names of variables and of their values, in each language, as the model says."""

    routes = (Route("GET", "/names", "names", tag="station", role="viewer", refusals=(504,)),)
    kind: Literal["about-names"] = "about-names"


class AboutFlows(Query[FlowsView]):
    """What has passed each edge of the pipelines that are named, or of all: counts, rates, drops and the last record.
    Rates come with the second look.
    """

    routes = (
        Route(
            "GET",
            "/pipelines/edges",
            "pipeline_edges",
            tag="pipelines",
            role="viewer",
            refusals=(504,),
            types={"among": Annotated[list[Annotated[str, Field(max_length=500)]] | None, Field(max_length=200)]},
            names={"among": "pipeline"},  # repeated as in `?pipeline=/robot/state&pipeline=robot.holding`
        ),
    )
    kind: Literal["about-flows"] = "about-flows"
    among: frozenset[str] | None = None


class AskFigures(Query[FiguresView]):
    """What the controller has counted and timed of itself."""

    patience: ClassVar[float | None] = TOLD_WITHIN
    kind: Literal["ask-figures"] = "ask-figures"


class AskRecord(Query[RecordView]):
    """The last record at the beginning and at the end of a pipeline, in full."""

    kind: Literal["ask-record"] = "ask-record"
    pipeline: str = Field(max_length=LONGEST_PREDICATE)


class AskAdvice(Query[AdviceView]):
    """Proven ways on from the present state, the least effort first, each with its plan.

    409 `plan-running` while a plan is being carried out. With an offer in `obstacle` stands what to do first.
    """

    routes = (Route("GET", "/recovery/proposals", "recovery_proposals", tag="recovery"),)
    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-advice"] = "ask-advice"


class AskGoal(Query[OfferView]):
    """A plan to whatever shall hold, to be looked at and perhaps taken.

    422 `bad-predicate` names the place; 409 `goal-holds` and `no-plan` say why there is nothing to take.
    """

    routes = (
        Route(
            "POST",
            "/operator-plans/goal-preview",
            "preview_goal",
            tag="recovery",
            body="GoalBody",
            body_text=_GOAL_TEXT,
            role="engineer",
        ),
    )
    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-goal"] = "ask-goal"
    predicate: Predicate


class AskReset(Query[OfferView]):
    """A plan to the precondition of an operation, from which it begins anew; 409 `no-plan` where there is none."""

    routes = (
        Route(
            "POST",
            "/operator-plans/reset-preview",
            "preview_reset",
            tag="recovery",
            body="ResetBody",
            body_text="The operation whose precondition shall hold again.",
            refusals=(404, 409, 504),
        ),
    )
    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-reset"] = "ask-reset"
    operation: Annotated[str, Field(min_length=1, max_length=200)]


class AskAbilityBlockers(Query[WhyNotView]):
    """What keeps an ability from starting, and who could change it."""

    routes = (
        Route(
            "GET", "/abilities/{name}/blockers", "ability_blockers", tag="station", role="viewer", refusals=(404, 504)
        ),
    )
    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-ability-blockers"] = "ask-ability-blockers"
    name: Name


class AskOperationBlockers(Query[WhyNotView]):
    """What keeps an operation from being active or completed, and who could change it."""

    routes = (
        Route(
            "GET",
            "/operations/{name}/blockers",
            "operation_blockers",
            tag="station",
            role="viewer",
            refusals=(404, 504),
        ),
    )
    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-operation-blockers"] = "ask-operation-blockers"
    name: Name


class AskOperationDefinition(Query[OperationDefinitionView]):
    """What it begins with and ends with as that is written, and what of it holds now."""

    routes = (
        Route(
            "GET",
            "/operations/{name}/definition",
            "operation_definition",
            tag="station",
            role="viewer",
            refusals=(404, 504),
        ),
    )
    kind: Literal["ask-operation-definition"] = "ask-operation-definition"
    name: Name


class AskTrace(Query[TraceView]):
    """A variable from the message that tells it, through each stage, to the conditions that read it and what has
    changed since; an output the other way.

    It is made of what is known anyhow; nothing is recorded for it.
    """

    routes = (
        Route("GET", "/variables/{name}/trace", "variable_trace", tag="station", role="viewer", refusals=(404, 504)),
    )
    kind: Literal["ask-trace"] = "ask-trace"
    name: Name


class AskGoalBlockers(Query[WhyNotView]):
    """What keeps a predicate from being true, and whether the station could reach it; 422 `bad-predicate`."""

    routes = (
        Route(
            "POST",
            "/goals/blockers",
            "goal_blockers",
            tag="station",
            body="GoalBody",
            body_text=_GOAL_TEXT,
            role="engineer",
            refusals=(504,),
        ),
    )
    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-goal-blockers"] = "ask-goal-blockers"
    predicate: Predicate


class AskDefinition(Query[AbilityDefinitionView]):
    """Its guards, actions and expected reactions as they are written, what of them holds now, and its last trial."""

    routes = (
        Route(
            "GET",
            "/abilities/{name}/definition",
            "ability_definition",
            tag="abilities",
            role="viewer",
            refusals=(404, 504),
            names={"ability": "name"},
        ),
    )
    kind: Literal["ask-definition"] = "ask-definition"
    ability: Name


class AskCorrection(Query[CorrectionPreview]):
    """What a correction would bring about: what it would violate, which abilities could start, the plan that follows.

    Nothing is changed by asking, and it may be asked in every mode.
    """

    routes = (
        Route(
            "POST",
            "/corrections/preview",
            "preview_correction",
            tag="corrections",
            body="ValuesBody",
            body_text="Estimated variables, each with the value that it is to have.",
            refusals=(404, 409, 422, 504),
        ),
    )
    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-correction"] = "ask-correction"
    values: GivenValues


class AboutWorkMasters(Query[WorkMastersView]):
    """What jobs consist of."""

    kind: Literal["about-work-masters"] = "about-work-masters"


class AboutShifts(Query[ShiftsView]):
    """When the station is to work."""

    kind: Literal["about-shifts"] = "about-shifts"
