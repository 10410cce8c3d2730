"""The picture of a draft."""

from __future__ import annotations

from sequence_planner.editor.draft import digest
from sequence_planner.editor.language.draft import LanguageDraft
from sequence_planner.editor.schemas.draft import DraftPictureView
from sequence_planner.mimic.picture import picture_of
from sequence_planner.mimic.picture_file import picture_file
from sequence_planner.model.source import ModelError


def pictured(draft: LanguageDraft, number: int) -> DraftPictureView:
    """Return the picture of the draft after change `number`."""
    text = draft.files.get("mimic.yaml")
    mark = None if text is None else digest(text)
    try:
        meant = draft.meant()
    except ModelError:
        return DraftPictureView(number=number, usable=False, digest=mark, picture=None, titles={}, file=None)
    picture = picture_of(meant.automaton, meant.station)
    return DraftPictureView(
        number=number,
        usable=True,
        digest=mark,
        picture=picture,
        titles=dict(meant.automaton.resources),
        file=picture_file(picture) if text is None else None,
    )
