"""What keeps a topic from being attached."""

from __future__ import annotations


class AttachError(Exception):
    """A topic cannot be attached; the text says why and what to do, `slug` names the kind for programs."""

    def __init__(self, slug: str, detail: str) -> None:
        super().__init__(detail)
        self.slug = slug
