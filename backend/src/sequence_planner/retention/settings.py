"""Settings of `run` for how long things are kept."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

JOURNAL_DAYS: Final = 30.0
JOURNAL_GB: Final = 10.0
ORDER_DAYS: Final = 90.0
LEAST_ORDER_DAYS: Final = 8.0
"""Longer than repeated requests are answered the same: what they name is there."""
MOST_DAYS: Final = 36_500.0
MOST_GB: Final = 100_000.0
NO_ARCHIVE: Final = "none"
DAY: Final = 86400.0  # seconds
GB: Final = 1e9  # bytes


@dataclass(frozen=True)
class Retention:
    """The time for which what happened stays in the database, or how many GB of it, whichever comes first; and the time
    for job orders that are over, with their events and responses.

    What is cut goes to `folder`, or None for one beside the database; nowhere if not `archived`. Files of the archive
    are removed when they are older than `archive_days` or more than `archive_gb`, where these are given.
    """

    journal_days: float = JOURNAL_DAYS
    journal_gb: float = JOURNAL_GB
    order_days: float = ORDER_DAYS
    folder: Path | None = None
    archived: bool = True
    archive_days: float | None = None
    archive_gb: float | None = None

    @classmethod
    def from_options(
        cls,
        journal_days: float,
        journal_gb: float,
        order_days: float,
        archive_folder: str | None,
        archive_days: float | None,
        archive_gb: float | None,
    ) -> Retention:
        """As the options say it."""
        archived = archive_folder != NO_ARCHIVE
        folder = Path(archive_folder).absolute() if archive_folder and archived else None
        return cls(journal_days, journal_gb, order_days, folder, archived, archive_days, archive_gb)

    def arguments(self) -> list[str]:
        """The options that say this."""
        folder = NO_ARCHIVE if not self.archived else self.folder
        given = {
            "journal-days": self.journal_days,
            "journal-gb": self.journal_gb,
            "order-days": self.order_days,
            "archive-folder": folder,
            "archive-days": self.archive_days,
            "archive-gb": self.archive_gb,
        }
        return [f"--{name}={value}" for name, value in given.items() if value is not None]
