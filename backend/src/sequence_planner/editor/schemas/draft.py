"""View schemas of the draft: files, changes, usages and revisions, and the reader of its files."""

from __future__ import annotations

import json
from collections import OrderedDict
from collections.abc import Iterable, Sequence
from enum import StrEnum

from pydantic import Field, JsonValue

from sequence_planner.analysis.report import FindingDocument, error_document
from sequence_planner.automaton.automaton import GroupKind
from sequence_planner.automaton.sequences.order import LinkKind
from sequence_planner.controller.views.part import Value, View
from sequence_planner.editor.draft import ChangeKind, Differences, Draft, DraftChange, Edit, digest
from sequence_planner.editor.merging import rewritten
from sequence_planner.editor.revision import Revision
from sequence_planner.editor.schemas.check import CheckView
from sequence_planner.editor.talk.approval import standing_verdicts
from sequence_planner.editor.talk.comments import Comment, Verdict
from sequence_planner.mimic.views import MimicView
from sequence_planner.model.files import is_binary
from sequence_planner.model.source import ModelError
from sequence_planner.model.yaml.content import plain
from sequence_planner.model.yaml.reader import read_text
from sequence_planner.texts.message import Message

# What is shown of the draft.


class FileState(StrEnum):
    """Difference of a draft's file from that of the station."""

    SAME = "same"
    CHANGED = "changed"
    NEW = "new"
    REMOVED = "removed"


class FileMark(View):
    """A file of the draft; `digest` is another one as soon as its text is, and null where it was taken away."""

    digest: str | None
    state: FileState


class FileView(View):
    """A file of the draft: its text, and what it holds where that can be read; else `wrong` says why not.

    `content` is null for what is no YAML.
    """

    path: str
    digest: str
    text: str
    content: JsonValue
    wrong: FindingDocument | None


class ChangedLinesView(View):
    """Lines of a file, from the `line` on that counts from 1 in the file after the change: what they were, null where
    they are new, and what they are, null where they are gone.
    """

    file: str
    line: int
    was: str | None
    now: str | None


class ChangeView(View):
    """A change of the draft; `of` is the number of the one that it undoes or does again. Time is in seconds since the
    epoch. `places` are the lines that it changed, cut where they are many; of a change long ago there are none.
    """

    number: int
    time: float
    by: str
    kind: ChangeKind
    of: int | None
    title: str
    places: list[ChangedLinesView]


class DraftView(View):
    """The draft after its change `number`: its files by path, and its last changes, newest first.

    `undo` and `redo` are the titles of what whoever asks could take back, or do again.
    """

    number: int
    files: dict[str, FileMark]
    changes: list[ChangeView]
    undo: str | None
    redo: str | None


class FilesView(View):
    """Files of the draft after its change `number`, by path; null is one that is not there."""

    number: int
    files: dict[str, FileView | None]


class UsageView(View):
    """A place at which a part is named, `length` characters from line and column on, which count from 1; `used_by` says
    by what. `declares` it says of the place where the part itself is written.
    """

    part: str
    file: str
    path: list[str | int]
    line: int
    column: int
    length: int
    written: str
    used_by: str
    declares: bool


class UsagesView(View):
    """Places where a part is named, and those of them outside of it that could not be without it.

    `unwritten` are entries that use it though nothing in them names it, such as a topic whose message has a field of
    that name; they stand at their own names. `unread` are texts that make no sense and hold the name, and files that
    cannot be read; `bound` says why the name is not the model's alone.
    """

    usages: list[UsageView]
    unwritten: list[UsageView]
    dependants: list[UsageView]
    unread: list[FindingDocument]
    bound: str | None


class DraftPictureView(View):
    """The picture of the draft after change `number`, as Operate would show it, and the titles of its resources.

    `digest` is that of the `mimic.yaml` it was made with, null where there is none; then `file` is the text of one that
    draws the same. Of a draft that is not `usable` there is no picture.
    """

    number: int
    usable: bool
    digest: str | None
    picture: MimicView | None
    titles: dict[str, str]
    file: str | None


class OperationConditionView(View):
    """A part of a condition: as an expression, and as a sentence."""

    text: str
    sentence: Message


class DraftOperationView(View):
    """An operation of the draft: the one that is written under `entry`, for these values of its parameters.

    `lane` is the resource that does most to bring about its goal, null where it is the station. `begins` are the parts
    of the precondition that is written, `turns` what sequences add to it, and `goal` those of its goal. `line` counts
    from 1.
    """

    title: str
    entry: str
    arguments: list[str]
    lane: str | None
    begins: list[OperationConditionView]
    turns: list[OperationConditionView]
    goal: list[OperationConditionView]
    repeat: bool
    file: str
    line: int


class OperationReasonView(View):
    """Why an operation comes after another: the `name` of a sequence or work master says so, or it begins with a
    `condition` that the goal of the other makes true, or, by chance, can make true.
    """

    kind: LinkKind
    name: str
    condition: OperationConditionView | None


class OperationLinkView(View):
    """That an operation comes `after` another. With `again` it does for what was done in the round before."""

    before: str
    after: str
    reasons: list[OperationReasonView]
    again: bool


class OperationGroupView(View):
    """Operations that the sequence of this `name`, or with `for_jobs` the work master, puts beside one another: all of
    them at once, one of them, or all one at a time.
    """

    kind: GroupKind
    operations: list[str]
    name: str
    for_jobs: bool


class DraftWorkMasterView(View):
    """A work master, and its operations."""

    title: str
    operations: list[str]


class DraftOperationsView(View):
    """The operations of the draft after change `number`, by name in the order of the file, and their order.

    Of a draft that is not `usable` they are as they were when it could be used last; none where that was never.
    `lanes` are the titles of resources in the order of the model.
    """

    number: int
    usable: bool
    operations: dict[str, DraftOperationView]
    links: list[OperationLinkView]
    groups: list[OperationGroupView]
    lanes: dict[str, str]
    masters: dict[str, DraftWorkMasterView]


class RevisionView(View):
    """A saved revision of the model; `running` and `draft` say that the station runs it, and that the draft is it.

    `approved_by` and `changes_requested_by` name those whose verdict on it counts. Time is in seconds since the epoch.
    """

    id: str
    name: str
    message: str
    by: str
    time: float
    running: bool
    draft: bool
    approved_by: list[str]
    changes_requested_by: list[str]


class RevisionsView(View):
    """All revisions, newest first; `saved` says whether the draft is one of them, `running` whether the station is."""

    revisions: list[RevisionView]
    saved: bool
    running: bool


class RefusalView(View):
    """Why something was not done, in words."""

    title: str
    title_message: Message
    detail: str
    detail_message: Message


class PlannedDeploymentView(View):
    """The revision that is deployed when the product in work is done: who wants that since when, and why.

    `refused` says why it was not done; null as long as it is to come. With `reset` emulated devices and the station
    begin as the model says.
    """

    revision: str
    name: str
    by: str
    since: float
    reason: str
    reset: bool
    refused: RefusalView | None


class CommentView(View):
    """What somebody has said of the draft, as it was after its change `draft`, or with a `verdict` of a `revision`.

    Time is in seconds since the epoch.
    """

    number: int
    time: float
    by: str
    draft: int
    text: str
    revision: str | None
    verdict: Verdict | None


class CommentsView(View):
    """The newest comments, in the order in which they were made."""

    comments: list[CommentView]


class WorkshopView(View):
    """The draft as everybody sees it: its files, in how many places they are others than those of what runs, what the
    check has found so far, what of it is to be deployed, and the number of the last `comment` that was made since the
    server began.
    """

    number: int
    files: dict[str, FileMark]
    changes: int
    last: ChangeView | None
    check: CheckView
    planned: PlannedDeploymentView | None = None
    comment: int = 0


class WaitingRevisionView(View):
    """A revision that waits for a second person's approval; `number` counts from the oldest, which is 1.

    Time is in seconds since the epoch.
    """

    id: str
    number: int
    name: str
    by: str
    time: float


class DraftChangesView(View):
    """In how many places the draft after change `number` differs from what runs.

    `waits` is the revision that the draft is, where the model that runs asks for a second person's approval, who asks
    could give it, and nobody has approved it or wants changes; null for who saved it, and for who is no person.
    """

    number: int
    changes: int
    waits: WaitingRevisionView | None = None


# The draft as it is shown.

# What could be said shorter in the draft.


class FoldKind(StrEnum):
    """What a fold is for."""

    QUANTIFIER = "quantifier"
    SET = "set"
    PREDICATE = "predicate"
    RELATION = "relation"
    INCLUDES = "includes"
    MAP = "map"
    ROWS = "rows"
    TYPE = "type"


class FoldPlaceView(View):
    """A place where something is written longer than it need be: what is there, and what would be there."""

    file: str
    line: int
    column: int
    was: str
    now: str


class FoldView(View):
    """A way to write something shorter that was proven to mean the same. `name` is proposed for what it adds.

    `edits` make it, carried out together.
    """

    id: str
    kind: FoldKind
    title: str
    name: str | None
    places: tuple[FoldPlaceView, ...]
    saved_lines: int
    saved_characters: int
    edits: tuple[Edit, ...]


class FoldsView(View):
    """The folds of the draft after change `number`, those first that save most.

    Of one that is not `usable` there are none; where it is not `whole`, time was up before all had been looked at.
    """

    number: int
    usable: bool
    whole: bool
    folds: tuple[FoldView, ...]


MOST_READ, MOST_CHARACTERS = 5000, 50_000_000  # files whose content is remembered, and what they may take together


def marks(draft: Draft) -> dict[str, FileMark]:
    """Tell how each file of the draft stands, also those that were taken away."""
    return {path: _mark(draft, path) for path in sorted(draft.files.keys() | draft.base.keys())}


def places_changed(draft: Draft) -> int:
    """Return in how many places the draft differs from what runs; a file that nobody reads through is one of them."""
    total = 0
    for path in draft.files.keys() | draft.base.keys():
        before, after = draft.base.get(path), draft.files.get(path)
        if before != after:
            unread = is_binary(path) or len(before or "") + len(after or "") > MOST_READ_THROUGH
            total += 1 if unread else len(rewritten(before, after))
    return total


def _mark(draft: Draft, path: str) -> FileMark:
    text, base = draft.files.get(path), draft.base.get(path)
    if text is None:
        return FileMark(digest=None, state=FileState.REMOVED)
    state = FileState.NEW if base is None else FileState.SAME if base == text else FileState.CHANGED
    return FileMark(digest=digest(text), state=state)


MOST_READ_THROUGH = 400_000
"""In files of more characters places are not counted: it would take too long."""

MOST_PLACES = 20
"""Of a change no more places are told."""

LONGEST_TEXT = 400
"""More characters of a place are not told: who wants all of it compares revisions."""


def change_view(change: DraftChange, differences: Differences) -> ChangeView:
    """A change, as people read it; of what it did as much as they can take in."""
    places = [
        ChangedLinesView(file=path, line=each.line, was=_short(each.was), now=_short(each.now))
        for path, (before, after) in sorted(differences.items())
        if not is_binary(path)
        for each in rewritten(before, after)
    ]
    return ChangeView(
        number=change.number,
        time=change.time,
        by=change.by_name,
        kind=change.kind,
        of=change.of,
        title=change.title,
        places=places[:MOST_PLACES],
    )


def _short(text: str | None) -> str | None:
    return text if text is None or len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]}…"


def revisions_view(
    revisions: Iterable[Revision], running: str, edited: str, verdicts: Sequence[Comment]
) -> RevisionsView:
    """Revisions, as people read them; `running` and `edited` are the trees of what runs, and of the draft."""

    def view(each: Revision) -> RevisionView:
        counting = standing_verdicts(each, verdicts)
        return RevisionView(
            id=each.id,
            name=each.name,
            message=each.message,
            by=each.by,
            time=each.time,
            running=each.tree == running,
            draft=each.tree == edited,
            approved_by=[said.by_name for said in counting if said.verdict is Verdict.APPROVED],
            changes_requested_by=[said.by_name for said in counting if said.verdict is Verdict.CHANGES_REQUESTED],
        )

    views = [view(each) for each in revisions]
    return RevisionsView(
        revisions=views, saved=any(each.draft for each in views), running=any(each.running for each in views)
    )


class FileReader:
    """Reads files, each text once, and tells what they hold as JSON."""

    def __init__(self) -> None:
        self._read: OrderedDict[tuple[str, str], str] = OrderedDict()
        self._characters = 0

    def shown(self, draft: Draft, paths: Iterable[str]) -> str:
        """JSON of a `FilesView` of these files, those that are not there as null."""
        views = {path: self._view(path, draft.files[path]) if path in draft.files else "null" for path in paths}
        files = ",".join(f"{json.dumps(path)}:{view}" for path, view in views.items())
        return f'{{"number":{draft.number},"files":{{{files}}}}}'

    def _view(self, path: str, text: str) -> str:
        key = path, digest(text)
        known = self._read.get(key)
        if known is None:
            content, wrong = _content(path, text)
            shown = "" if is_binary(path) else text  # nobody reads those as a text
            view = FileView(path=path, digest=key[1], text=shown, content=content, wrong=wrong)
            known = self._read[key] = view.model_dump_json()
            self._characters += len(known)
        self._read.move_to_end(key)
        while len(self._read) > MOST_READ or self._characters > MOST_CHARACTERS:
            self._characters -= len(self._read.popitem(last=False)[1])
        return known


def _content(path: str, text: str) -> tuple[JsonValue, FindingDocument | None]:
    if not path.endswith(".yaml"):
        return None, None
    try:
        return plain(read_text(text, path).content), None
    except ModelError as error:
        return None, error_document(error.findings[0])


# A station that is led through the draft step by step.


class StepView(View):
    """One tick: variables that are set by somebody, effects that happen at once, and starts in their order."""

    effects: list[str] = Field(default=[], max_length=1000)
    starts: list[str] = Field(default=[], max_length=1000)
    sets: dict[str, Value | None] = Field(default={}, max_length=1000)


class StepChangeView(View):
    """A variable that a step has changed; `so` says in words what it is then, null where that is unknown."""

    name: str
    before: Value | None
    after: Value | None
    so: Message | None


class StepMomentView(View):
    """The station after a `step`, which `title` tells, so many `seconds` after the beginning as devices usually need.

    `ended` are abilities whose runs were over by it. A station outside its safe states is not `safe`; `violated` are
    the titles of specifications that do not hold for certain. One that is `restless` goes on by itself for ever, as
    abilities finish again and again: it is shown after many ticks of that.
    """

    step: StepView
    title: Message
    resource: str | None
    seconds: float
    changes: list[StepChangeView]
    ended: list[str]
    completed: list[str]
    activated: list[str]
    running: list[str]
    active: list[str]
    safe: bool
    restless: bool
    violated: list[str]


class SettableView(View):
    """The values that somebody can give a variable of the draft; one that is measured may be `unknown`, too."""

    domain: list[Value]
    unknown: bool


class ChoiceKind(StrEnum):
    """Who or what makes a step happen."""

    DEVICE = "device"
    PERSON = "person"
    FAULT = "fault"
    START = "start"


class ChoiceView(View):
    """A step that can be taken: by whom, what it is, and between how many `seconds` it usually takes; `planned` says
    that the plan begins with it.
    """

    kind: ChoiceKind
    step: StepView
    title: Message
    resource: str
    seconds: tuple[float, float] | None
    planned: bool


class KeptBackView(View):
    """An ability that may not start: what is still missing, or that only the supervisor keeps it back."""

    ability: str
    title: str
    resource: str
    supervisor: bool
    why: Message


class StepStartView(View):
    """A start of the plan, after so many seconds from the last moment."""

    ability: str
    title: str
    resource: str
    tick: int
    seconds: float


class StepPlanView(View):
    """The plan from the last moment: its starts with when they are expected, and its ticks as steps.

    Without a plan `verdict` says what is known.
    """

    verdict: str
    starts: list[StepStartView]
    ticks: list[StepView]
    seconds: float


class RefusedStepView(View):
    """The step that could not be taken, by its place among those that were asked for, and why."""

    index: int
    why: Message


class StepsView(View):
    """A station led from the values `before` on through the draft after its change `number`: a moment after the
    beginning and after each step, and what can happen after the last.

    `refused` is the first step that cannot be taken; what comes after it was not tried. `stopped` says why plans were
    followed no further, where that was asked for. Somebody can disturb what is `settable`. With an `obstacle` the model
    cannot be used, and nothing is told.
    """

    number: int
    obstacle: Message | None
    before: dict[str, Value | None]
    moments: list[StepMomentView]
    choices: list[ChoiceView]
    kept_back: list[KeptBackView]
    settable: dict[str, SettableView]
    plan: StepPlanView | None
    refused: RefusedStepView | None
    stopped: str | None
