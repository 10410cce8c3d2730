"""The findings about a model, as one JSON document: what programs and pages are given, and what is kept."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from sequence_planner.analysis.guard_documents import Document, GuardDocument, LiftedGuard
from sequence_planner.automaton.automaton import Automaton
from sequence_planner.language.printer import print_expression
from sequence_planner.model.source import Finding, alike_in_types, in_instances
from sequence_planner.texts.message import Message

if TYPE_CHECKING:
    from sequence_planner.analysis.analysis import Analysis
    from sequence_planner.analysis.checks.warning import ModelWarning
    from sequence_planner.synthesis.guards import SupervisorGuard
    from sequence_planner.synthesis.traces import Trace

Value = bool | int | str

# How findings say what to write in place of what stands there; `language.resolver` words most of them.
_MEANT = re.compile(r"did you mean `([^`]+)`\?")
_BESIDE = re.compile(r"a value stands beside its variable, as in `([^`]+)`")
_ONE_OF = re.compile(r"; write (?:one of )?([A-Za-z_][\w.()\[\]]*(?:(?:, | or )[A-Za-z_][\w.()\[\]]*)*)$")
_NAMED = re.compile(r"`([^`]+)`")
_MOST_CHOICES = 5


class StepDocument(Document):
    """A step of a trace: what happens (`kind` and `names`), what changes, and the specifications that forbid the state
    after it; `text` says it in a line.
    """

    kind: str
    names: list[str]
    finished: list[str]
    changes: dict[str, Value]
    forbidden_by: list[str]
    text: str


class TraceDocument(Document):
    """A run from an initial state, which the specifications `forbidden_by` forbid; null is unknown."""

    initial: dict[str, Value | None]
    forbidden_by: list[str]
    steps: list[StepDocument]


class FixDocument(Document):
    """Write `now` in place of the first `was` in the line of a finding, from its column on. It `is_sure` where nothing
    else is offered.
    """

    was: str
    now: str
    is_sure: bool


class FindingDocument(Document):
    """Something suspicious, where it is written, and a run that shows it. Where it is said of several instances in one,
    as in `for all pair in bolt_pair`, or of a type, `members` are these, and the run is that of the first. `said` is
    the message for readers of other languages, null where there is none. `fixes` are texts to be written in place of
    what it is about, as it says itself.
    """

    severity: str
    kind: str
    file: str
    line: int
    column: int
    message: str
    said: Message | None
    members: list[str]
    trace: TraceDocument | None
    fixes: tuple[FixDocument, ...] = ()


class AnalysisDocument(Document):
    """An `Analysis`: what is null has not been computed, or there is none.

    `supervised` says whether there is a supervisor. Where the states that are reached with it are not counted, they are
    no more than `supervised_at_most`. `pending` is what is being computed, and its message for readers of other
    languages. `guarded` are the abilities that it restricts, and `guards` what it
    adds to them, by ability, and in a plain automaton by event; `lifted` are these as they are told to people.
    """

    pending: str | None
    pending_message: Message | None
    supervised: bool | None
    reachable_states: int | None
    supervised_states: int | None
    supervised_at_most: int | None
    guarded: list[str] | None
    guards: dict[str, GuardDocument] | None
    lifted: list[LiftedGuard] | None
    findings: list[FindingDocument] | None


def document_of(automaton: Automaton, analysis: Analysis) -> AnalysisDocument:
    """Return what was found of `automaton`."""
    from sequence_planner.analysis.lifted import lifted_guards  # noqa: PLC0415 (what is kept is told without it)

    warnings = analysis.warnings
    guards = None if analysis.guards is None else {name: _guard(guard) for name, guard in analysis.guards.items()}
    return AnalysisDocument(
        pending=analysis.pending,
        pending_message=analysis.pending,
        supervised=True if analysis.supervisor is not None else None if analysis.warnings is None else False,
        reachable_states=analysis.reachable_states,
        supervised_states=analysis.supervised_states,
        supervised_at_most=analysis.supervised_at_most,
        guarded=None if analysis.guarded is None else list(analysis.guarded),
        guards=guards,
        lifted=None if guards is None else lifted_guards(automaton, guards),
        findings=None if warnings is None else findings_of(automaton, warnings),
    )


def findings_of(
    automaton: Automaton, warnings: Iterable[ModelWarning], written: Iterable[ModelWarning] = ()
) -> list[FindingDocument]:
    """The warnings of a model that can be used, those of its automaton and those of what is `written`. What is so of
    one place in both is said in the words that stand there. What is so in several instances of a type is said once of
    all of them, and its run is that of the first.
    """
    as_written = list(written)
    said = {(each.place._replace(instance=""), each.kind) for each in as_written}
    found = [each for each in warnings if (each.place._replace(instance=""), each.kind) not in said]
    alike = alike_in_types([*found, *as_written], lambda each: Finding(each.place, each.message))
    return [_told(automaton, each) for each in alike]


def _told(automaton: Automaton, alike: Sequence[ModelWarning]) -> FindingDocument:
    first, *others = alike
    members = [name for each in alike for name in each.members]
    if others and not members:
        members = [each.place.instance.partition(" ")[0] for each in alike if each.place.instance]
    words = in_instances([each.place for each in alike], first.message)
    return FindingDocument(
        severity="warning",
        kind=first.kind,
        file=first.place.file,
        line=first.place.line,
        column=first.place.column,
        message=words,
        said=_as_message(words),
        members=members,
        trace=None if first.trace is None else trace_document(automaton, first.trace),
        fixes=tuple(fixes_of(words)),
    )


def culprit(text: str) -> str | None:
    """What is wrong as it is written, where the text of a finding says so."""
    named: list[str] = _NAMED.findall(text.partition(";")[0])
    return named[-1] if named else None


def fixes_of(text: str) -> Iterator[FixDocument]:
    """Yield what would mend a finding with this text, in English."""
    was = culprit(text)
    if was is None:
        return
    if found := _MEANT.search(text) or _BESIDE.search(text):
        yield FixDocument(was=was, now=found[1], is_sure=True)
    elif found := _ONE_OF.search(text):
        choices = re.split(r", | or ", found[1])
        for choice in choices[:_MOST_CHOICES]:
            yield FixDocument(was=was, now=choice, is_sure=len(choices) == 1)


def _as_message(words: str) -> Message | None:
    return words if isinstance(words, Message) else None


def error_document(finding: Finding) -> FindingDocument:
    """Something that makes a model unusable."""
    return FindingDocument(
        severity="error",
        kind="unusable",
        file=finding.place.file,
        line=finding.place.line,
        column=finding.place.column,
        message=finding.message,
        said=_as_message(finding.message),
        members=[],
        trace=None,
        fixes=tuple(fixes_of(finding.message)),
    )


def _guard(guard: SupervisorGuard) -> GuardDocument:
    return GuardDocument(
        guard=None if guard.expression is None else print_expression(guard.expression),
        literals=guard.literals,
        starts=list(guard.starts),
        specifications=list(guard.specifications),
        rest=guard.rest,
        blocked=list(map(print_expression, guard.blocked)),
    )


def trace_document(automaton: Automaton, trace: Trace) -> TraceDocument:
    """A trace as JSON."""
    return TraceDocument(
        initial={name: trace.initial[name] for name in automaton.variables},
        forbidden_by=list(trace.forbidden_by),
        steps=[
            StepDocument(
                kind=step.kind.value,
                names=list(step.names),
                finished=list(step.finished),
                changes=dict(step.changes),
                forbidden_by=list(step.forbidden_by),
                text=line,
            )
            for step, line in zip(trace.steps, trace.lines(), strict=True)
        ],
    )
