"""The workshop as routes depend on it: the draft of the station, its versions, the example stations that are looked at
in the same way, and what edits are refused with.
"""

from __future__ import annotations

from functools import partial
from typing import Annotated, NamedTuple

from fastapi import Depends, Query
from fastapi.requests import HTTPConnection

from sequence_planner.controller.ipc import ControllerClient
from sequence_planner.core.actor import Actor
from sequence_planner.editor.draft import PartChangedError
from sequence_planner.model.files import Files
from sequence_planner.model.paths import EditError
from sequence_planner.server.errors import ProblemFound
from sequence_planner.server.recordings.shelf import RecordingShelf
from sequence_planner.server.services.deployments import DeploymentService, revision_of
from sequence_planner.server.services.editor import Workshop
from sequence_planner.server.services.examples import ExampleShelf
from sequence_planner.server.services.identity import IdentityService
from sequence_planner.server.services.reading import ReadableWorkshop
from sequence_planner.server.services.reviews import approvers
from sequence_planner.server.settings import Settings
from sequence_planner.texts.message import message

DRAFT, RUNNING = "draft", "running"
HASH = "[0-9a-f]{40}"
EXAMPLE = "example"  # what a question is about that is not about the draft

ExampleName = Annotated[str, Query(pattern="^[A-Za-z_][A-Za-z0-9_]*$", max_length=100)]


class DraftServices(NamedTuple):
    """The workshop of the server's station with what deploys its draft and a place for recordings, where it knows its
    model; and the example stations.
    """

    shop: Workshop | None
    deployments: DeploymentService | None
    recordings: RecordingShelf | None
    examples: ExampleShelf


def furnish(identity: IdentityService, settings: Settings, client: ControllerClient) -> DraftServices:
    """Make all of it, for the station of the controller behind `client`."""
    shop = Workshop.for_model(identity, settings)
    # Where the launcher keeps what ends with it, however this process ends.
    folder = settings.controller_socket.parent / "recordings"
    recordings = None if shop is None else RecordingShelf(shop, folder, settings.largest_recording)
    deployments = None if shop is None else DeploymentService(shop, client, partial(approvers, shop, identity))
    return DraftServices(shop, deployments, recordings, ExampleShelf(settings.stream, settings.examples))


async def workshop(connection: HTTPConnection) -> Workshop:
    """The workshop of the station. Raises `ProblemFound` where the server does not know its model, or stands by, and
    where something is asked for that cannot be done with an example.

    Who stands by has a folder of its own, which may be older than the draft that all share.
    """
    if EXAMPLE in connection.query_params:
        raise ProblemFound(409, "example-unchanged", message("refused.example-unchanged.begin"))
    client: ControllerClient = connection.app.state.controller
    if client.stands_by:
        raise ProblemFound(503, "on-standby", message("refused.on-standby.model"))
    shop: Workshop | None = connection.app.state.workshop
    if shop is None:
        raise ProblemFound(409, "no-model", message("refused.no-model.start"))
    return shop


TheWorkshop = Annotated[Workshop, Depends(workshop)]


async def recording_shelf(connection: HTTPConnection) -> RecordingShelf:
    """The place for recordings of the station. Raises `ProblemFound` where there is no workshop."""
    await workshop(connection)
    shelf: RecordingShelf = connection.app.state.recordings
    return shelf


TheRecordings = Annotated[RecordingShelf, Depends(recording_shelf)]


async def example_shelf(connection: HTTPConnection) -> ExampleShelf:
    """The example stations."""
    shelf: ExampleShelf = connection.app.state.examples
    return shelf


TheExamples = Annotated[ExampleShelf, Depends(example_shelf)]


async def looked_at(connection: HTTPConnection, example: ExampleName | None = None) -> ReadableWorkshop:
    """The workshop of the station, or of an example where one is named. Raises `ProblemFound` where there is none."""
    if example is None:
        return await workshop(connection)
    shop = await (await example_shelf(connection)).workshop(example)
    if shop is None:
        raise _no_example(example)
    return shop


LookedAt = Annotated[ReadableWorkshop, Depends(looked_at)]


async def begin_with(shop: Workshop, shelf: ExampleShelf, example: str, number: int, title: str, by: Actor) -> str:
    """Let the draft, after its change `number`, become an example; the files that are others now, as JSON.

    Raises `Refused` where there is no such example or the draft is another one, `EditError` and `WorkerError`.
    """
    if (files := await shelf.files_to_begin_with(example)) is None:
        raise _no_example(example)
    return await shop.begin_with(number, files, title, by)


def _no_example(name: str) -> ProblemFound:
    return ProblemFound(404, "no-example", message("refused.no-example.look", name=name))


async def version_files(shop: Workshop, version: str) -> Files:
    """Return the files of the draft, of what runs, or of a revision by its id. Raises `Refused`."""
    if version == DRAFT:
        return (await shop.open()).files
    if version == RUNNING:
        return (await shop.open()).base
    await revision_of(shop, version)
    return await shop.files_of(version)


def refusal(error: EditError) -> ProblemFound:
    """The problem that says why an edit is not made."""
    if isinstance(error, PartChangedError):
        return ProblemFound(409, "part-changed", message("refused.part-changed.why", why=error.why))
    return ProblemFound(422, "edit-refused", message("refused.edit-refused.why", why=error.why))
