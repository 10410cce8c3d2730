"""Variables that bear the names of fields of messages: said by a `rename` stage, or left to the names alone."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sequence_planner.model.editing import insert, remove, replace
from sequence_planner.model.reading import EntryPath
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.workshop.references.fields import pipelines
from sequence_planner.workshop.references.occurrences import Binding
from sequence_planner.workshop.references.parts import Part
from sequence_planner.workshop.references.texts import Content, entry, file_of, items, pairs


def said(files: Mapping[str, str], bindings: Iterable[Binding]) -> dict[str, str]:
    """The files in which a `rename` stage says what the names alone have said: `{field: field}`."""
    new: dict[str, str] = {}
    for each in bindings:
        text = new.get(each.file, files[each.file])
        stages = items(entry(Content({each.file: text})[each.file], *each.path))
        new[each.file] = _with(text, each, stages)
    return new


def _with(text: str, binding: Binding, stages: list[object]) -> str:
    name, path = binding.field, binding.path
    stage = {"rename": {name: name}}
    if not stages:
        inside = entry(Content({binding.file: text})[binding.file], *path[:-1])
        is_there = isinstance(inside, dict) and path[-1] in inside
        return replace(text, path, [stage]) if is_there else insert(text, path, [stage])
    index = _index(binding.incoming, stages)
    if pairs(entry(stages[index], "rename")):
        return insert(text, (*path, index, "rename", name), name)
    if binding.incoming:
        return insert(text, (*path, 0), stage, before=0)
    return insert(text, (*path, len(stages)), stage)


def unsaid(files: Mapping[str, str], part: Part, messages: MessageRegistry | None) -> dict[str, str]:
    """The files of a variable without the `rename` stages that say what its name alone says."""
    file = file_of(part.owner or "")
    text = files[file]
    for pipeline in pipelines(Content({file: text})[file], messages):
        stages = items(pipeline.stages)
        if part.name not in (pipeline.fields or {}) or part.name in pipeline.ignored or not stages:
            continue
        index = _index(pipeline.incoming, stages)
        said_there = {str(field): str(name) for field, name in pairs(entry(stages[index], "rename"))}
        if said_there.get(part.name) == part.name:
            text = _without(text, (*pipeline.path, index, "rename", part.name), len(said_there), len(stages))
    return {} if text == files[file] else {file: text}


def _without(text: str, path: EntryPath, names: int, stages: int) -> str:
    """`text` without a pair of a stage; without the stage, or the pipeline, that would then be empty."""
    if names > 1:
        return remove(text, path)
    return remove(text, path[:-2] if stages > 1 else path[:-3])


def _index(incoming: bool, stages: list[object]) -> int:
    """The stage that has what a message says, or what is said in one: the first, or the last."""
    return 0 if incoming else len(stages) - 1
