"""Which messages contain which.

A field may hold another message, so a definition is only as good as those it refers to: each must exist, and none may
contain itself, since such a message would never end.
"""

from __future__ import annotations

from sequence_planner.ros.definitions import Definition
from sequence_planner.ros.errors import MessageDefinitionError, nearest
from sequence_planner.ros.fields import field_type


def check_references(definitions: list[Definition], standard: set[str]) -> None:
    """Raise MessageDefinitionError for a field of a type nobody defines, and for a message that contains itself.

    `standard` are the names of the types known beside `definitions`.
    """
    own = {definition.type_name: definition for definition in definitions}

    def visit(definition: Definition, above: tuple[str, ...]) -> None:
        for field in definition.fields:
            nested = field_type(field.description)
            if nested.kind != "message":
                continue
            name = nested.type_name
            if name in (*above, definition.type_name):
                chain = " in ".join((name, definition.type_name, *reversed(above)))
                raise MessageDefinitionError(definition.path, field.line, f"a message within itself: {chain}")
            if name in own:
                visit(own[name], (*above, definition.type_name))
            elif name not in standard:
                near = nearest(name, {*standard, *own})
                hint = f", did you mean {near}?" if near else ""
                text = f"no message type {name}{hint} (its .msg file belongs below the station's messages folder)"
                raise MessageDefinitionError(definition.path, field.line, text)

    for definition in definitions:
        visit(definition, ())
