"""The lease of the command in the life of a controller, and what is told of it."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator
from pathlib import Path

import structlog

from sequence_planner.controller.commands.command import CommandRefused
from sequence_planner.controller.preparation import DeployedError, Preparation
from sequence_planner.controller.views.station import StandbyView
from sequence_planner.core.storage_error import StorageError
from sequence_planner.journal.last_accepted import LastEnding
from sequence_planner.standby.lease import Lease, LeaseKeeper, digest_of, open_lease
from sequence_planner.texts.message import message

LOG = structlog.get_logger(__name__)


@contextlib.asynccontextmanager
async def held_lease(
    database: str, name: str, model: Path, ended: LastEnding, preparation: Preparation
) -> AsyncIterator[LeaseKeeper]:
    """Yield what keeps the lease for the station `name`; it is let go of at the end.

    `ended` is how the last life has ended as far as this station knows: others may take over from it by themselves
    where that is certain.
    """
    lease = open_lease(database, name, digest_of(model))
    await asyncio.to_thread(_tell, lease, ended)
    keeper, deployed = LeaseKeeper(lease), False
    keeper.start()
    try:
        yield keeper
    except DeployedError:
        deployed = True
        raise
    finally:
        recorded = None if preparation.controller is None else preparation.controller.records.is_durable
        await keeper.end(deployed=deployed, settled=keeper.settled_before if recorded is None else recorded)


def _tell(lease: Lease, ended: LastEnding) -> None:
    """Tell the others what only this station knows of an earlier process of its own."""
    epoch = None if ended.life is None else ended.life.epoch
    if epoch is None:
        return
    if not ended.is_certain:
        lease.unsettled = epoch
        return
    try:
        lease.settle(epoch)
    except StorageError as error:
        LOG.warning("others are not told that all is recorded", because=str(error))


def standby_view(keeper: LeaseKeeper) -> StandbyView:
    """Return what is shown of it."""
    standing = keeper.standing
    return StandbyView(
        name=standing.name,
        active=standing.active,
        holder=standing.holder,
        standing_by=list(standing.standing_by),
        trouble=standing.trouble,
    )


def stands_by(keeper: LeaseKeeper) -> CommandRefused:
    """Return why a station that does not hold the lease carries nothing out."""
    holder = keeper.standing.holder
    if keeper.standing.active:
        why = keeper.standing.trouble or "the database is slow"
        return CommandRefused("lease-not-renewed", message("refused.lease-not-renewed.why", why=why), 503)
    if holder is None or holder == keeper.standing.name:
        return CommandRefused("on-standby", message("refused.on-standby.other"), 503)
    return CommandRefused("on-standby", message("refused.on-standby.holder", holder=holder), 503)
