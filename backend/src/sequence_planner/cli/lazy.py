"""Commands whose modules are imported only when somebody gives them: the help and the other commands start sooner."""

from __future__ import annotations

import gc
import sys
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperCommand
from typer.main import get_command

from sequence_planner.process.gc_tuning import collection_put_off


def renamed(old: str | None, new: str) -> None:
    """Say that a word of the command line is another one now: it is understood until the next minor version."""
    typer.echo(f"`{old}` is called `{new}` now: the next version knows no other name", err=True)


class LazyCommand(TyperCommand):
    """A command in `place`, such as `check:check`: `line` is what the help of the program says of it. One that `forks`
    has a fork server, which imports what a station needs while the command itself is imported. One that has another
    name `now` is not shown, and says so. `imports` is a module that the command will import when it is carried out.

    What is in that place is the function of a command, or a `Typer` with commands of its own.
    """

    def __init__(
        self,
        name: str,
        place: str,
        line: str = "",
        *,
        hidden: bool = False,
        forks: bool = False,
        now: str | None = None,
        imports: str | None = None,
    ) -> None:
        super().__init__(name, short_help=line, hidden=hidden or now is not None)
        self.now = now
        self._place = place
        self._forks = forks
        self._imports = imports

    def command(self) -> Any:  # noqa: ANN401 (a class that typer does not show)
        """The command itself."""
        module, _, attribute = self._place.partition(":")
        with collection_put_off():  # all that is imported stays
            found = getattr(import_module(f"sequence_planner.cli.{module}"), attribute)
            if self._imports is not None:
                import_module(f"sequence_planner.{self._imports}")
            gc.freeze()
        if not isinstance(found, typer.Typer):
            alone = typer.Typer(add_completion=False)
            alone.command(self.name)(found)
            found = alone
        return get_command(found)

    def make_context(self, *arguments: Any, **settings: Any) -> Any:  # noqa: ANN401
        """Read a command line as the command itself does; its context is one of that command."""
        if self.now is not None and not settings.get("resilient_parsing"):
            renamed(self.name, self.now)
        if self._forks and "--help" not in sys.argv:
            from sequence_planner.forking.starting import OWN  # noqa: PLC0415
            from sequence_planner.startup.preloads import LATER, NOW  # noqa: PLC0415

            OWN.prepare(NOW, LATER)
        return self.command().make_context(*arguments, **settings)
