"""The settings of backups that `run` is told."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

KEPT: Final = 14  # backups, unless somebody says how many
_HOUR: Final = 3600.0  # seconds
_WEEK: Final = 7 * 24 * _HOUR


@dataclass(frozen=True)
class Keeping:
    """The folder, or none for one beside the database; how many backups are kept; and every how many hours one is made
    without anybody asking, or none.
    """

    folder: Path | None = None
    kept: int = KEPT
    every: float | None = None

    @property
    def old_after(self) -> float:
        """Seconds after which the newest backup is old: two that should have been made since were not, or a week."""
        return _WEEK if self.every is None else 2 * self.every * _HOUR

    def arguments(self) -> list[str]:
        """The options that say this."""
        folder = [] if self.folder is None else [f"--backup-folder={self.folder}"]
        every = [] if self.every is None else [f"--backup-every={self.every}"]
        return [*folder, f"--backups-kept={self.kept}", *every]

    def is_due(self, times: list[float], now: float) -> bool:
        """Return whether the next is to be made without anybody asking. Those of the future a wrong clock has made."""
        return self.every is not None and not any(now - self.every * _HOUR < time <= now for time in times)
