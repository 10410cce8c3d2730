"""Questions whose answers are told only to who asks, and take some work: each kind of ask with the document that
answers it.

Asking changes nothing at the station. Who asks waits for `patience` seconds at most; what is found later is dropped.
"""

from __future__ import annotations

from typing import Annotated, ClassVar, Generic, Literal, TypeVar

from pydantic import BaseModel, Field

from sequence_planner.controller.commands.command import GivenValues
from sequence_planner.controller.views.details import (
    AbilityDefinitionView,
    CorrectionPreview,
    WhyNotView,
    WorkMastersView,
)
from sequence_planner.controller.views.metrics import FiguresView
from sequence_planner.controller.views.part import View
from sequence_planner.controller.views.pipelines import FlowsView, PipelinesView, RecordView
from sequence_planner.controller.views.proposals import AdviceView, OfferView
from sequence_planner.core.data_models import DataModel

TOLD_WITHIN = 1.0  # seconds: who watches over the station asks again soon
ADVISED_WITHIN = 15.0  # seconds: the adviser answers one after the other
LONGEST_PREDICATE = 4000  # characters

Answer = TypeVar("Answer", bound=View)


class Query(DataModel, Generic[Answer]):
    """Base of all asks. `patience` is null where who asks waits as long as for a command."""

    patience: ClassVar[float | None] = None
    kind: str

    @classmethod
    def answer_type(cls) -> type[Answer]:
        """The kind of document that answers it."""
        for base in cls.__mro__:
            if issubclass(base, BaseModel) and (arguments := base.__pydantic_generic_metadata__["args"]):
                found: type[Answer] = arguments[0]
                return found
        raise TypeError(f"{cls.__name__} does not say what answers it")


class AboutPipelines(Query[PipelinesView]):
    """The graph of the pipelines."""

    kind: Literal["about-pipelines"] = "about-pipelines"


class AboutFlows(Query[FlowsView]):
    """A question: what has passed the pipelines, all of them or those `among` these."""

    kind: Literal["about-flows"] = "about-flows"
    among: frozenset[str] | None = None


class AskFigures(Query[FiguresView]):
    """A question about what the controller has counted and timed of itself."""

    patience: ClassVar[float | None] = TOLD_WITHIN
    kind: Literal["ask-figures"] = "ask-figures"


class AskRecord(Query[RecordView]):
    """The last record at the beginning and at the end of a pipeline, in full."""

    kind: Literal["ask-record"] = "ask-record"
    pipeline: str = Field(max_length=LONGEST_PREDICATE)


class AskAdvice(Query[AdviceView]):
    """Ways on from the present state, replayed and ranked."""

    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-advice"] = "ask-advice"


class AskGoal(Query[OfferView]):
    """A plan to whatever an engineer wants to hold, in the model's language."""

    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-goal"] = "ask-goal"
    predicate: str = Field(max_length=LONGEST_PREDICATE)


class AskReset(Query[OfferView]):
    """A plan to the precondition of an operation."""

    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-reset"] = "ask-reset"
    operation: str = Field(max_length=LONGEST_PREDICATE)


class AskWhyNot(Query[WhyNotView]):
    """A question about what is in the way of an ability, an operation, or a goal, whose `name` is its predicate."""

    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-why-not"] = "ask-why-not"
    of: Literal["ability", "operation", "goal"]
    name: str = Field(max_length=LONGEST_PREDICATE)


class AskDefinition(Query[AbilityDefinitionView]):
    """A question about how an ability is defined, and what of that holds now."""

    kind: Literal["ask-definition"] = "ask-definition"
    ability: str = Field(max_length=LONGEST_PREDICATE)


class AskCorrection(Query[CorrectionPreview]):
    """A question about what a correction of these estimates would bring about."""

    patience: ClassVar[float | None] = ADVISED_WITHIN
    kind: Literal["ask-correction"] = "ask-correction"
    values: GivenValues


class AboutWorkMasters(Query[WorkMastersView]):
    """A question about what jobs consist of."""

    kind: Literal["about-work-masters"] = "about-work-masters"


Ask = Annotated[
    AboutPipelines
    | AboutFlows
    | AskFigures
    | AskRecord
    | AskCorrection
    | AskAdvice
    | AskGoal
    | AskReset
    | AskWhyNot
    | AskDefinition
    | AboutWorkMasters,
    Field(discriminator="kind"),
]
