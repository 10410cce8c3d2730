"""What is shown of a check of the draft."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum

from sequence_planner.analysis.document import AnalysisDocument, FindingDocument
from sequence_planner.control.view_part import View

MOST_FINDINGS = 500  # that are shown
MORE = "more"  # the kind of the last of them where there are more


class CheckState(StrEnum):
    """How far a check has come."""

    WAITING = "waiting"
    CHECKING = "checking"
    DONE = "done"
    FAILED = "failed"  # it could not be carried out


class SummaryView(View):
    """How much there is in a model that can be used."""

    title: str
    variables: int
    abilities: int
    operations: int
    specifications: int


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

    @property
    def deployable(self) -> bool:
        """Whether a station may run it: nothing makes it unusable, and there is a supervisor."""
        return (
            self.state is CheckState.DONE
            and all(finding.severity != "error" for finding in self.findings)
            and self.analysis is not None
            and self.analysis.supervised is True
        )


def listed(findings: Sequence[FindingDocument]) -> list[FindingDocument]:
    """Findings as they are shown: the first of very many, errors before others, and in the last place how many more."""
    if len(findings) <= MOST_FINDINGS:
        return list(findings)
    worst = sorted(findings, key=lambda finding: finding.severity != "error")
    shown, left = worst[:MOST_FINDINGS], worst[MOST_FINDINGS:]
    message = f"there are {len(left)} more findings, which are not shown: mend those before this one first"
    return [*shown, left[0].model_copy(update={"kind": MORE, "message": message, "trace": None})]


def waiting(number: int) -> CheckView:
    """Before a check has begun."""
    return CheckView(
        number=number, state=CheckState.WAITING, doing="the check begins", findings=[], summary=None, analysis=None
    )
