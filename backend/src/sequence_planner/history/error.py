"""When something asked of the journal cannot be told."""

from __future__ import annotations

from typing import Final

OTHER_VERSION: Final = "other-version"  # of the program has written it


class HistoryError(Exception):
    """What is asked of the journal cannot be told; the text says why, and `slug` names the kind for machines."""

    def __init__(self, slug: str, detail: str) -> None:
        super().__init__(slug, detail)
        self.slug = slug
        self.detail = detail

    def __str__(self) -> str:
        return self.detail
