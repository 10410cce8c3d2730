"""What is found of a station while it is prepared, and after that while it runs."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import structlog

from sequence_planner.analysis.analysis import FINDINGS, Analysis
from sequence_planner.analysis.document import AnalysisDocument, document_of, error_document
from sequence_planner.analysis.process import SynthesisEndedError, TooLargeError, analysing
from sequence_planner.analysis.remembering import known_supervisor, remember, remembered
from sequence_planner.automaton.state_set import Supervisor
from sequence_planner.automaton.structure import Automaton
from sequence_planner.control.alarm_view import AlarmState, AlarmView, Priority
from sequence_planner.control.commands import CommandRefused
from sequence_planner.control.control_view import ControlView
from sequence_planner.control.controller import Controller
from sequence_planner.control.view import (
    DeploymentView,
    PackML,
    PlanView,
    StandbyView,
    StationIdentity,
    StationStanding,
    StationView,
    TaskView,
)
from sequence_planner.control.vocabulary import Mode, PlanStatus, Production
from sequence_planner.model.source import Finding
from sequence_planner.synthesis.guards import Guard

LOG = structlog.get_logger(__name__)

ANALYSIS_DEADLINE = 120.0  # seconds for all that synthesis finds
PREPARING = "preparing"  # why a command is refused that only comes too early
PUT_OFF = 10.0  # seconds until what is not known from before is looked for: the station begins again first


@dataclass(frozen=True)
class Unusable:
    """A model that means nothing: why, and the folder's name, by which it is called."""

    name: str
    findings: tuple[Finding, ...]


_UNSUPERVISED = AnalysisDocument(
    pending=None,
    supervised=False,
    reachable_states=None,
    supervised_states=None,
    supervised_at_most=None,
    guarded=None,
    guards=None,
    findings=[],
)


class Preparation:
    """What has been found of the station so far; `trouble` if it cannot be run, in particular since its model is
    `unusable`, or `too_large` to find out what is safe.
    """

    def __init__(self, unusable: Unusable | None = None) -> None:
        self.supervisor: asyncio.Future[Supervisor | None] = asyncio.get_running_loop().create_future()
        self.analysis: AnalysisDocument | None = None
        self.trouble: str | None = None
        self.unusable = unusable is not None
        self.too_large = False
        if unusable is not None:
            self.supervisor.set_result(None)
            self.trouble = "; ".join(map(str, unusable.findings))
            findings = [error_document(finding) for finding in unusable.findings]
            self.analysis = _UNSUPERVISED.model_copy(update={"findings": findings})
        self.controller: Controller | None = None
        self._others: str | None = None  # who else commands the devices, while that is waited for
        self._guards: Mapping[str, Guard] = {}

    def take(self, analysis: AnalysisDocument, found: Analysis) -> None:
        """Take note of what has been found by now."""
        self.analysis, self._guards = analysis, found.guards or {}
        if found.supervisor is not None and not self.supervisor.done():
            self.supervisor.set_result(found.supervisor)
        elif found.supervisor is None and found.warnings is not None and not self.supervisor.done():
            self.trouble = "; ".join(warning.message for warning in found.warnings)
            self.supervisor.set_result(None)
        if self.controller is not None:
            self.controller.know(analysis, self._guards)

    def give(self, controller: Controller) -> None:
        """From now on the controller is told what else is found."""
        self.controller = controller
        if self._others is not None:
            controller.wait_to_command()
        if self.analysis is not None:
            controller.know(self.analysis, self._guards)

    def note_others(self, why: str) -> None:
        """Somebody else commands the devices, and is waited for."""
        if self._others != why:
            LOG.warning("the controller waits to command the devices", because=why)
        self._others = why
        if self.controller is not None:
            self.controller.wait_to_command()

    def tasks(self) -> dict[str, TaskView]:
        """The open tasks by now."""
        return {} if self.controller is None else self.controller.view().tasks

    def note_unrecorded(self, why: str | None) -> None:
        """Commands cannot be recorded, for this reason; None when they can again."""
        if self.controller is not None:
            self.controller.note_unrecorded(why)

    def end(self, why: SynthesisEndedError) -> None:
        """No more will be found."""
        if not self.supervisor.done():
            if isinstance(why, TooLargeError):  # a controller that begins anew would come no further
                self.too_large, self.trouble = True, str(why)
                self.analysis = _UNSUPERVISED
                self.supervisor.set_result(None)
            else:
                self.supervisor.set_exception(why)
        if self.analysis is not None:
            self.analysis = self.analysis.model_copy(update={"pending": None})
            if self.controller is not None:
                self.controller.know(self.analysis, self._guards)

    def refusal(self) -> CommandRefused:
        """Why nothing can be commanded yet."""
        if self.unusable:
            return CommandRefused("model-unusable", "The model cannot be used", f"{self.trouble}.")
        if self.too_large:
            return CommandRefused("no-supervisor", "It is not known what is safe", f"{self.trouble}.")
        if self.trouble is not None:
            return CommandRefused("no-supervisor", "The specifications cannot be met", f"{self.trouble}.")
        if self._others is not None:
            return CommandRefused("other-commander", "Somebody else commands the devices", f"{self._others}.")
        return CommandRefused(PREPARING, "The station is being prepared", "Try again in a moment.", 503)


def preparing_view(
    identity: StationIdentity,
    now: float,
    began: float,
    analysis: AnalysisDocument | None,
    trouble: str | None,
    standby: StandbyView | None = None,
    deployment: DeploymentView | None = None,
    *,
    mode: Mode = Mode.AUTOMATIC,
    control: ControlView | None = None,
    unusable: bool = False,
    too_large: bool = False,
) -> StationView:
    """What is shown while the safe set is being computed; with `trouble`, there is none and the station is not run.

    `mode` and `control` are those with which it begins, as far as they are known. It is `unusable` where the model
    means nothing at all, and `too_large` where that set cannot be computed.
    """
    alarms = {}
    if trouble is not None:
        text = "The specifications cannot be met, so nothing is started"
        action = "See why under Check, change the draft of the model, and deploy it."
        if too_large:
            text = f"It is not known what is safe, so nothing is started: {trouble}"
            action = "Let fewer variables bear on the specifications and on `rest` in the draft, and deploy it."
        if unusable:
            text = f"The model cannot be used, so nothing is started: {trouble}"
            action = "Change the draft of the model, or take an older revision back into it, and deploy it."
        alarms["model-unusable" if unusable else "no-supervisor"] = AlarmView(
            priority=Priority.HIGH,
            state=AlarmState.UNACKNOWLEDGED,
            text=text,
            consequence="The station does not run.",
            action=action,
            since=began,
            ended=None,
            by=None,
            until=None,
            why=None,
            count=1,
            parts=[],
        )
    plan = PlanView(
        status=PlanStatus.IDLE,
        reason=_why_no_plan(trouble, unusable=unusable),
        steps=[],
        ticks=0,
        minimal_ticks=False,
        minimal_starts=False,
        replanned=0,
        replacement=None,
        contract=None,
        engine="",
        milliseconds=None,
        why=None,
    )
    return StationView(
        station=identity,
        tick=0,
        time=now,
        revision=0,
        mode=mode,
        packml=PackML.RESETTING,
        standing=StationStanding.PREPARING,
        silent=[],
        failing=[],
        stepping=False,
        production=Production.PREPARING,
        unconfirmed=False,
        undecided={},
        control=control,
        resources={},
        variables={},
        abilities={},
        operations={},
        by_order=False,
        jobs={},
        plan=plan,
        errand=None,
        last_errand=None,
        forces={},
        out_of_service=[],
        questions=[],
        last_correction=None,
        who_can=None,
        approvals={},
        tasks={},
        topics={},
        overrides={},
        alarms=alarms,
        way_back=None,
        analysis=analysis,
        standby=standby,
        deployment=deployment,
    )


def _why_no_plan(trouble: str | None, *, unusable: bool) -> str:
    if trouble is None:
        return "the safe states are being computed"
    return "the model cannot be used" if unusable else "there is no supervisor"


async def analyse(automaton: Automaton, preparation: Preparation, folder: Path) -> None:
    """Have all found that synthesis can find, as long as that takes no unreasonable time.

    What an earlier life of the controller has left of it in `folder`, or a command, is there at once.
    """
    try:
        known = await asyncio.to_thread(_known, automaton, folder)
        if known is not None:
            preparation.take(document_of(automaton, known), known)
            if known.pending is None:
                return
            await asyncio.sleep(PUT_OFF)
        async with asyncio.timeout(ANALYSIS_DEADLINE), analysing(automaton) as finding:
            async for found in finding:
                preparation.take(document_of(automaton, found), found)
                if found.supervisor is not None:
                    await asyncio.to_thread(remember, folder, automaton, found)
    except SynthesisEndedError as ended:
        LOG.error("synthesis ended early", because=str(ended))
        preparation.end(ended)
    except TimeoutError:
        LOG.warning("not all was found of the station", within=ANALYSIS_DEADLINE)
        late = f"the safe states could not be computed within {ANALYSIS_DEADLINE:g} s: let fewer variables bear on "
        late += "them, or have `sequence-planner plan` find them with a longer --deadline before the next start"
        preparation.end(TooLargeError(late))
    except Exception as error:
        LOG.exception("synthesis failed")
        preparation.end(SynthesisEndedError(f"the safe states could not be computed ({type(error).__name__}: {error})"))


def _known(automaton: Automaton, folder: Path) -> Analysis | None:
    """All that an earlier life of the controller has left, or else the supervisor that a command has."""
    known = remembered(folder, automaton, Analysis)
    if known is not None and known.supervisor is not None:
        return known
    supervisor = known_supervisor(automaton)
    return None if supervisor is None else Analysis(FINDINGS, supervisor)
