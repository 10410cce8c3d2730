"""What the services and actions of a resource may hold: the station is their client, the device their server."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from sequence_planner.model.document_part import DocumentPart, Given
from sequence_planner.model.source import SourceText
from sequence_planner.model.stage_documents import StageDocument

Period = Annotated[float, Field(gt=0, le=86_400)]


class ServiceDocument(DocumentPart):
    """A ROS 2 service of the device. It is called when an output rises, or every so often, or both."""

    type: SourceText
    """The service type, `package/srv/Name`."""
    when: Given[SourceText] = None
    """An output of type `bool`: the service is called when it becomes true."""
    every: Given[Period] = None
    """Seconds from one call to the next."""
    deadline: Period = 1.0
    """Seconds without an answer after which what the answer says is unknown."""
    ignore: list[SourceText] = Field(default_factory=list)
    """Fields of the request and of the response that are no variables."""
    request: list[StageDocument] = Field(default_factory=list)
    """Stages from variables to the request, as of an outgoing topic."""
    response: list[StageDocument] = Field(default_factory=list)
    """Stages from the response to variables, as of an incoming topic."""

    @model_validator(mode="after")
    def _is_called(self) -> ServiceDocument:
        if self.when is None and self.every is None:
            raise ValueError("say when the service is called: `when` an output rises, or `every` so many seconds")
        return self


class ActionDocument(DocumentPart):
    """A ROS 2 action of the device. A goal is sent when an output rises, and cancelled when it falls."""

    type: SourceText
    """The action type, `package/action/Name`."""
    when: SourceText
    """An output of type `bool`: a goal is sent when it becomes true, and cancelled when it becomes false."""
    status: SourceText
    """The measured variable that says what has become of the goal."""
    deadline: Period = 1.0
    """Seconds without an answer of the server after which the goal is lost."""
    ignore: list[SourceText] = Field(default_factory=list)
    """Fields of the goal, of the feedback and of the result that are no variables."""
    goal: list[StageDocument] = Field(default_factory=list)
    """Stages from variables to the goal, as of an outgoing topic."""
    feedback: list[StageDocument] = Field(default_factory=list)
    """Stages from the feedback to variables, as of an incoming topic."""
    result: list[StageDocument] = Field(default_factory=list)
    """Stages from the result to variables, as of an incoming topic."""
