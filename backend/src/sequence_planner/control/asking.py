"""Who answers what the controller is asked: each ask has its place."""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass

from sequence_planner.control.asks import (
    AboutFlows,
    AboutPipelines,
    AboutWorkMasters,
    Ask,
    AskAdvice,
    AskCorrection,
    AskDefinition,
    AskGoal,
    AskRecord,
    AskReset,
    AskWhyNot,
)
from sequence_planner.control.corrections import Corrections
from sequence_planner.control.definitions import Definitions
from sequence_planner.control.offers import Offers
from sequence_planner.control.pipeline_view import FlowsView, PipelinesView, RecordView
from sequence_planner.control.view_part import View
from sequence_planner.control.why_not import WhyNot
from sequence_planner.control.work_master_view import WorkMastersView


@dataclass(frozen=True)
class Asking:
    """Answers asks. The event loop is never held up: what takes long is awaited, and done in another process."""

    pipelines: Callable[[], PipelinesView]
    flows: Callable[[Container[str] | None], FlowsView]
    record: Callable[[str], RecordView]
    work_masters: Callable[[], WorkMastersView]
    corrections: Corrections
    offers: Offers
    why_not: WhyNot
    definitions: Definitions

    async def answer(self, ask: Ask) -> View:
        """The document that answers it. Raises `CommandRefused`."""
        match ask:
            case AboutPipelines():
                return self.pipelines()
            case AboutFlows(among=among):
                return self.flows(among)
            case AskRecord(pipeline=pipeline):
                return self.record(pipeline)
            case AboutWorkMasters():
                return self.work_masters()
            case AskCorrection(values=values):
                return await self.corrections.preview(values)
            case AskAdvice():
                return await self.offers.advice()
            case AskGoal(predicate=predicate):
                return await self.offers.goal(predicate)
            case AskReset(operation=operation):
                return await self.offers.reset(operation)
            case AskWhyNot():
                return await self.why_not.answer(ask)
            case AskDefinition(ability=ability):
                return self.definitions.of(ability)
