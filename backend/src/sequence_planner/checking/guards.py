"""Conditions that cannot hold, or always do: by their own words, or because nothing ever brings them about.

Of the instances of something with parameters, all are reported under one name. When only some cannot hold but most can,
they are named, except those with one argument twice (`carry(left, left)`); when most cannot, the parameters are seen as
choosing which instances there are. What only follows from another finding is left out, and so is what was written
as `true` or `false`, or became so by the values of its parameters.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import combinations

from sequence_planner.automaton.structure import Automaton
from sequence_planner.checking.growth import Growth
from sequence_planner.checking.parts import Part, parts
from sequence_planner.checking.satisfiability import Question, Shape, UndecidedError, can_be_asked, shape
from sequence_planner.checking.warning import ModelWarning, listed, place
from sequence_planner.expressions.printing import print_expression
from sequence_planner.expressions.syntax import FALSE, Constant, Expression, conjunction, conjuncts


def check_guards(automaton: Automaton) -> Iterator[ModelWarning]:
    """All conditions of `automaton` that are no conditions."""
    everything = list(parts(automaton))
    written = [part for part in everything if not isinstance(part.expression, Constant)]
    reporting = _Reporting(automaton, everything)
    never, always = _constant(automaton, written)
    for part, others in reporting.worth_saying(always, instances=False):
        text = print_expression(part.expression)
        message = f"`{text}` always holds, whatever the values of its variables: leave it out, or write what was meant"
        yield reporting.warning("always-holds", part, others, message)
    for part, others in reporting.worth_saying(never):
        message = f"{_contradiction(automaton, part)}{_so(part)}: write what was meant"
        yield reporting.warning("never-holds", part, others, message)
    reporting.dead |= {part.name for part in never}
    for growth in (Growth(automaton, any_measurement=True), Growth(automaton, any_measurement=False)):
        left = [part for part in written if part.name not in reporting.dead]
        stuck = [part for part in left if not growth.may(part.expression)]
        for part, others in reporting.worth_saying(growth.roots(stuck, reporting.dead)):
            kind, message = _stuck(growth, part)
            yield reporting.warning(kind, part, others, message)
        reporting.dead |= {part.name for part in stuck}


class _Reporting:
    """Chooses what is said of many instances. `dead` are the parts that never hold, by name."""

    def __init__(self, automaton: Automaton, everything: Iterable[Part]) -> None:
        self._automaton = automaton
        self._families: dict[str, list[Part]] = defaultdict(list)
        self.dead: set[str] = set()
        for part in everything:
            self._families[part.family].append(part)
            if part.expression == FALSE:
                self.dead.add(part.name)

    def worth_saying(self, found: Collection[Part], instances: bool = True) -> Iterator[tuple[Part, Sequence[Part]]]:
        """A part of each family, and those of its instances that are meant; none stands for all of them.

        With `instances` also those families of which only some are `found`.
        """
        of_family: dict[str, list[Part]] = defaultdict(list)
        found_names = {part.name for part in found}
        for part in found:
            if not any(need in self.dead or need in found_names for need in part.needs):
                of_family[part.family].append(part)
        for family, members in of_family.items():
            written = self._families[family]
            if len(members) == len(written):
                yield next((part for part in members if not part.repeats_an_argument), members[0]), ()
            elif instances and 2 * len(members) < len(written):
                named = [part for part in members if not part.repeats_an_argument]
                if named:
                    yield named[0], named

    def warning(self, kind: str, part: Part, instances: Sequence[Part], message: str) -> ModelWarning:
        """What is said of `part`, or of some `instances`."""
        some = f"of {listed([each.key for each in instances])}: " if len(self._families[part.family]) > 1 else ""
        where = place(self._automaton, part.key, part.key.rpartition(".")[0])
        return ModelWarning(where, kind, f"{some if instances else ''}{message}")


def _constant(automaton: Automaton, written: Iterable[Part]) -> tuple[list[Part], list[Part]]:
    """The parts that hold for no values of their variables, and those that hold for all."""
    never: list[Part] = []
    always: list[Part] = []
    answers: dict[tuple[bool, Shape], tuple[bool, bool]] = {}
    for part in written:
        key = (part.old_flags, shape(automaton, part.expression))
        if key not in answers:
            answers[key] = _can_hold_and_fail(automaton, part)
        holds, fails = answers[key]
        if not holds:
            never.append(part)
        elif not fails:
            always.append(part)
    return never, always


def _can_hold_and_fail(automaton: Automaton, part: Part) -> tuple[bool, bool]:
    """Whether some state satisfies a part, and whether some does not; both where it is too hard to tell."""
    if not can_be_asked(automaton, part.expression):
        return True, True
    question = Question(automaton)
    before = question.state()
    literal = question.reading.truth(part.expression, question.sensed(before) if part.old_flags else before).yes
    try:
        holds, fails = question.models(literal, -literal)
    except UndecidedError:
        return True, True
    return holds is not None, fails is not None


def _contradiction(automaton: Automaton, part: Part) -> str:
    """Which words of a part exclude each other."""
    few: list[tuple[Expression, ...]] = [(each,) for each in conjuncts(part.expression)]
    few += combinations(conjuncts(part.expression), 2)
    for words in few:
        piece = Part(part.key, part.what, conjunction(*words), old_flags=part.old_flags)
        if _constant(automaton, [piece])[0]:
            texts = [f"`{print_expression(word)}`" for word in words]
            return f"{texts[0]} never holds" if len(texts) == 1 else f"{' and '.join(texts)} exclude each other"
    return f"`{print_expression(part.expression)}` never holds"


def _stuck(growth: Growth, part: Part) -> tuple[str, str]:
    """What is said of a part that nothing brings about."""
    lacking = [f"`{print_expression(each)}`" for each in conjuncts(part.expression) if not growth.may(each)]
    what = " and ".join(lacking)
    if growth.any_measurement:
        return "unreachable", (
            f"nothing ever makes {what} true, neither an action nor a message{_so(part)}: "
            "write what was meant, or the action that is missing"
        )
    if part.what == "effect's condition":
        return "effect-never-happens", (
            f"nothing ever makes {what} true, so this effect never happens: no output and no other effect leads to it"
        )
    return "nothing-brings-about", (
        f"no effect brings about {what}{_so(part)} in any plan: write the effect with which the device does it"
    )


def _so(part: Part) -> str:
    return f", {part.consequence}" if part.consequence else ""
