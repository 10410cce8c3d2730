"""Deployments of the draft: at once, or as soon as the product that is in work is done."""

from __future__ import annotations

import asyncio
import secrets
import shutil
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from pathlib import Path

import structlog
from starlette.concurrency import run_in_threadpool

from sequence_planner.controller.commands.execution import Deploy, SetCycleStop
from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.controller.views.station import StationView
from sequence_planner.core.actor import Actor
from sequence_planner.editor.draft import Draft
from sequence_planner.editor.processes import worked
from sequence_planner.editor.schemas.diff import TransferView
from sequence_planner.editor.schemas.draft import PlannedDeploymentView, RefusalView, RevisionView
from sequence_planner.execution.vocabulary import Mode
from sequence_planner.journal.entry import LONGEST_REASON
from sequence_planner.model.files import Files, write_files
from sequence_planner.process.task import WorkerError
from sequence_planner.server.services.editor import Workshop
from sequence_planner.texts.message import Message, joined, message
from sequence_planner.texts.refused import Refused

LOG = structlog.get_logger(__name__)


@dataclass(frozen=True)
class AskedDeployment:
    """The revision that the draft is, after its change `number`, for whom and why. With `reset` emulated devices and
    the station begin as the model says.
    """

    revision: str
    number: int
    reason: str
    reset: bool
    by: Actor


class DeploymentService:
    """Has the controller behind `client` run the draft of `shop`. Used from one event loop."""

    def __init__(
        self, shop: Workshop, client: ControllerClient, approvers: Callable[[str, Actor], Awaitable[list[str]]]
    ) -> None:
        """Begin with nothing planned; `approvers` tells who has approved a revision for who would deploy it."""
        self.shop = shop
        self._approvers = approvers
        self._client = client
        self._planned: AskedDeployment | None = None
        self._since = 0.0  # when the controller had taken note of that, by the clock of the machine that both share
        self._task: asyncio.Task[None] | None = None

    async def close(self) -> None:
        """Forget what is planned, and end what the workshop does."""
        self._planned = None
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        await self.shop.close()

    async def deploy(self, asked: AskedDeployment, view: StationView) -> None:
        """Let the draft take the place of the model that runs. Raises `Refused` and `WorkerError`."""
        await self._send(asked, *await self._fitting(asked, view))

    async def _fitting(self, asked: AskedDeployment, view: StationView) -> tuple[Draft, RevisionView]:
        draft, known = await self._ready(asked, view)
        fits = await worked("fitted", *await transfer_question(self.shop, view, reset=asked.reset))
        assert isinstance(fits, TransferView)
        if not fits.legal:
            raise Refused("not-legal", _why_not(fits))
        return draft, known

    async def _send(self, asked: AskedDeployment, draft: Draft, known: RevisionView) -> None:
        self.shop.note_deployment(draft)
        staged = self._client.path.parent / f"deploy-{secrets.token_hex(8)}"
        await run_in_threadpool(_stage, draft.files, staged)
        try:
            await self._client.send(
                Deploy(
                    actor=asked.by,
                    reason=asked.reason,
                    revision=known.id,
                    name=known.name,
                    staged=staged.name,
                    reset=asked.reset,
                    approved_by=tuple(known.approved_by),
                )
            )
        finally:
            await run_in_threadpool(shutil.rmtree, staged, True)
        self._planned = None
        self.shop.plan_deployment(None)

    async def deploy_when_done(self, asked: AskedDeployment, view: StationView) -> None:
        """Deploy when the product that is in work is done, for which the station pauses then.

        Raises `Refused` where the draft could not be deployed now either, but for what the station is doing, and where
        the station does not pause then; and `WorkerError`.
        """
        _, known = await self._ready(asked, view)
        holder = view.control
        if holder is None or holder.session != asked.by.session:
            nobody = message("refused.control-needed.nobody")
            why = nobody if holder is None else message("refused.control-needed.holder", holder=holder.name)
            raise Refused("control-needed", why)
        told = f"“{known.name}”: {asked.reason}"[:LONGEST_REASON]  # who sees the pause sees what it is for
        await self._client.send(SetCycleStop(actor=asked.by, reason=told, on=True))
        self._planned, self._since = asked, time.time()
        self.shop.plan_deployment(
            PlannedDeploymentView(
                revision=known.id,
                name=known.name,
                by=asked.by.name,
                since=self._since,
                reason=asked.reason,
                reset=asked.reset,
                refused=None,
            )
        )

    def cancel(self) -> None:
        """Deploy nothing when the product is done; the station pauses then all the same, unless that is taken back."""
        self._planned = None
        self.shop.plan_deployment(None)

    def note_view(self, view: StationView) -> None:
        """Look whether what is planned is due, or will not come about any more."""
        asked, stop = self._planned, view.cycle_stop
        if asked is None or (self._task is not None and not self._task.done()):
            return
        if stop is None:
            if view.time >= self._since:
                self._give_up(Refused("not-paused", message("refused.not-paused.taken-back")))
            return
        if stop.reached and view.mode is Mode.PAUSED and not _runs(view):
            self._task = asyncio.get_running_loop().create_task(self._carry_out(asked, view))

    async def _carry_out(self, asked: AskedDeployment, view: StationView) -> None:
        try:
            draft, known = await self._fitting(asked, view)
            if self._planned is asked:  # nobody has taken it back meanwhile
                await self._send(asked, draft, known)
        except Refused as refused:
            self._give_up(refused)
        except WorkerError as error:
            self._give_up(Refused("worker-failed", str(error), 503))
        except OSError as error:
            LOG.exception("what was planned cannot be deployed")
            self._give_up(Refused("internal-error", str(error), 500))

    def _give_up(self, refused: Refused) -> None:
        """What was planned is not done; it is shown why until something else is planned, or that is put aside."""
        self._planned = None
        shown = self.shop.planned
        if shown is not None:
            told = RefusalView(
                title=str(refused.title),
                title_message=refused.title,
                detail=str(refused.detail),
                detail_message=refused.detail,
            )
            self.shop.plan_deployment(shown.model_copy(update={"refused": told}))

    async def _ready(self, asked: AskedDeployment, view: StationView) -> tuple[Draft, RevisionView]:
        """The draft and its revision, where they may be deployed. Raises `Refused` and `WorkerError`."""
        draft = await draft_after(self.shop, asked.number)
        known = await revision_of(self.shop, asked.revision)
        if not known.draft:
            raise Refused("not-the-draft", message("refused.not-the-draft.take-back"))
        if (hindrance := (await self.shop.checked()).hindrance(draft.number)) is not None:
            raise Refused(hindrance.slug, message("hindrance.why", why=hindrance.why), title=hindrance.title)
        if view.station.deployment_approval == "dual":
            approved = known.approved_by
            known = known.model_copy(update={"approved_by": await self._approvers(known.id, asked.by)})
            _require_approval(known, alone=bool(approved))
        if asked.reset and not view.station.emulated:
            raise Refused("not-emulated", message("refused.not-emulated.reset"))
        return draft, known


async def draft_after(shop: Workshop, number: int) -> Draft:
    """The draft, where its change `number` is the last. Raises `Refused` where it is not, and `WorkerError`."""
    draft = await shop.open()
    if draft.number != number:
        raise Refused("stale-draft", message("refused.stale-draft.look"))
    return draft


async def revision_of(shop: Workshop, id: str) -> RevisionView:
    """The revision with this id. Raises `Refused` where there is none, and `WorkerError`."""
    found = next((each for each in (await shop.revised()).revisions if each.id == id), None)
    if found is None:
        raise Refused("no-revision", message("refused.no-revision.look"), 404)
    return found


def _require_approval(revision: RevisionView, *, alone: bool) -> None:
    """Raises `Refused` where no second person has approved it, or somebody wants changes in it. `alone` says that who
    deploys it has, and nobody else stands for it.
    """
    if wanting := revision.changes_requested_by:
        people = ", ".join(wanting)
        raise Refused("not-approved", message("refused.not-approved.changes", name=revision.name, people=people))
    if not revision.approved_by:
        why = "alone" if alone else "nobody"
        raise Refused("not-approved", message(f"refused.not-approved.{why}", name=revision.name))


async def transfer_question(shop: Workshop, view: StationView, *, reset: bool) -> tuple[object, ...]:
    """Return what `tasks.fitted` is asked about. Raises `WorkerError`."""
    draft = await shop.open()
    present = {name: variable.value for name, variable in view.variables.items()}
    return draft.base, draft.files, shop.folder, present, _runs(view), reset


def _runs(view: StationView) -> list[str]:
    return [name for name, ability in view.abilities.items() if ability.running_since is not None]


def _why_not(fits: TransferView) -> Message:
    if fits.obstacle is not None:
        return message("refused.not-legal.obstacle", why=fits.obstacle)
    if fits.under_way:
        return message("refused.not-legal.under-way", abilities=", ".join(fits.under_way))
    if fits.violated:
        return message("refused.not-legal.violates", specifications=joined(fits.violated))
    return message("refused.not-legal.no-rest")


def _stage(files: Files, folder: Path) -> None:
    folder.mkdir(mode=0o700)
    write_files(files, folder)
