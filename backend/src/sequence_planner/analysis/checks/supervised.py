"""Checks for what the supervisor makes impossible, and what is impossible anyway in the states that can be reached.

A supervisor may be as permissive as can be and yet leave nothing to do. So it is asked of each ability whether it can
ever start, and of each operation whether it can become active, and then be completed (`docs/semantics.md`).
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence

from sequence_planner.analysis.analysis import QuestionCounts
from sequence_planner.analysis.checks.evidence import Evidence
from sequence_planner.analysis.checks.feasibility import UNKNOWN, FeasibilityFinding, Possibility, Subject
from sequence_planner.analysis.checks.large_reachability import from_afar
from sequence_planner.analysis.checks.reachability import Questions, ReachabilityQuery, bits
from sequence_planner.analysis.checks.unmeetable import never_brought
from sequence_planner.analysis.checks.warning import ModelWarning, listed, place, told_together
from sequence_planner.automaton.automaton import Ability, Automaton
from sequence_planner.automaton.dependencies import read_variables
from sequence_planner.automaton.findings import without_arguments
from sequence_planner.automaton.plain.events import event_of
from sequence_planner.automaton.state_set import StateSet, Supervisor
from sequence_planner.synthesis.supervisor import Supervision
from sequence_planner.synthesis.transition_relation import MOST_BITS, NodeLimit, TooMuchError
from sequence_planner.texts.message import message

MOST_EFFORT = 20_000_000  # nodes, see `synthesis.transition_relation`: a few seconds
MOST_EFFORT_IN_PARTS = 5_000_000
MOST_TOO_WIDE = 3  # parts with too many variables: then no further ones are looked for


class SupervisionQuestion:
    """The questions asked of `automaton` under a `supervision` that is possible, and what has been found by now.

    `evidence` is what answers from afar rest on: of the model before an edit, and after them of this one.
    """

    def __init__(self, automaton: Automaton, supervision: Supervision, evidence: Evidence | None = None) -> None:
        self.evidence = evidence
        self._automaton = automaton
        self._safe = supervision.plant.diagrams.exported(supervision.safe)
        self._subjects = list(subjects_of(automaton))
        self._found: list[FeasibilityFinding] = [FeasibilityFinding(UNKNOWN, subject, "") for subject in self._subjects]

    @property
    def left(self) -> list[Subject]:
        """That of which nothing is known."""
        return [each.subject for each in self._found if each.kind == UNKNOWN]

    @property
    def counts(self) -> QuestionCounts:
        """How many of the questions are answered."""
        found = {each.subject.name for each in self._found}
        left = len(self.left)
        return QuestionCounts(len(self._subjects) - len(found), len(found) - left, left)

    def look(self) -> None:
        """Find out what does not take too much effort."""
        self._found = list(exactly(self._automaton, self._subjects, self._safe))

    def look_far(self, supervisor: Supervisor) -> None:
        """Find out about what is left from afar, which takes longer."""
        left = self.left
        answers = from_afar(self._automaton, left, self._safe, supervisor, known=self.evidence)
        self._found = [*(each for each in self._found if each.kind != UNKNOWN), *answers.findings]
        self.evidence = answers.evidence

    def warnings(self) -> list[ModelWarning]:
        """Return what can never be done, by place, with traces; and what is not known."""
        found = _warnings(self._automaton, self._subjects, _without_consequences(self._found))
        return sorted([*found, *never_brought(self._automaton, self._safe)])


def check_supervision(
    automaton: Automaton, supervision: Supervision, supervisor: Supervisor | None = None
) -> list[ModelWarning]:
    """Return what can never be done in `automaton` under a `supervision` that is possible, by place, with traces.

    What would take too much effort to find out is said not to be known. With its `supervisor` it is then looked at from
    afar, which takes longer.
    """
    asked = SupervisionQuestion(automaton, supervision)
    asked.look()
    if supervisor is not None and asked.left:
        asked.look_far(supervisor)
    return asked.warnings()


def exactly(automaton: Automaton, subjects: Sequence[Subject], safe: StateSet) -> Iterator[FeasibilityFinding]:
    """Yield what is found where all that can be reached is computed, over fewer variables if it must be."""
    try:
        yield from list(_asked(automaton, subjects, safe, NodeLimit(MOST_EFFORT)))
    except TooMuchError:
        yield from _in_parts(automaton, subjects, safe)


def _asked(
    automaton: Automaton, subjects: Sequence[Subject], safe: StateSet, effort: NodeLimit
) -> Iterator[FeasibilityFinding]:
    """Yield what an inquiry about `subjects` says. Raises `TooMuchError`."""
    inquiry = ReachabilityQuery(
        Questions(automaton, [each for subject in subjects for each in subject.expressions], safe), effort
    )
    possibility = Possibility(automaton, inquiry)
    for subject in subjects:
        yield from possibility.findings(subject)


def subjects_of(automaton: Automaton) -> Iterator[Subject]:
    """All that should be possible in it."""
    events: dict[str, list[Ability]] = defaultdict(list)
    for ability in automaton.abilities.values():
        if not ability.restart:
            events[event_of(ability.name) if automaton.one_at_a_time else ability.name].append(ability)
    for event, abilities in events.items():
        first = abilities[0].name
        yield Subject(event, (f"{first}.start", f"{first}.enabled", first), abilities=tuple(abilities))
    for operation in automaton.operations.values():
        yield Subject(operation.name, (f"operation.{operation.name}",), operation=operation)


def _in_parts(automaton: Automaton, subjects: Sequence[Subject], safe: StateSet) -> Iterator[FeasibilityFinding]:
    """Yield what is found on fewer variables at a time, where that is possible."""
    parts: dict[frozenset[str], list[Subject]] = {}
    too_wide = 0
    for subject in subjects:
        read = read_variables(automaton, subject.expressions)
        names = min((names for names in parts if read <= names), key=len, default=None)
        if names is not None and bits(automaton, names) > MOST_BITS:
            names = None
        if names is None and too_wide < MOST_TOO_WIDE:
            names = Questions(automaton, subject.expressions, safe).bearing
            too_wide += bits(automaton, names) > MOST_BITS
        parts.setdefault(frozenset(automaton.variables) if names is None else names, []).append(subject)
    effort = NodeLimit(MOST_EFFORT_IN_PARTS)
    for names, members in sorted(parts.items(), key=lambda part: len(part[0])):
        try:
            if len(parts) == 1 or bits(automaton, names) > MOST_BITS:
                raise TooMuchError
            yield from list(_asked(automaton, members, safe, effort))
        except TooMuchError:
            yield from (FeasibilityFinding(UNKNOWN, each, "") for each in members)


def _without_consequences(found: Sequence[FeasibilityFinding]) -> list[FeasibilityFinding]:
    """Of the findings with one cause only those that are no consequences; or else the one with the shortest way."""
    causes = {each.cause for each in found if not each.consequence}
    kept: list[FeasibilityFinding] = [each for each in found if not each.consequence]
    consequences = [each for each in found if each.consequence]
    for each in sorted(consequences, key=lambda each: 0 if each.trace is None else len(each.trace.steps)):
        if not each.cause or each.cause not in causes:
            kept.append(each)
            causes.add(each.cause)
    return kept


def _warnings(
    automaton: Automaton, subjects: Sequence[Subject], found: Sequence[FeasibilityFinding]
) -> Iterator[ModelWarning]:
    """One for all instances of which the same is said, with the trace of the first."""
    instances = Counter(without_arguments(subject.name) for subject in subjects)
    alike: dict[tuple[str, str], list[FeasibilityFinding]] = defaultdict(list)
    unknown = [each.subject for each in found if each.kind == UNKNOWN]
    if unknown:
        names = listed([subject.name for subject in unknown])
        where = place(automaton, *unknown[0].keys)
        yield ModelWarning(where, UNKNOWN, message("found.too-many-states", names=names))
    for each in (each for each in found if each.kind != UNKNOWN):
        alike[each.kind, without_arguments(each.subject.name)].append(each)
    for (_, family), members in alike.items():
        relative = [each for each in members if each.relative]
        if not len(relative) < instances[family] <= 2 * len(relative):
            yield from _told(automaton, relative)
        yield from _told(automaton, [each for each in members if not each.relative])


def _told(automaton: Automaton, found: Sequence[FeasibilityFinding]) -> Iterator[ModelWarning]:
    """What is said of instances: what they share once, and so what differs in the values of an index only."""
    by_name = {_indexed(each.subject): each for each in found}
    together = told_together(
        automaton,
        {
            name: message("found.subject", subject=f"`{each.subject.name}`", what=each.message)
            for name, each in by_name.items()
        },
    )
    left: dict[str, list[FeasibilityFinding]] = defaultdict(list)
    for told in together:
        first = by_name[told.members[0]]
        if len(told.members) == len(found) > 1 or (len(told.members) > 1 and not first.relative):
            names = tuple(by_name[name].subject.name for name in told.members)
            where = place(automaton, *first.subject.keys)
            yield ModelWarning(where, first.kind, told.message, first.trace, members=names)
        else:
            left["" if first.relative else first.message].append(first)
    for members in left.values():
        first = members[0]
        said = listed([each.subject.name for each in members])
        subject = message("found.each", names=said) if len(members) > 1 else said
        words = message("found.subject", subject=subject, what=first.message)
        yield ModelWarning(place(automaton, *first.subject.keys), first.kind, words, first.trace)


def _indexed(subject: Subject) -> str:
    """The name of a subject as indices know it."""
    return subject.name if subject.operation is None else subject.keys[-1]
