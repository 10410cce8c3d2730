"""The example stations, which are looked at as the draft is: each has answers of its own and is never changed."""

from __future__ import annotations

import asyncio
from pathlib import Path

from starlette.concurrency import run_in_threadpool

from sequence_planner.core.actor import Actor
from sequence_planner.editor.draft import Draft
from sequence_planner.editor.examples.schemas import ExamplesView
from sequence_planner.editor.processes import worked
from sequence_planner.editor.schemas.check import waiting
from sequence_planner.editor.schemas.draft import DraftView, WorkshopView, marks
from sequence_planner.model.examples.library import EXAMPLES, example_files, example_folders
from sequence_planner.model.files import Files
from sequence_planner.model.launch_requirements import StartNeeds
from sequence_planner.server.services.reading import ReadableWorkshop
from sequence_planner.server.settings import StreamLimits

NUMBER = 1  # of the change after which an example is as it is, for ever


class ExampleWorkshop(ReadableWorkshop):
    """An example station. It is compared with nothing: all of it is as it runs, if it runs."""

    def __init__(self, folder: Path, limits: StreamLimits) -> None:
        super().__init__(folder, limits, StartNeeds(emulated=True))
        self._draft: Draft | None = None
        self._opening = asyncio.Lock()

    async def view(self, by: Actor) -> DraftView:
        """The example, in which nobody has done anything."""
        draft = await self.open()
        return DraftView(number=NUMBER, files=marks(draft), changes=[], undo=None, redo=None)

    async def _opened(self) -> Draft:
        async with self._opening:
            if self._draft is None:
                files = await run_in_threadpool(example_files, self.folder)
                self._draft = draft = Draft(NUMBER, files, files)
                self._shown = WorkshopView(
                    number=NUMBER, files=marks(draft), changes=0, last=None, check=waiting(NUMBER)
                )
                self._desk.check(NUMBER, files)
        return self._draft


class ExampleShelf:
    """The examples below `folder`, or those that come with the program; each has a workshop from the moment on that
    somebody looks at it. Used from one event loop.
    """

    def __init__(self, limits: StreamLimits, folder: Path | None) -> None:
        self._limits = limits
        self._folder = folder or EXAMPLES
        self._shops: dict[str, ExampleWorkshop] = {}
        self._listed: ExamplesView | None = None
        self._listing = asyncio.Lock()

    async def overview(self) -> ExamplesView:
        """All examples with what they are: found once. Raises `WorkerError`."""
        async with self._listing:
            if self._listed is None:
                found = await worked("examples.sizes:listed_examples", self._folder)
                assert isinstance(found, ExamplesView)
                self._listed = found
            return self._listed

    async def workshop(self, name: str) -> ExampleWorkshop | None:
        """The example of this name; None where there is none."""
        if name not in self._shops:
            if (folder := await self._folder_of(name)) is None:
                return None
            self._shops.setdefault(name, ExampleWorkshop(folder, self._limits))
        return self._shops[name]

    async def files_to_begin_with(self, name: str) -> Files | None:
        """The files of an example, which is not checked for that; None where there is none of this name."""
        folder = await self._folder_of(name)
        return None if folder is None else await run_in_threadpool(example_files, folder)

    async def close(self) -> None:
        """End what is being checked and answered."""
        await asyncio.gather(*(shop.close() for shop in self._shops.values()))

    async def _folder_of(self, name: str) -> Path | None:
        return (await run_in_threadpool(example_folders, self._folder)).get(name)
