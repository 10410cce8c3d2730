"""Routes of the model editor: draft, checks, pipelines and language service."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path, Query, Response, WebSocket
from pydantic import Field

from sequence_planner.auth.roles import Role, Scope
from sequence_planner.controller.commands.queries import AskRecord
from sequence_planner.controller.views.details import AutomatonView
from sequence_planner.editor.draft import ChangeBody, FilePath
from sequence_planner.editor.examples.schemas import ExamplesView
from sequence_planner.editor.language.schemas import CompletionView
from sequence_planner.editor.model_graph import GraphView
from sequence_planner.editor.pipelines.schemas import (
    DraftPipelinesView,
    Everything,
    Examples,
    FitsView,
    Fitting,
    PipelineId,
    PipelineQuestion,
    Preview,
    PreviewView,
    RecordedView,
    RunsView,
    Trial,
)
from sequence_planner.editor.processes import (
    FormatView,
    HoverAnswer,
    LanguageQuestionKind,
    PlaceInText,
    ProblemsView,
    TextAt,
)
from sequence_planner.editor.schemas.check import CheckView
from sequence_planner.editor.schemas.draft import (
    DraftChangesView,
    DraftOperationsView,
    DraftPictureView,
    DraftView,
    FilesView,
    FoldsView,
    UsagesView,
)
from sequence_planner.model.paths import EditError
from sequence_planner.server.auth import allowed
from sequence_planner.server.dependencies import (
    JSON_ONLY,
    Actor,
    Body,
    Controller,
    Identity,
    NothingBody,
    UnreadBody,
    found,
    takes,
)
from sequence_planner.server.errors import ProblemFound, refused
from sequence_planner.server.interface import interface
from sequence_planner.server.services.drafts import (
    ExampleName,
    LookedAt,
    TheExamples,
    TheWorkshop,
    begin_with,
    looked_at,
    refusal,
)
from sequence_planner.server.services.reviews import waiting_revision
from sequence_planner.server.stream.endpoints import serve
from sequence_planner.texts.message import message

# The model while it is edited: the draft that all engineers of the station share, and what is found in it.
#
# Nothing of the station that runs is touched by it. What is only read can be asked of an `example` station as well.

Finding = Annotated[int, Path(ge=0, le=2**31)]
AbilityName = Annotated[str, Query(min_length=1, max_length=400)]
FoldMark = Annotated[str, Query(pattern="^[0-9a-f]{8}$")]
FoldName = Annotated[str, Query(min_length=1, max_length=200)]
PartId = Annotated[str, Field(min_length=3, max_length=500)]
VIEWER = allowed(Role.VIEWER, scope=Scope.READ)
ENGINEER = allowed(Role.ENGINEER)

model_router = interface("/model", tags=["model"], responses=refused(409, 503))


class RenameBody(Body):
    """A part of the model by its id, such as `variable:robot.pose`, and what it shall be called."""

    part: PartId
    name: Annotated[str, Field(min_length=1, max_length=200)]


class BeginExampleBody(Body):
    """The draft, after its change `number`, becomes this example; `title` says so in the list of changes."""

    example: Annotated[str, Field(min_length=1, max_length=100)]
    number: Annotated[int, Field(ge=0, le=2**53 - 1, strict=True)]
    title: Annotated[str, Field(min_length=1, max_length=300)]


@model_router.get("", dependencies=[VIEWER], responses=refused(404))
async def draft(shop: LookedAt, actor: Actor) -> DraftView:
    """The draft of the model: its files, and the last changes."""
    return await shop.view(actor)


@model_router.get("/changes", dependencies=[VIEWER])
async def draft_changes(
    shop: TheWorkshop, identity: Identity, controller: Controller, actor: Actor
) -> DraftChangesView:
    """In how many places the draft differs from what runs, and whether it waits for a second person's approval."""
    changes, view = await shop.changes(), controller.view
    if view is None or view.station.deployment_approval != "dual":
        return changes
    return changes.model_copy(update={"waits": await waiting_revision(shop, identity, actor)})


@model_router.get("/files", dependencies=[VIEWER], response_model=FilesView, responses=refused(404))
async def draft_files(shop: LookedAt, path: Annotated[list[FilePath] | None, Query(max_length=500)] = None) -> Response:
    """Files of the draft with what they hold; all of them where no `path` is named."""
    return found(await shop.files(path))


@model_router.get("/check", dependencies=[VIEWER], responses=refused(404))
async def check_model(shop: LookedAt) -> CheckView:
    """Findings in the draft so far."""
    return await shop.checked()


@model_router.get("/check/findings/{finding}/run", dependencies=[VIEWER], responses=refused(404))
async def finding_run(
    shop: LookedAt, finding: Finding, ability: AbilityName, number: Annotated[int, Query(ge=0, le=2**53 - 1)]
) -> list[AutomatonView]:
    """How an ability goes through the run that shows a finding: its automaton in the initial state and after each step.

    The finding is named by its place in the check of the draft after change `number`.
    """
    try:
        return await shop.played(finding, ability, number)
    except EditError as error:
        raise ProblemFound(404, "no-run", message("refused.edit-refused.why", why=error.why)) from error


@model_router.post(
    "/changes",
    dependencies=[ENGINEER],
    response_model=FilesView,
    responses=refused(422),
    openapi_extra=takes(ChangeBody),
)
async def change_draft(body: UnreadBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Carry edits out; the files that are others now.

    An edit of a part that somebody else has changed meanwhile is refused with `part-changed`, and nothing is done.
    """
    try:
        return found(await shop.request(body, actor))
    except EditError as error:
        raise refusal(error) from error


@model_router.post("/rename", dependencies=[ENGINEER, JSON_ONLY], response_model=FilesView, responses=refused(422))
async def rename_part(body: RenameBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Give a part of the model another name, which all that name it follow; the files that are others now."""
    try:
        return found(await shop.rename(body.part, body.name, actor))
    except EditError as error:
        raise refusal(error) from error


@model_router.get("/usages", dependencies=[VIEWER], response_model=UsagesView, responses=refused(404, 422))
async def usages(shop: LookedAt, part: PartId) -> Response:
    """Places where a part of the model, such as `variable:robot.pose`, is named, and those that need it."""
    try:
        return found(await shop.usages(part))
    except EditError as error:
        raise refusal(error) from error


@model_router.get("/graph", dependencies=[VIEWER], response_model=GraphView, responses=refused(404))
async def model_graph(shop: LookedAt) -> Response:
    """The model as a whole: all that has a name, on the layers of the station, and what is tied to what."""
    return found(await shop.tied())


@model_router.get("/operations", dependencies=[VIEWER], response_model=DraftOperationsView, responses=refused(404))
async def draft_operations(shop: LookedAt) -> Response:
    """The operations of the draft: what each begins with and ends with, who does it, and what it comes after."""
    return found(await shop.sequenced())


@model_router.get("/mimic", dependencies=[VIEWER], response_model=DraftPictureView, responses=refused(404))
async def draft_picture(shop: LookedAt) -> Response:
    """The live picture of the draft, drawn as that of the station would be with it."""
    return found(await shop.pictured())


@model_router.get("/folds", dependencies=[VIEWER], response_model=FoldsView, responses=refused(404, 422))
async def folds(shop: LookedAt, fold: FoldMark | None = None, name: FoldName | None = None) -> Response:
    """Ways to say something shorter in the draft that are proven to mean the same; only `fold`, with `name` for what
    it adds, where these are given. Nothing is changed: `POST /model/changes` takes the edits of one.
    """
    try:
        return found(await shop.folded(fold, name))
    except EditError as error:
        raise refusal(error) from error


@model_router.post("/begin", dependencies=[ENGINEER, JSON_ONLY], response_model=FilesView, responses=refused(404, 422))
async def begin_draft(body: BeginExampleBody, shop: TheWorkshop, examples: TheExamples, actor: Actor) -> Response:
    """Let an example station take the place of all that is in the draft, apart from the name of the station; the files
    that are others now. It is one change, which can be undone.

    Refused where somebody has changed the draft since (`stale-draft`).
    """
    try:
        return found(await begin_with(shop, examples, body.example, body.number, body.title, actor))
    except EditError as error:
        raise refusal(error) from error


@model_router.post("/undo", dependencies=[ENGINEER, JSON_ONLY], response_model=FilesView, responses=refused(422))
async def undo_change(body: NothingBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Take back your last change that is not taken back yet; the files that are others now."""
    try:
        return found(await shop.undo(actor))
    except EditError as error:
        raise refusal(error) from error


@model_router.post("/redo", dependencies=[ENGINEER, JSON_ONLY], response_model=FilesView, responses=refused(422))
async def redo_change(body: NothingBody, shop: TheWorkshop, actor: Actor) -> Response:
    """Do again what you took back last; the files that are others now."""
    try:
        return found(await shop.redo(actor))
    except EditError as error:
        raise refusal(error) from error


@model_router.websocket("/stream", dependencies=[VIEWER])
async def stream(websocket: WebSocket, example: ExampleName | None = None) -> None:
    """Serve one client: the draft and its check, whenever they change."""
    shop = await looked_at(websocket, example)
    await shop.open()
    await serve(websocket, shop.latest)


# The example stations.

examples_router = interface("/examples", tags=["model"])


@examples_router.get("", dependencies=[VIEWER])
async def example_stations(examples: TheExamples) -> ExamplesView:
    """Example stations that can be looked at and begun with. Questions about the model name one as `example`."""
    return await examples.overview()


# The pipelines of the draft: their graph, what could be put where, and runs of them. What is edited is edited as the
# rest of the model is, with `POST /model/changes`.

draft_pipelines_router = interface("/model/pipelines", tags=["model"], responses=refused(409, 503))


class RecordBody(Body):
    """Make an example of this name in the draft from the last message of a pipeline."""

    pipeline: PipelineId
    name: Annotated[str, Field(min_length=1, max_length=200)]


@draft_pipelines_router.get("", dependencies=[VIEWER], response_model=DraftPipelinesView, responses=refused(404))
async def draft_pipelines(shop: LookedAt) -> Response:
    """The typed graph of the draft as far as it is sound, and what is wrong with it, where it is wrong."""
    return await _found(shop, Everything())


@draft_pipelines_router.post(
    "/suggestions", dependencies=[VIEWER, JSON_ONLY], response_model=FitsView, responses=refused(404, 422)
)
async def suggest_stages(body: Fitting, shop: LookedAt) -> Response:
    """Suggestions at an edge: kinds of stages, ends of its fields, and further sources of a flow."""
    return await _found(shop, body)


@draft_pipelines_router.post(
    "/preview",
    dependencies=[VIEWER],
    response_model=PreviewView,
    responses=refused(404),
    openapi_extra=takes(Preview),
)
async def preview_pipelines(body: UnreadBody, shop: LookedAt) -> Response:
    """Preview of edits; nothing is changed."""
    return await _found(shop, body)


@draft_pipelines_router.post(
    "/examples", dependencies=[VIEWER, JSON_ONLY], response_model=RunsView, responses=refused(404, 422)
)
async def run_examples(body: Examples, shop: LookedAt) -> Response:
    """Results of a pipeline's examples, with the record at every edge."""
    return await _found(shop, body)


@draft_pipelines_router.post(
    "/test-runs", dependencies=[VIEWER, JSON_ONLY], response_model=RunsView, responses=refused(404, 422)
)
async def run_pipeline_test(body: Trial, shop: LookedAt) -> Response:
    """Results of a message, or of several at given times, with the record at every edge."""
    return await _found(shop, body)


@draft_pipelines_router.post(
    "/recordings", dependencies=[allowed(Role.ENGINEER), JSON_ONLY], status_code=201, responses=refused(422, 504)
)
async def record_example(body: RecordBody, shop: TheWorkshop, client: Controller, actor: Actor) -> RecordedView:
    """Make an example of what the station has heard or said last; it is added to the draft."""
    heard = await client.ask(AskRecord(pipeline=body.pipeline))
    try:
        return await shop.record(body.pipeline, body.name, heard, actor)
    except EditError as error:
        raise refusal(error) from error


async def _found(shop: LookedAt, question: PipelineQuestion | bytes) -> Response:
    try:
        return found(await shop.ask_pipelines(question))
    except EditError as error:
        raise refusal(error) from error


# The language of guards and actions, for whoever writes them: what is wrong, what could stand there, what is meant.

language_router = interface(
    "/model/language",
    tags=["model"],
    dependencies=[allowed(Role.VIEWER, scope=Scope.READ), JSON_ONLY],
    responses=refused(404, 409, 503),
)


@language_router.post("/check", response_model=ProblemsView)
async def check_text(body: TextAt, shop: LookedAt) -> Response:
    """Problems of a text, as the check of the whole draft would find them there."""
    return found(await shop.ask(LanguageQuestionKind.CHECK, body))


@language_router.post("/completion", response_model=CompletionView)
async def complete_text(body: PlaceInText, shop: LookedAt) -> Response:
    """Completions at a place in a text."""
    return found(await shop.ask(LanguageQuestionKind.COMPLETION, body))


@language_router.post("/hover", response_model=HoverAnswer)
async def explain_text(body: PlaceInText, shop: LookedAt) -> Response:
    """Description of the name at a place in a text."""
    return found(await shop.ask(LanguageQuestionKind.HOVER, body))


@language_router.post("/format", response_model=FormatView)
async def format_text(body: TextAt, shop: LookedAt) -> Response:
    """The text as it is written best; one that cannot be read stays as it is."""
    return found(await shop.ask(LanguageQuestionKind.FORMAT, body))
