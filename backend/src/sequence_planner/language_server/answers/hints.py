"""What the supervisor adds to the starts of abilities, shown beside them in their documents."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from sequence_planner.analysis.report import GuardDocument
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.core.numerals import counted
from sequence_planner.editor.symbols.texts import ModelContent, entry, pairs
from sequence_planner.model.source import SourceText

_LONGEST = 120  # characters of a guard in a line; all of it is in what is shown with it


class GuardHint(NamedTuple):
    """A hint at the end of a line, counted from 1, and all that there is to say in Markdown."""

    line: int
    label: str
    about: str


def guard_hints(
    content: ModelContent, text: str, file: str, guards: Mapping[str, GuardDocument]
) -> Iterator[GuardHint]:
    """Yield the hints of the document of a resource or a type, which is `text`: each at the `start` of an ability, or
    at its name if it has none. In a type they are those of all its instances.
    """
    by_ability: dict[str, list[tuple[str, GuardDocument]]] = {}
    for name, guard in guards.items():
        for start in guard.starts or [name]:
            by_ability.setdefault(without_arguments(start), []).append((start, guard))
    owners = [(resource, at) for resource, at, _ in content.resources() if content.is_made_of(at, file)]
    for name, ability in pairs(entry(ModelContent({file: text}).get(file), "abilities")):
        restricted: list[str] = []
        found: list[tuple[str, GuardDocument]] = []
        for resource, at in owners:
            own = by_ability.get(f"{resource}.{content.made_path(at, file, ('abilities', str(name)))[-1]}", [])
            restricted += [resource] if own else []
            found += own
        if found:
            yield _hint(_line(name, ability), found, restricted if len(restricted) < len(owners) else [])


def _line(name: SourceText, ability: object) -> int:
    return next((key.place.line for key, _ in pairs(ability) if key == "start"), name.place.line)


def _hint(line: int, found: list[tuple[str, GuardDocument]], only: list[str]) -> GuardHint:
    """The hint for these starts; `only` names the instances that are restricted where others are not."""
    texts = [_said(guard) for _, guard in found]
    who = f"supervisor, in {' and '.join(only)}" if only else "supervisor"
    if len(set(texts)) == 1:
        label = f"{who}: {texts[0]}"
    else:
        label = f"{who}: {counted(len(found), 'guard')}, as `{found[0][0]}`: {texts[0]}"
    label = label if len(label) <= _LONGEST else f"{label[: _LONGEST - 1]}…"
    return GuardHint(line, label, "\n\n".join(_about(start, guard) for start, guard in found))


def _said(guard: GuardDocument) -> str:
    if guard.guard is not None:
        return guard.guard
    return f"not {guard.blocked[0]} …" if guard.blocked else "it depends on the state"


def _about(start: str, guard: GuardDocument) -> str:
    lines = [f"The supervisor lets `{start}` start only while"]
    if guard.guard is not None:
        lines.append(f"`{guard.guard}`")
    else:
        lines[0] = f"The supervisor does not let `{start}` start where"
        lines += [f"- `{each}`" for each in guard.blocked]
    why = [f"`{each}`" for each in guard.specifications]
    if guard.rest:
        why.append("the states of rest, which must stay reachable")
    if why:
        lines.append("because of " + " and ".join(why))
    return "\n\n".join(lines)
