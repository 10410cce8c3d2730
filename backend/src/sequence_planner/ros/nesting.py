"""Which messages contain which.

A field may hold another message, so a definition is only as good as those it refers to: each must exist, and none may
contain itself, since such a message would never end.
"""

from __future__ import annotations

from sequence_planner.ros.definitions import Definition
from sequence_planner.ros.errors import MessageDefinitionError, nearest
from sequence_planner.ros.fields import field_type

#: Messages within messages: far more than anybody writes, and few enough for every program that walks them.
MAX_DEPTH = 64


def check_references(definitions: list[Definition], standard: set[str]) -> None:
    """Raise MessageDefinitionError for a field of a type nobody defines, and for a message without an end.

    `standard` are the names of the types known beside `definitions`.
    """
    own = {definition.type_name: definition for definition in definitions}
    depths: dict[str, int] = {}  # of what has been visited: how many messages stand within one another

    def visit(definition: Definition, above: tuple[str, ...]) -> int:
        if definition.type_name not in depths:
            depths[definition.type_name] = 1 + visit_fields(definition, above)
        return depths[definition.type_name]

    def visit_fields(definition: Definition, above: tuple[str, ...]) -> int:
        deepest = 0
        for field in definition.fields:
            nested = field_type(field.description)
            if nested.kind != "message":
                continue
            name = nested.type_name
            if name in (*above, definition.type_name):
                chain = " in ".join((name, definition.type_name, *reversed(above)))
                raise MessageDefinitionError(
                    definition.path, field.line, f"a message within itself: {chain}", field.column
                )
            if name in own:
                too_deep = len(above) >= MAX_DEPTH  # Asked before going on, for a long chain has to end somewhere.
                deepest = deepest if too_deep else max(deepest, visit(own[name], (*above, definition.type_name)))
                if too_deep or deepest >= MAX_DEPTH:
                    text = f"more than {MAX_DEPTH} messages within one another"
                    raise MessageDefinitionError(definition.path, field.line, text, field.column)
            elif name not in standard:
                near = nearest(name, {*standard, *own})
                hint = f", did you mean {near}?" if near else ""
                text = f"no message type {name}{hint} (its file belongs below the station's messages folder)"
                raise MessageDefinitionError(definition.path, field.line, text, field.column)
        return deepest

    for definition in definitions:
        visit(definition, ())
