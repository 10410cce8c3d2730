"""Values of measured variables that no message can ever give, because the stage that gives the variable never does."""

from __future__ import annotations

from collections.abc import Iterator

from sequence_planner.analysis.checks.warning import ModelWarning, listed
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.language.printer import print_value
from sequence_planner.language.types import Value
from sequence_planner.model.stages.base import NotInvertibleError, Stage
from sequence_planner.model.stages.discretise import DiscretiseStage
from sequence_planner.model.stages.map import MapStage, TableStage, is_same
from sequence_planner.model.stages.match import MatchNamesStage
from sequence_planner.model.stages.support import PassingStage
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.texts.message import Message, message


def check_never_given(automaton: Automaton, pipelines: StationPipelines) -> Iterator[ModelWarning]:
    """Yield what the last stage that gives a variable leaves out of its values."""
    for node in pipelines.nodes:
        for writing in node.writings:
            stage = next((each for each in reversed(node.chain.stages) if _makes(each, writing.field)), None)
            if stage is None:
                continue
            domain = automaton.variables[writing.variable].type.domain
            never = [value for value in domain if not may_give(stage, writing.field, value)]
            if never:
                yield ModelWarning(stage.place, "never-given", _message(writing.variable, stage.kind, never))


def _makes(stage: Stage, field: str) -> bool:
    """Return whether the values of a field come from a stage, and do not only pass it."""
    return field in stage.gives and not isinstance(stage, PassingStage)


def may_give(stage: Stage, field: str, value: Value) -> bool:
    """Return whether a stage gives a value for some record; of a stage of which nobody can say, it may."""
    match stage:
        case DiscretiseStage() | MapStage() | MatchNamesStage():
            try:
                stage.backwards({field: value})
            except NotInvertibleError:
                return False
        case TableStage(gives=gives, rows=rows, otherwise=otherwise):
            column = list(gives).index(field)
            given = [row.gives[column] for row in rows] + ([] if otherwise is None else [otherwise[column]])
            return any(is_same(each, value) for each in given)
    return True


def _message(variable: str, stage: str, never: list[Value]) -> Message:
    values = listed([print_value(value) for value in never])
    return message("found.never-given", variable=variable, values=values, stage=stage, count=len(never))
