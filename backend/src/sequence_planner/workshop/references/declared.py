"""The names that a draft declares, as far as it can be read: what grounding's declarations are to a sound model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from sequence_planner.automaton.grounding.declarations import FLAGS, OPERATION
from sequence_planner.model.source import SourceText
from sequence_planner.pipelines.goal_states import GOAL_STATE, GoalState
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.workshop.references.fields import inferred
from sequence_planner.workshop.references.parts import Part, variable_of
from sequence_planner.workshop.references.texts import (
    OPERATIONS,
    SPECIFICATIONS,
    STATION,
    WORK_MASTERS,
    Content,
    entry,
    items,
    message_of,
    pairs,
    text_at,
)

SECTIONS = ("measured", "output", "estimated")

# The parameters of a part, each with the name of its enumeration.
Parameters = Mapping[str, str]


@dataclass(frozen=True)
class Variable:
    """A variable: the section it stands in, its type as written, its parameters, and whether a file declares it."""

    section: str
    type: str | None = None
    parameters: Parameters = field(default_factory=dict)
    is_written: bool = True


class Declared:
    """The names of a draft. Variables and abilities are known by their full names.

    A variable that no file declares is there as well if the stages of a pipeline give it, or a message does whose
    fields `messages` knows.
    """

    def __init__(self, content: Content, messages: MessageRegistry | None) -> None:
        self.messages = messages
        self.enumerations: dict[str, tuple[str, ...]] = {}
        self.resources: dict[str, object] = {name: found for name, _, found in content.resources()}
        self.variables: dict[str, Variable] = {}
        self.abilities: dict[str, Parameters] = {}
        self.operations: dict[str, Parameters] = {}
        self.parts: list[Part] = []
        self.sent: set[str] = set()  # topics on which the station speaks
        station = content.get(STATION)
        for name, values in pairs(entry(station, "enumerations")):
            self.enumerations[str(name)] = tuple(str(value) for value in items(values) if isinstance(value, SourceText))
            self.parts.append(Part("enumeration", None, str(name)))
            self.parts += [Part("value", str(name), value) for value in self.enumerations[str(name)]]
        self._read_variables(None, "estimated", entry(station, "estimated"))
        for resource, found in self.resources.items():
            self._read_resource(resource, found)
        self._read_others(content)
        self.parts += [Part("message", None, name) for name in map(message_of, content.definitions) if name]
        has_actions = any(pairs(entry(found, "actions")) for found in self.resources.values())
        if has_actions:
            self.enumerations.setdefault(GOAL_STATE, tuple(map(str, GoalState)))
        self.values: dict[str, list[str]] = {}
        for enumeration, names in self.enumerations.items():
            for value in names:
                self.values.setdefault(value, []).append(enumeration)

    def own(self, resource: str, section: str) -> Iterator[tuple[str, Variable]]:
        """The variables of one section of a resource, by their names without it."""
        for name, variable in self.variables.items():
            owner, _, own = name.rpartition(".")
            if owner == resource and variable.section == section:
                yield own, variable

    def enumeration(self, resource: str | None, name: str) -> str | None:
        """The enumeration over which a variable ranges, if it does."""
        found = self.variables.get(variable_of(resource, name).full)
        return None if found is None or found.type not in self.enumerations else found.type

    def _read_variables(self, resource: str | None, section: str, written: object) -> None:
        for name, document in pairs(written):
            part = variable_of(resource, str(name))
            type_ = text_at(document, "type")
            of = parameters(entry(document, "for"))
            self.variables.setdefault(part.full, Variable(section, None if type_ is None else str(type_), of))
            self._note(part, of, part.full)

    def _read_resource(self, resource: str, found: object) -> None:
        self.parts.append(Part("resource", None, resource))
        for section in SECTIONS:
            self._read_variables(resource, section, entry(found, section))
        for name, document in pairs(entry(found, "abilities")):
            part = Part("ability", resource, str(name))
            self.abilities[part.full] = parameters(entry(document, "parameters"))
            self._note(part, self.abilities[part.full], part.full)
            self.parts += [Part("effect", part.full, str(each)) for each, _ in pairs(entry(document, "effects"))]
        self.parts += [Part("flow", resource, str(flow)) for flow, _ in pairs(entry(found, "flows"))]
        self.sent |= {str(each) for each, topic in pairs(entry(found, "topics")) if entry(topic, "direction") == "out"}
        for kind in ("topic", "service", "action"):
            self.parts += [Part(kind, None, str(each)) for each, _ in pairs(entry(found, f"{kind}s"))]
        for own, variable in inferred(found, self.messages).items():
            full = f"{resource}.{own}"
            declared = self.variables.get(full)
            if declared is None and full not in self.abilities and own not in FLAGS:
                self.variables[full] = Variable(variable.section, variable.type, is_written=False)
            elif declared is not None and declared.type is None and variable.type is not None:
                self.variables[full] = Variable(declared.section, variable.type, declared.parameters)

    def _read_others(self, content: Content) -> None:
        for name, document in pairs(content.get(OPERATIONS)):
            part = Part("operation", None, str(name))
            self.operations[part.name] = parameters(entry(document, "parameters"))
            self._note(part, self.operations[part.name], part.id)
        for name, document in pairs(content.get(SPECIFICATIONS)):
            part = Part("specification", None, str(name))
            self._note(part, parameters(entry(document, "parameters")), part.id)
        self.parts += [Part("work_master", None, str(name)) for name, _ in pairs(content.get(WORK_MASTERS))]

    def _note(self, part: Part, of: Parameters, holder: str) -> None:
        self.parts.append(part)
        self.parts += [Part("parameter", holder, name) for name in of]


def parameters(written: object) -> Parameters:
    """The parameters of a part, each with its enumeration."""
    return {str(name): str(of) for name, of in pairs(written) if isinstance(of, SourceText)}


def is_activity(names: list[str]) -> bool:
    """Whether a dotted name is that of an operation's activity."""
    return len(names) == 3 and names[0] == OPERATION and names[2] == "active"
