"""The things that are shown of a check of the draft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

from sequence_planner.analysis.checks.unmeetable import CANNOT_BE_MET
from sequence_planner.analysis.report import AnalysisDocument, FindingDocument
from sequence_planner.controller.views.part import View
from sequence_planner.core.numerals import counted

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


@dataclass(frozen=True)
class Hindrance:
    """The reason why no station may run a draft: the end of a problem's `type`, a title, and for a person (no full
    stop) why.
    """

    slug: str
    title: str
    why: str


class CheckView(View):
    """What is known of the draft after change `number`; `doing` is what is being looked for, or why nothing is.

    `findings` of severity error make it unusable; `summary` and `analysis` are null where it is.
    """

    number: int
    state: CheckState
    doing: str
    findings: list[FindingDocument]
    summary: SummaryView | None
    analysis: AnalysisDocument | None

    def hindrance(self, number: int) -> Hindrance | None:
        """Say why no station may run the draft after its change `number`; None where one may: nothing makes it
        unusable, and there is a supervisor.
        """
        if self.number == number and self.state is CheckState.FAILED:
            why = f"The draft could not be checked: {self.doing}. Change the draft, then it is checked anew"
            return Hindrance("not-checked", "The draft is not checked", why)
        if self.number != number or self.state is not CheckState.DONE:
            why = "The check of the draft has not ended yet. Try again when it has, as the page Check shows"
            return Hindrance("not-checked", "The draft is not checked", why)
        if errors := [each for each in self.findings if each.severity == "error"]:
            which = "an error" if len(errors) == 1 else f"{len(errors)} errors, the first"
            why = f"The check has found {which} at {_told(errors[0])}. Mend the draft, save it, and deploy that"
            return Hindrance("check-found-errors", "The check has found errors", why)
        if self.analysis is None or self.analysis.supervised is not True:
            because = "".join(f": {_told(each)}" for each in self.findings if each.kind == CANNOT_BE_MET)
            why = f"Nothing of the draft could be started{because}. Mend the draft, save it, and deploy that"
            return Hindrance("no-supervisor", "The draft has no supervisor", why)
        return None


def _told(finding: FindingDocument) -> str:
    return f"{finding.file}:{finding.line}:{finding.column}: {finding.message.rstrip('.')}"


def listed(findings: Sequence[FindingDocument]) -> list[FindingDocument]:
    """Findings as they are shown: the first of very many, errors before others, and in the last place how many more."""
    if len(findings) <= MOST_FINDINGS:
        return list(findings)
    worst = sorted(findings, key=lambda finding: finding.severity != "error")
    shown, left = worst[:MOST_FINDINGS], worst[MOST_FINDINGS:]
    more = counted(len(left), "more finding is", "more findings are")
    message = f"{more} not shown: mend those before this one first"
    return [*shown, left[0].model_copy(update={"kind": MORE, "message": message, "trace": None})]


def waiting(number: int) -> CheckView:
    """Before a check has begun."""
    return CheckView(
        number=number, state=CheckState.WAITING, doing="the check begins", findings=[], summary=None, analysis=None
    )
