"""What is told of the name under the cursor."""

from __future__ import annotations

from dataclasses import dataclass, replace

from sequence_planner.editor.language.field import FieldKind
from sequence_planner.editor.language.hover import Hover
from sequence_planner.editor.language.schemas import NameKind
from sequence_planner.editor.language.types.places import hover_of_part, text_place
from sequence_planner.editor.symbols.rename import Usage
from sequence_planner.language.printer import print_value
from sequence_planner.language.types import Place
from sequence_planner.language_server.answers.naming import declarations_of, named_in, part_at
from sequence_planner.language_server.documents.cursor import read_at
from sequence_planner.language_server.documents.schemas import DocumentSchemas
from sequence_planner.language_server.snapshot import StationSnapshot

_MOST_VALUES = 20


@dataclass(frozen=True)
class Explanation:
    """What stands from `start` to `end` of a file, told in Markdown. `declared` is where, if that is known."""

    start: int
    end: int
    text: str
    declared: Place | None = None


def explanation(
    snapshot: StationSnapshot, schemas: DocumentSchemas, file: str, text: str, index: int
) -> Explanation | None:
    """Say what stands at a character of a file; None where nothing is to be said of it."""
    cursor = read_at(text, index)
    if cursor is None:
        return None
    place = text_place(snapshot.lexicon, file, cursor.path, cursor.parameters)
    if place is not None and (not cursor.is_name or place.field_kind is FieldKind.OPERATION):
        found = place.hover(str(cursor.text), cursor.offset)
        if found is not None:
            return Explanation(*cursor.span_in_file(found.start, found.end), _told(found), found.place)
    start, end = cursor.span_in_file(0, len(cursor.text))
    if about := schemas.description(file, cursor.path) if cursor.is_name else "":
        return Explanation(start, end, f"`{cursor.text}`: {about}")
    line = text.count("\n", 0, index) + 1
    usage = part_at(named_in(snapshot, file), line, index - text.rfind("\n", 0, index))
    return None if usage is None else _declared(snapshot, usage, text)


def _declared(snapshot: StationSnapshot, usage: Usage, text: str) -> Explanation | None:
    """Say what a part is that is named, or declared, where no condition stands."""
    begin = sum(len(line) + 1 for line in text.split("\n")[: usage.line - 1]) + usage.column - 1
    home = next(declarations_of(snapshot, usage.part), usage)
    place = Place(home.file, home.line, home.column)
    found = hover_of_part(snapshot.lexicon, usage.part.kind, usage.part.full)
    if found is None:
        said = f"**{usage.part.kind.replace('_', ' ')}** `{usage.part.full.rpartition(':')[2]}`"
        return Explanation(begin, begin + usage.length, f"{said}\n\ndeclared in {place.file}:{place.line}", place)
    return Explanation(begin, begin + usage.length, _told(replace(found, place=place)), place)


def _told(found: Hover) -> str:
    kind = found.kind.value if found.kind is not NameKind.ACTIVITY else "operation"
    if (found.part or "").startswith("sequence:"):
        kind = "sequence"
    head = f"**{kind}** `{found.pattern}`"
    if found.type is not None:
        head += f": `{found.type}`"
    lines = [head]
    if found.title:
        lines.append(found.title)
    if found.initial is not None:
        lines.append(f"initially `{print_value(found.initial)}`")
    if found.kind is NameKind.PARAMETER and found.type is not None:
        values = [print_value(each) for each in found.type.domain][: _MOST_VALUES + 1]
        lines.append(
            ", ".join(f"`{each}`" for each in values[:_MOST_VALUES]) + (" …" if len(values) > _MOST_VALUES else "")
        )
    if found.definition is not None and found.definition != found.expansion:
        lines.append(f"is `{found.definition}`")
    if found.expansion is not None:
        lines.append(f"stands for `{found.expansion}`")
    if len(found.names) > 1:
        lines.append("one of " + ", ".join(f"`{each}`" for each in found.names[:_MOST_VALUES]))
    if found.place is not None and found.place.file:
        lines.append(f"declared in {found.place.file}:{found.place.line}")
    return "\n\n".join(lines)
