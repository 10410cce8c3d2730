"""The things that are shown of a check of the draft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from sequence_planner.analysis.checks.unmeetable import CANNOT_BE_MET
from sequence_planner.analysis.report import AnalysisDocument, FindingDocument
from sequence_planner.controller.views.part import View
from sequence_planner.texts.message import Message, message

MOST_FINDINGS = 500  # that are shown
MORE = "more"  # the kind of the last of them where there are more


class CheckState(StrEnum):
    """Progress of a check."""

    WAITING = "waiting"
    CHECKING = "checking"
    DONE = "done"
    FAILED = "failed"  # it could not be carried out


class SummaryView(View):
    """Sizes of a model that can be used."""

    title: str
    variables: int
    abilities: int
    operations: int
    specifications: int
    examples: int  # of pipelines


class CheckedView(View):
    """What was looked for, with its message for readers of other languages, and how many seconds that took."""

    what: str
    what_message: Message | None
    seconds: float


@dataclass(frozen=True)
class Hindrance:
    """The reason why no station may run a draft: the end of a problem's `type`, a title, and for a person (no full
    stop) why.
    """

    slug: str
    why: Message

    @property
    def title(self) -> Message:
        """The title of the problem."""
        return message(f"hindrance.{self.slug}")


class CheckView(View):
    """What is known of the draft after change `number`; `doing` is what is being looked for, or why nothing is, and
    `doing_message` its message for readers of other languages, null where there is none.

    `findings` of severity error make it unusable; `summary` and `analysis` are null where it is. `looked` is what was
    looked for before that, in its order.
    """

    number: int
    state: CheckState
    doing: str
    doing_message: Message | None
    looked: list[CheckedView]
    findings: list[FindingDocument]
    summary: SummaryView | None
    analysis: AnalysisDocument | None

    def hindrance(self, number: int) -> Hindrance | None:
        """Say why no station may run the draft after its change `number`; None where one may: nothing makes it
        unusable, and there is a supervisor.
        """
        if self.number == number and self.state is CheckState.FAILED:
            said = message("hindrance.not-checked.failed", why=self.doing_message or self.doing)
            return Hindrance("not-checked", said)
        if self.number != number or self.state is not CheckState.DONE:
            return Hindrance("not-checked", message("hindrance.not-checked.yet"))
        if errors := [each for each in self.findings if each.severity == "error"]:
            place, what = _told(errors[0])
            said = message("hindrance.check-found-errors.one", place=place, what=what)
            if len(errors) > 1:
                id_ = "hindrance.check-found-errors.several"
                said = message(id_, count=len(errors), place=place, what=what)
            return Hindrance("check-found-errors", said)
        if self.analysis is None or self.analysis.supervised is not True:
            said = message("hindrance.no-supervisor.mend")
            if (because := next((each for each in self.findings if each.kind == CANNOT_BE_MET), None)) is not None:
                place, what = _told(because)
                said = message("hindrance.no-supervisor.because", place=place, what=what)
            return Hindrance("no-supervisor", said)
        return None


def _told(finding: FindingDocument) -> tuple[str, str]:
    """Where a finding is, and what it says, without a full stop."""
    ends = finding.message.endswith(".")
    said = finding.message.rstrip(".") if ends or finding.said is None else finding.said
    return f"{finding.file}:{finding.line}:{finding.column}", said


def listed(findings: Sequence[FindingDocument]) -> list[FindingDocument]:
    """Findings as they are shown: the first of very many, errors before others, and in the last place how many more."""
    if len(findings) <= MOST_FINDINGS:
        return list(findings)
    worst = sorted(findings, key=lambda finding: finding.severity != "error")
    shown, left = worst[:MOST_FINDINGS], worst[MOST_FINDINGS:]
    more = message("found.hidden", count=len(left))
    return [*shown, left[0].model_copy(update={"kind": MORE, "message": str(more), "said": more, "trace": None})]


def waiting(number: int) -> CheckView:
    """Before a check has begun."""
    said = message("pending.begins")
    return CheckView(
        number=number,
        state=CheckState.WAITING,
        doing=said,
        doing_message=said,
        looked=[],
        findings=[],
        summary=None,
        analysis=None,
    )


def doing(said: str | None) -> dict[str, object]:
    """What changes of a `CheckView` where it does something else; None is nothing."""
    return {"doing": said or "", "doing_message": said if isinstance(said, Message) else None}
