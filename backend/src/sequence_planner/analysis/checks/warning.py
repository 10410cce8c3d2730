"""Warnings of the model checks: the conditions of a model, and the names of its parts in a warning."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from sequence_planner.automaton.automaton import Ability, Automaton, State, Turn
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.automaton.lifting.index_folding import IndexFolding
from sequence_planner.automaton.lifting.wording import wording_of
from sequence_planner.language.printer import print_value
from sequence_planner.language.syntax import TRUE, Expression, conjunction
from sequence_planner.language.types import Place
from sequence_planner.synthesis.traces import Trace
from sequence_planner.texts.message import Argument, Message, message

# The conditions of a model, each with what it is and what it depends on.


@dataclass(frozen=True)
class ModelCondition:
    """A condition of the model. Its place is under `key`; without the parts `needs` it means nothing.

    With `old_flags` it is read over new measured values and the flags of the tick before. `so` says what comes of its
    never holding.
    """

    key: str
    what: str
    expression: Expression
    so: str = ""
    needs: tuple[str, ...] = ()
    old_flags: bool = False

    @property
    def name(self) -> str:
        """The name that tells it from all other parts."""
        return f"{self.key}: {self.what}"

    @property
    def family(self) -> str:
        """The name of what was written, for all its ground instances."""
        return without_arguments(self.name)

    @property
    def repeats_an_argument(self) -> bool:
        """True if it is of an instance such as `carry(left, left)`, which is often meant to be impossible."""
        found = re.search(r"\(([^)]*)\)", self.key)
        arguments = found[1].split(", ") if found else []
        return len(set(arguments)) < len(arguments)


def parts(automaton: Automaton) -> Iterator[ModelCondition]:
    """All conditions, those first on which others depend."""
    for ability in automaton.abilities.values():
        yield from _of_ability(ability)
    for effect in automaton.effects:
        ability_name = effect.name.rpartition(".")[0]
        needs = _start_parts(ability_name)
        yield ModelCondition(effect.name, "effect's condition", effect.guard, message("found.so.effect"), needs)
    for operation in automaton.operations.values():
        key, so = f"operation.{operation.name}", message("found.so.inactive")
        written = operation.precondition if operation.written is None else operation.written
        conditions = [ModelCondition(key, "precondition", written, so)]
        for sequence, turn in operation.turns.items():
            both, what = conjunction(written, turn.condition), f"precondition in the sequence `{sequence}`"
            said = turn_in_words(turn)
            so = message("found.so.out-of-turn", operation=operation.name, sequence=sequence, turn=said)
            place_in_it = f"{key}.sequence.{sequence}"
            conditions.append(ModelCondition(place_in_it, what, both, so, (conditions[0].name,)))
        yield from conditions
        active = tuple(each.name for each in conditions)
        yield ModelCondition(key, "goal", operation.goal, message("found.so.incomplete"), active)


def _of_ability(ability: Ability) -> Iterator[ModelCondition]:
    name = ability.name
    needs: tuple[str, ...] = _start_parts(name)
    unstarted = message("found.so.unstarted")
    yield ModelCondition(f"{name}.enabled", "condition", ability.enabled, unstarted)
    if ability.start_guard != TRUE:
        both = conjunction(ability.enabled, ability.start_guard)
        yield ModelCondition(f"{name}.start", "start guard with `enabled`", both, unstarted, needs[:1])
    executing = ModelCondition(f"{name}.executing", "condition", ability.executing, "", needs)
    yield executing
    yield ModelCondition(f"{name}.finished", "condition", ability.finished, "", needs)
    if ability.finish_guard is not None:
        needs = (*needs, executing.name)
        so = message("found.so.unfinished")
        yield ModelCondition(f"{name}.finish", "finish guard", ability.finish_guard, so, needs, True)


def _start_parts(ability: str) -> tuple[str, str]:
    return f"{ability}.enabled: condition", f"{ability}.start: start guard with `enabled`"


def turn_in_words(turn: Turn) -> Message:
    """Tell when it is an operation's turn; it is behind or beside at least one."""
    words = [
        message(f"found.turn.{way}", names=listed(names, most=None))
        for way, names in (("behind", turn.after), ("beside", turn.beside))
        if names
    ]
    return words[0] if len(words) == 1 else message("list.and", most=words[0], last=words[1])


# A suspicion about a model, and how the parts of a model are named in it.

MOST_NAMED = 4  # of several names in a message
LONGEST_QUOTED = 160  # characters of a condition in a message


@dataclass(frozen=True, order=True)
class ModelWarning:
    """The place where something is suspicious, a stable name for what it is, and what to do about it.

    A `trace` shows how it comes about, where there is one to show. `members` are the instances it is about, where it is
    told of several in one.
    """

    place: Place
    kind: str
    message: str
    trace: Trace | None = field(default=None, compare=False)
    members: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{self.place}: warning: {self.message} [{self.kind}]"


def place(automaton: Automaton, *names: str) -> Place:
    """Return where the first of `names` that is known was written; else the beginning of the model."""
    return next((automaton.places[name] for name in names if name in automaton.places), Place(automaton.name, 1, 1))


def families(names: Iterable[str]) -> Mapping[str, tuple[str, ...]]:
    """Ground names by what was written: the instances of `move(p)` under `move`."""
    found: dict[str, list[str]] = defaultdict(list)
    for name in names:
        found[without_arguments(name)].append(name)
    return {family: tuple(members) for family, members in found.items()}


def listed(names: Sequence[str], most: int | None = MOST_NAMED) -> str:
    """Several names, in backticks; of more than `most` only the first are told, and the others on demand."""
    shown = ", ".join(f"`{name}`" for name in names[:most])
    if most is None or len(names) <= most:
        return shown
    return message("found.more", names=shown, count=len(names) - most, rest=[f"`{name}`" for name in names[most:]])


class ToldTogether(NamedTuple):
    """A message about instances, and their names."""

    message: str
    members: tuple[str, ...]


def told_together(automaton: Automaton, messages: Mapping[str, str]) -> list[ToldTogether]:
    """Messages by the names of what they are about: those as one, for all values of an index, that are the same but for
    these values in backticks.
    """
    pieces = {name: message.split("`") for name, message in messages.items()}
    code = {name: tuple(each[1::2]) for name, each in pieces.items()}
    prose = {name: tuple(each[::2]) for name, each in pieces.items()}
    found = []
    for each in IndexFolding(wording_of(automaton)).folded_texts(code, prose):
        first = each.members[0]
        told = list(pieces[first])
        told[1::2] = each.conditions
        said = _with_code(messages[first], dict(zip(code[first], each.conditions, strict=True)), "`".join(told))
        found.append(
            ToldTogether(said if each.over is None else message("found.for", over=each.over, what=said), each.members)
        )
    return found


def _with_code(said: str, code: Mapping[str, str], told: str) -> str:
    """A message with other words in the place of what it has in backticks, as it is `told` in English."""

    def changed(argument: Argument) -> Argument:
        match argument:
            case Message():
                return Message(argument.id, {name: changed(each) for name, each in argument.arguments.items()})
            case str():
                pieces = argument.split("`")
                pieces[1::2] = [code.get(each, each) for each in pieces[1::2]]
                return code.get(argument, "`".join(pieces))
        return argument

    made = changed(said)
    return made if isinstance(made, Message) and made == told else told


def quoted(automaton: Automaton, expression: Expression) -> str:
    """A condition in the words of the model, in backticks; of a long one the first words, since its place has all of
    it.
    """
    return shortened(wording_of(automaton).in_words(expression))


def shortened(text: str) -> str:
    """A condition in backticks, of a long one the first words."""
    if len(text) <= LONGEST_QUOTED:
        return f"`{text}`"
    return f"`{text[:LONGEST_QUOTED].rpartition(' ')[0]} …`"


def described(state: State, names: Iterable[str]) -> str:
    """The values of `names`, as a condition of the language."""
    return " and ".join(f"{name} == {_shown(state, name)}" for name in names)


def _shown(state: State, name: str) -> str:
    value = state[name]
    return "unknown" if value is None else print_value(value)
