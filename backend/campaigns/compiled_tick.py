"""The compiled tick beside the reference on far more random automata than the tests have time for.

`make campaign` goes on where the last one of the same commit and seed was interrupted, and writes
`docs/campaigns/compiled-tick.md`. An automaton on which they disagree is named in it by a call that repeats it.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections import Counter
from dataclasses import asdict, dataclass, field
from pathlib import Path

from core.random_ticks import compare_by_seed

REPOSITORY = Path(__file__).parents[2]
PROGRESS = REPOSITORY / ".ci" / "results" / "campaigns" / "compiled-tick.json"
REPORT = REPOSITORY / "docs" / "campaigns" / "compiled-tick.md"
TICKS = 12  # of each automaton
KEPT_EVERY = 500  # automata


@dataclass
class Campaign:
    """How far one has come."""

    commit: str
    seed: int
    automata: int = 0
    seconds: float = 0.0
    seen: dict[str, int] = field(default_factory=dict)
    disagreements: list[str] = field(default_factory=list)

    def run(self, automata: int) -> None:
        """Go on until so many automata have been compared."""
        while self.automata < automata:
            began = time.perf_counter()
            seen = Counter(self.seen)
            for number in range(self.automata, min(self.automata + KEPT_EVERY, automata)):
                try:
                    seen += compare_by_seed(f"{self.seed}.{number}", TICKS)
                except Exception as error:
                    self.disagreements.append(f"{type(error).__name__}: {error} (automaton {self.seed}.{number})")
                self.automata = number + 1
            self.seen = dict(seen)
            self.seconds += time.perf_counter() - began
            PROGRESS.parent.mkdir(parents=True, exist_ok=True)
            PROGRESS.write_text(json.dumps(asdict(self)), encoding="utf-8")
            print(f"{self.automata} of {automata} automata, {len(self.disagreements)} disagreements", flush=True)

    def report(self) -> str:
        """The page about it."""
        met = "".join(f"| {what} | {number} |\n" for what, number in sorted(self.seen.items()))
        failed = "".join(f"- {each}\n" for each in self.disagreements) or "None.\n"
        return (
            "# Compiled tick beside the reference\n\n"
            "Random automata with random runs; after every step the states, the finished and the conflicting\n"
            "abilities, the active operations and the abilities that may start are compared. `make campaign` repeats"
            " it.\n\n"
            f"Commit {self.commit}, seed {self.seed}: {self.automata} automata of {TICKS} ticks each,"
            f" {self.seconds:.0f} s.\n\n"
            f"| met | times |\n|---|---|\n{met}\n## Disagreements\n\n{failed}"
        )


def main() -> int:
    """Go on with the campaign, or begin one. 1 when the interpreters disagree."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--automata", type=int, default=50_000)
    arguments.add_argument("--seed", type=int, default=1)
    chosen = arguments.parse_args()
    campaign = begun(commit(), chosen.seed)
    campaign.run(chosen.automata)
    REPORT.parent.mkdir(parents=True, exist_ok=True)
    REPORT.write_text(campaign.report(), encoding="utf-8")
    print(campaign.report())
    return 1 if campaign.disagreements else 0


def begun(commit: str, seed: int) -> Campaign:
    """The campaign of this commit and seed as far as it has come."""
    if PROGRESS.exists():
        campaign = Campaign(**json.loads(PROGRESS.read_text(encoding="utf-8")))
        if (campaign.commit, campaign.seed) == (commit, seed):
            return campaign
    return Campaign(commit, seed)


def commit() -> str:
    """The commit at hand, and whether the files differ from it."""
    git = ("git", "-C", str(REPOSITORY))
    name = subprocess.run([*git, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=True)
    changes = subprocess.run([*git, "status", "--porcelain", "backend"], capture_output=True, text=True, check=True)
    return name.stdout.strip() + (" with changes" if changes.stdout else "")


if __name__ == "__main__":
    sys.exit(main())
