"""Variables that a message names: an incoming field writes the variable of its name, an outgoing one reads it."""

from __future__ import annotations

from sequence_planner.expressions.types import IntegerRange
from sequence_planner.pipelines.paths import NoFieldError, find_field
from sequence_planner.workshop.references.declared import Variable
from sequence_planner.workshop.references.fields import SINGLE, Pipeline
from sequence_planner.workshop.references.occurrences import Binding, Unwritten, Where
from sequence_planner.workshop.references.parts import variable_of
from sequence_planner.workshop.references.record import Field
from sequence_planner.workshop.references.stages import Stages, given_by
from sequence_planner.workshop.references.texts import entry, items, pairs


def bind(stages: Stages, pipeline: Pipeline, file: str) -> None:
    """Note the variables that are bound to fields of a message by their names, at the end of a pipeline."""
    names = stages.names
    declared = names.naming.declared
    read = _read_by(pipeline.stages)
    for section in ("measured",) if pipeline.incoming else ("measured", "output", "estimated"):
        for name, variable in declared.own(names.resource, section):
            part = variable_of(names.resource, name)
            enumeration = declared.enumeration(names.resource, name)
            if not _is_bound(name, variable, stages, pipeline, read):
                continue
            where = f"of the messages of {pipeline.called}"
            gathered = names.naming.gathered
            if pipeline.fields is None:
                why = f"{part} may be a field {where}, whose definition is not known"
                gathered.tie(part, why)
            elif _is_of_constants(name, enumeration, pipeline):
                why = f"the field `{name}` {where} says the values of {part} by numbers of their names"
                gathered.tie(part, why)
            else:
                why = f"{part} would be the field `{name}` {where}"
                binding = Binding(file, pipeline.path, pipeline.incoming, name, why)
                gathered.bindings.setdefault(part, []).append(binding)
            entry_of = Where(file, pipeline.path, f"{pipeline.kind} {pipeline.path[1]}", 2)
            gathered.unwritten.append(Unwritten(part, entry_of, pipeline.incoming, why))
            stages.tie(enumeration, f"the field `{name}` {where} says the values of {part} by their names")
            if pipeline.incoming:
                names.fields.setdefault(name, Field(part, enumeration))


def _is_of_constants(name: str, enumeration: str | None, pipeline: Pipeline) -> bool:
    """Whether an outgoing message has constants for the values of a variable: that holds for no field of a stage."""
    field = (pipeline.fields or {}).get(name)
    return not pipeline.incoming and enumeration is not None and isinstance(field, IntegerRange)


def _is_bound(name: str, variable: Variable, stages: Stages, pipeline: Pipeline, read: set[str]) -> bool:
    """Whether a variable is a field of the message, or may be one where nobody knows the message."""
    if name in pipeline.ignored or variable.parameters:
        return False
    if pipeline.incoming:
        renamed = {str(field) for stage in items(pipeline.stages) for field, _ in pairs(entry(stage, "rename"))}
        is_made = name in given_by(pipeline.stages) or name in renamed
    else:
        is_made = name in stages.names.fields
    if is_made:
        return False
    if pipeline.fields is None:
        may_be_one = variable.section == ("measured" if pipeline.incoming else "output")
        return may_be_one and name not in read and not _is_made_elsewhere(name, stages, pipeline)
    try:
        find_field(pipeline.fields, name)
    except NoFieldError:
        return False
    return True


def _is_made_elsewhere(name: str, stages: Stages, pipeline: Pipeline) -> bool:
    """Whether the pipeline of another message of the resource makes a variable, or uses it."""
    resource = stages.names.naming.declared.resources.get(stages.names.resource)
    for _, topic in pairs(entry(resource, "topics")):
        stages_there = entry(topic, "pipeline")
        if stages_there is pipeline.stages or (entry(topic, "direction") == "in") is not pipeline.incoming:
            continue
        if name in given_by(stages_there) or (not pipeline.incoming and name in _variables_of(stages_there)):
            return True
    return False


def _variables_of(stages: object) -> set[str]:
    """The variables that stages of an outgoing pipeline make something else of."""
    found = {str(entry(stage, kind, "variable")) for stage in items(stages) for kind in ("undiscretise", "map")}
    return found | {str(name) for stage in items(stages) for _, name in pairs(entry(stage, "rename"))}


def _read_by(stages: object) -> set[str]:
    """The fields of an incoming message that stages make something else of, and the variables of an outgoing one."""
    found = {str(entry(stage, kind, "field")) for stage in items(stages) for kind in SINGLE}
    found |= {str(field) for stage in items(stages) for field, _ in pairs(entry(stage, "rename"))}
    return found | _variables_of(stages)
