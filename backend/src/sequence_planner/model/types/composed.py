"""Documents of types of resources, and of their instances, as a whole: for schemas and for what is suggested."""

from __future__ import annotations

from sequence_planner.model.documents import ResourceDocument
from sequence_planner.model.types.documents import InstanceHead, TypeHead


class InstanceDocument(ResourceDocument, InstanceHead):
    """A resource that may be an instance of a `type`: then it has all of that, and what it changes and adds itself."""


class TypeDocument(ResourceDocument, TypeHead):
    """A resource with parameters. It may be of a `type` itself, whose parameters it gives."""
