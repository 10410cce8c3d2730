"""The draft of a model while it is edited: its files as they are now, and what its names mean."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from pathlib import Path

from sequence_planner.editor.language.scope import Lexicon, messages_of
from sequence_planner.model.files import Files, write_files
from sequence_planner.model.loader import load_station
from sequence_planner.model.source import Finding, ModelError
from sequence_planner.ros.types.errors import MessageDefinitionError
from sequence_planner.ros.types.messages import MessageRegistry
from sequence_planner.station import Before, MeantStation, read_station

STATION, NOTHING = "station.yaml", "name: draft\n"


class LanguageDraft:
    """The draft while it is edited, and what its names mean. Its files are written into the empty `folder`.

    A file that cannot be used stands as it was when it could be: what is written elsewhere is not wrong because of it.
    What is the same as before is not read again.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files: dict[str, str] = {}
        self._usable: dict[str, str] = {}
        self._written: dict[str, str] = {}  # what the folder holds
        self._before = Before()
        self._lexicon: Lexicon | None = None
        self.meant_last: MeantStation | None = None
        """What it meant when it could be used last."""

    def take(self, changed: Mapping[str, str | None]) -> None:
        """Take note of files that are others now."""
        for path, text in changed.items():
            if text is None:
                self._files.pop(path, None)
            else:
                self._files[path] = text
        if changed:
            self._lexicon = None

    @property
    def files(self) -> Files:
        """The files as they are."""
        return self._files

    @property
    def lexicon(self) -> Lexicon:
        """The meaning of names now."""
        if self._lexicon is None:
            self._lexicon = self._made()
        return self._lexicon

    def errors(self) -> list[Finding]:
        """Return what makes it unusable, all that a check of it finds before it builds pipelines."""
        try:
            self.meant()
        except ModelError as error:
            return error.findings
        return []

    def meant(self) -> MeantStation:
        """Return what it means, before its pipelines are built. Raises `ModelError`."""
        with self._folder_of(self._files):
            self.meant_last = read_station(Path(), self._before)
            return self.meant_last

    def messages(self) -> MessageRegistry | None:
        """The message types that it defines; None where they cannot be read."""
        with self._folder_of(self._files):
            folders = [each for each in (Path("messages"), *Path().glob("packages/*/messages")) if each.is_dir()]
            try:
                return MessageRegistry.from_folder(None, *folders)
            except MessageDefinitionError:
                return None

    def _made(self) -> Lexicon:
        files = {STATION: NOTHING, **self._files}
        while True:
            with self._folder_of(files):
                try:
                    station = load_station(Path(), self._before.files)
                    self._usable = {path: text for path, text in files.items() if text != NOTHING}
                    return Lexicon.of(station, messages_of(station))
                except ModelError as error:
                    wrong = {finding.place.file for finding in error.findings}
            for path in wrong & files.keys() or files.keys() - {STATION}:
                files = self._without(files, path)

    def _without(self, files: Files, path: str) -> dict[str, str]:
        """With the file as it was when it could be used, or else without it."""
        others = {name: text for name, text in files.items() if name != path}
        usable = self._usable.get(path)
        if usable is not None and usable != files[path]:
            return {**others, path: usable}
        return {**others, STATION: NOTHING} if path == STATION else others

    @contextlib.contextmanager
    def _folder_of(self, files: Files) -> Iterator[None]:
        """Within the folder, which holds these files, so that places bear the names that files have in the model."""
        self._folder.mkdir(parents=True, exist_ok=True)
        for path in self._written.keys() - files.keys():
            (self._folder / path).unlink()
        write_files({path: text for path, text in files.items() if self._written.get(path) != text}, self._folder)
        self._written = dict(files)
        with contextlib.chdir(self._folder):
            yield
