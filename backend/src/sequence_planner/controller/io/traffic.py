"""What passes the pipelines of a running station, its picture and its shifts, for who asks."""

from __future__ import annotations

from sequence_planner.controller.commands.command import CommandRefused, answers
from sequence_planner.controller.commands.queries import (
    AboutFlows,
    AboutMimic,
    AboutPipelines,
    AboutShifts,
    AskRecord,
)
from sequence_planner.controller.io.devices import Devices
from sequence_planner.controller.io.monitor import Observing, record_view
from sequence_planner.controller.io.pipeline_graph import pipelines_view
from sequence_planner.controller.views.details import ShiftsView, ShiftTimesView
from sequence_planner.controller.views.pipelines import FlowsView, PipelinesView, RecordView
from sequence_planner.core.clock import Timestamp
from sequence_planner.mimic.picture import picture_of
from sequence_planner.mimic.views import MimicView
from sequence_planner.model.fields import words_of
from sequence_planner.model.shifts.documents import DAYS, ShiftDocument
from sequence_planner.pipelines.graph import StationPipelines
from sequence_planner.station import ReadyStation
from sequence_planner.texts.message import message


class PipelineTraffic:
    """Answers about `pipelines`, and what `devices` have observed of them."""

    def __init__(self, pipelines: StationPipelines, devices: Devices) -> None:
        self._pipelines, self._devices = pipelines, devices
        self._observing = Observing()

    @answers(AboutPipelines)
    def pipelines(self, query: AboutPipelines) -> PipelinesView:
        """The graph of the pipelines."""
        return pipelines_view(self._pipelines)

    @answers(AboutFlows)
    def flows(self, query: AboutFlows) -> FlowsView:
        """Return what has passed the pipelines."""
        return self._observing.view(self._devices.traffic(query.among), Timestamp.now())

    @answers(AskRecord)
    def record(self, query: AskRecord) -> RecordView:
        """The last record of a pipeline. Raises `CommandRefused` where there is none that can be told."""
        pipeline = query.pipeline
        found = self._devices.traffic({pipeline}).get(pipeline)
        if found is None:
            raise CommandRefused("no-pipeline", message("refused.no-pipeline.name", name=pipeline), 404)
        try:
            record = record_view(found, Timestamp.now())
        except ValueError as error:
            raise CommandRefused(
                "record-too-large", message("refused.record-too-large.why", pipeline=pipeline, why=str(error)), 422
            ) from None
        if record is None:
            raise CommandRefused("no-record", message("refused.no-record.pipeline", pipeline=pipeline), 409)
        return record


class LivePicture:
    """Answers how a station is drawn. That is found out when somebody asks, and then kept: the model stays the same."""

    def __init__(self, station: ReadyStation) -> None:
        self._station = station
        self._known: MimicView | None = None

    @answers(AboutMimic)
    def mimic(self, query: AboutMimic) -> MimicView:
        """The picture."""
        self._known = self._known or picture_of(self._station.automaton, self._station.written)
        return self._known


class WrittenShifts:
    """Answers when a station is to work; one that nobody has written has no shifts."""

    def __init__(self, station: ReadyStation) -> None:
        self._station = station

    @answers(AboutShifts)
    def shifts(self, query: AboutShifts) -> ShiftsView:
        """The shifts."""
        written = self._station.written
        return ShiftsView(
            shifts={str(name): _shift(name, each) for name, each in (written.shifts if written else {}).items()}
        )


def _shift(name: str, written: ShiftDocument) -> ShiftTimesView:
    return ShiftTimesView(
        title=dict(words_of(written.title)) or {"": name.replace("_", " ")},
        minutes=written.minutes,
        days=sorted({DAYS.index(day) for day in written.days}),
        breaks=sorted(map(written.minutes_of_break, written.breaks)),
    )
