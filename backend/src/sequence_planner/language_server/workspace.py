"""The documents that are open in an editor, and the stations that they belong to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import unquote, urlsplit

from sequence_planner.language_server.documents.texts import DocumentText, OpenDocument, plain_lines
from sequence_planner.language_server.threads import ServerThreads

if TYPE_CHECKING:
    from sequence_planner.language_server.station import EditedStation, StationListener

_STATION = "station.yaml"


@dataclass(frozen=True)
class StationFile:
    """A file of a station: what it is called there."""

    station: EditedStation
    name: str


def path_of(uri: str) -> Path | None:
    """The path of a file; None for what is no file of this machine."""
    parts = urlsplit(uri)
    if parts.scheme != "file" or parts.netloc not in ("", "localhost"):
        return None
    path = Path(unquote(parts.path))
    return path if path.is_absolute() and "\0" not in str(path) else None


class OpenWorkspace:
    """All that is open. A station begins with the first document of it that is opened, and ends with the last."""

    def __init__(self, listener: StationListener, threads: ServerThreads, deadline: float) -> None:
        self.encoding = "utf-16"
        self.deadline = deadline
        self.documents: dict[str, OpenDocument] = {}
        self._listener = listener
        self._threads = threads
        self._stations: dict[Path, EditedStation] = {}

    @property
    def stations(self) -> list[EditedStation]:
        """The stations of which something is open."""
        return list(self._stations.values())

    def opened(self, uri: str, version: int, text: str) -> None:
        """A document is open in the editor from now on, with this text."""
        self.documents[uri] = OpenDocument(uri, version, DocumentText(plain_lines(text), self.encoding))
        path = path_of(uri)
        folder = None if path is None else self._folder_of(path)
        if path is None or folder is None:
            return
        if folder not in self._stations:
            from sequence_planner.language_server.station import EditedStation  # noqa: PLC0415 (see `serving`)

            self._stations[folder] = EditedStation(folder, self._threads, self._listener, self.deadline)
            self._stations[folder].look_again()
            self._take_over(self._stations[folder])
        elif (file := self._stations[folder].file_of(path)) is not None:
            self._stations[folder].typed(file, text=self.documents[uri].content.text)
        self._stations[folder].changed()

    def typed(self, uri: str) -> None:
        """Something was typed in a document that is open."""
        if (found := self.file(uri)) is not None:
            found.station.typed(found.name, self.documents[uri].content.text)
            found.station.changed()

    async def closed(self, uri: str) -> EditedStation | None:
        """A document is open no more; returns its station where that was the last."""
        found = self.file(uri)
        self.documents.pop(uri, None)
        path = path_of(uri)
        station = None if path is None else self._stations.get(self._folder_of(path) or path)
        if station is None:
            return None
        if found is not None:
            station.typed(found.name, None)
        if any(self._is_in(station, other) for other in self.documents):
            station.look_again()
            station.changed()
            return None
        del self._stations[station.folder]
        await station.close()
        return station

    def file(self, uri: str, *, of_model: bool = True) -> StationFile | None:
        """The file of a station that a document is, or at least lies beside unless it must be `of_model`; else None."""
        path = path_of(uri)
        if path is None:
            return None
        for folder in path.parents:
            if (station := self._stations.get(folder)) is not None:
                name = station.file_of(path)
                if name is None and not of_model:
                    name = path.relative_to(folder).as_posix()
                return None if name is None else StationFile(station, name)
        return None

    def look_again(self, paths: list[Path]) -> None:
        """Something has happened to these files, perhaps outside of the editor."""
        for station in self.stations:
            if any(path.is_relative_to(station.folder) for path in paths):
                station.look_again()
                station.changed()

    async def close(self) -> None:
        """End all of it."""
        for station in self.stations:
            await station.close()

    def _take_over(self, station: EditedStation) -> None:
        """All that is open of it is as typed, also what was opened before its `station.yaml` was there."""
        for uri, document in self.documents.items():
            if self._is_in(station, uri) and (name := station.file_of(path_of(uri) or station.folder)) is not None:
                station.typed(name, document.content.text)

    def _is_in(self, station: EditedStation, uri: str) -> bool:
        path = path_of(uri)
        return path is not None and self._folder_of(path) == station.folder

    def _folder_of(self, path: Path) -> Path | None:
        """The nearest folder with a station in it, which may not be saved yet."""
        for folder in path.parents:
            if (
                folder in self._stations
                or (folder / _STATION).as_uri() in self.documents
                or _is_file(folder / _STATION)
            ):
                return folder
        return None


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except OSError:
        return False
