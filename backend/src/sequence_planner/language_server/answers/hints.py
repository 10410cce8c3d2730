"""What the supervisor adds to the starts of abilities, shown beside them in their documents."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from sequence_planner.analysis.guard_documents import LiftedGuard
from sequence_planner.analysis.report import AnalysisDocument
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.editor.symbols.texts import ModelContent, entry, pairs
from sequence_planner.model.source import SourceText

_LONGEST = 120  # characters of a guard in a line; all of it is in what is shown with it


class GuardHint(NamedTuple):
    """A hint at the end of a line, counted from 1, and all that there is to say in Markdown."""

    line: int
    label: str
    about: str


def guard_hints(content: ModelContent, text: str, file: str, analysis: AnalysisDocument) -> Iterator[GuardHint]:
    """Yield the hints of the document of a resource or a type, which is `text`: each at the `start` of an ability, or
    at its name if it has none. In a type they are those of all its instances.
    """
    by_ability: dict[str, list[LiftedGuard]] = {}
    for guard in analysis.lifted or ():
        for family in dict.fromkeys(map(without_arguments, guard.starts or [guard.name])):
            by_ability.setdefault(family, []).append(guard)
    written_out = {name: guard.guard for name, guard in (analysis.guards or {}).items()}
    owners = [(resource, at) for resource, at, _ in content.resources() if content.is_made_of(at, file)]
    for name, ability in pairs(entry(ModelContent({file: text}).get(file), "abilities")):
        restricted: list[str] = []
        found: list[LiftedGuard] = []
        for resource, at in owners:
            own = by_ability.get(f"{resource}.{content.made_path(at, file, ('abilities', str(name)))[-1]}", [])
            restricted += [resource] if own else []
            found += own
        if found:
            only = restricted if len(restricted) < len(owners) else []
            yield _hint(_line(name, ability), found, only, written_out)


def _line(name: SourceText, ability: object) -> int:
    return next((key.place.line for key, _ in pairs(ability) if key == "start"), name.place.line)


def _hint(
    line: int, guards: Sequence[LiftedGuard], only: Sequence[str], written_out: Mapping[str, str | None]
) -> GuardHint:
    """The hint for these guards; `only` names the instances that are restricted where others are not."""
    first = guards[0]
    text = _said(first)
    who = f"supervisor, in {' and '.join(only)}" if only else "supervisor"
    some = "" if {_said(each) for each in guards} == {text} else f"{len(guards)} guards, as `{first.name}`: "
    over = "" if first.index is None else f", for {first.index}"
    most = _LONGEST - len(f"{who}: {some}{over}")
    label = f"{who}: {some}{text if len(text) <= most else f'{text[: most - 1]}…'}{over}"
    return GuardHint(line, label, "\n\n".join(_about(guard, written_out) for guard in guards))


def _said(guard: LiftedGuard) -> str:
    if guard.guard is not None:
        return guard.guard
    return f"not {guard.blocked[0]} …" if guard.blocked else "it depends on the state"


def _about(guard: LiftedGuard, written_out: Mapping[str, str | None]) -> str:
    """What is said of a guard, and each that it stands for, written out."""
    name = f"`{guard.name}`" if guard.index is None else f"`{guard.name}`, for {guard.index},"
    lines = [f"The supervisor lets {name} start only while"]
    if guard.guard is not None:
        lines.append(f"`{guard.guard}`")
    else:
        lines[0] = f"The supervisor does not let {name} start where"
        lines += [f"- `{each}`" for each in guard.blocked]
    why = [f"`{each}`" for each in guard.specifications]
    if guard.rest:
        why.append("the states of rest, which must stay reachable")
    if why:
        lines.append("because of " + " and ".join(why))
    meant = {start: text for start in guard.starts if (text := written_out.get(start)) not in (None, guard.guard)}
    return "\n\n".join([*lines, *(f"`{start}`: `{text}`" for start, text in meant.items())])
