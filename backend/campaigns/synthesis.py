"""The supervisor beside the one of its definition, on far more and larger random automata than the tests have time for.

`make campaign` goes on where the last one of the same commit and seed was interrupted, and writes
`docs/campaigns/synthesis.md`. What they disagree on is named there by its seed and told at once; with `--again SEED`
that one is compared alone, such as `--again plain.1.27`.
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

from core.supervisor_comparison import compare_plain, compare_station

REPOSITORY = Path(__file__).parents[2]
PROGRESS = REPOSITORY / ".ci" / "results" / "campaigns" / "synthesis.json"
REPORT = REPOSITORY / "docs" / "campaigns" / "synthesis.md"
COMPARE = {"plain": compare_plain, "station": compare_station}
KEPT_EVERY = 100  # of either kind


@dataclass
class Campaign:
    """How far one has come."""

    commit: str
    seed: int
    done: dict[str, int] = field(default_factory=lambda: dict.fromkeys(COMPARE, 0))
    seconds: float = 0.0
    seen: dict[str, int] = field(default_factory=dict)
    disagreements: list[str] = field(default_factory=list)

    def run(self, kind: str, number: int) -> None:
        """Go on until so many of a kind have been compared."""
        while (first := self.done[kind]) < number:
            began = time.process_time()
            seen = Counter(self.seen)
            for each in range(first, min(first + KEPT_EVERY, number)):
                seed = f"{kind}.{self.seed}.{each}"
                try:
                    seen += COMPARE[kind](seed)
                except Exception as error:
                    self.disagreements.append(f"`{seed}`: {type(error).__name__}: {error}")
                    print(self.disagreements[-1], flush=True)
                self.done[kind] = each + 1
            self.seen = dict(seen)
            self.seconds += time.process_time() - began
            PROGRESS.parent.mkdir(parents=True, exist_ok=True)
            PROGRESS.write_text(json.dumps(asdict(self)), encoding="utf-8")
            print(f"{kind}: {self.done[kind]} of {number}, {len(self.disagreements)} disagreements", flush=True)

    def report(self) -> str:
        """The page about it."""
        met = "".join(f"| {what} | {number} |\n" for what, number in sorted(self.seen.items()))
        failed = "".join(f"- {each}\n" for each in self.disagreements) or "None.\n"
        return (
            "# Supervisors beside their definition\n\n"
            "Random plain automata and random stations. The safe states and those reachable, with and without the\n"
            "supervisor, over all variables and over those that matter, are compared with plain sets of states and\n"
            "the reference tick, their exact numbers too; and for each start in each safe state, whether the\n"
            "supervisor allows it and whether its guard says so. `make campaign` repeats it.\n\n"
            f"Commit {self.commit}, seed {self.seed}: {self.done['plain']} plain automata and {self.done['station']}"
            f" stations, {self.seconds:.0f} s of CPU time.\n\n"
            f"| met | times |\n|---|---|\n{met}\n## Disagreements\n\n{failed}"
        )


def main() -> int:
    """Go on with the campaign, or begin one. 1 when something disagrees."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--plain", type=int, default=10_000, help="how many plain automata")
    arguments.add_argument("--stations", type=int, default=1_000, help="how many stations")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--again", metavar="SEED", help="compare this one alone")
    chosen = arguments.parse_args()
    if chosen.again:
        print(dict(COMPARE[chosen.again.partition(".")[0]](chosen.again)))
        return 0
    campaign = begun(commit(), chosen.seed)
    campaign.run("plain", chosen.plain)
    campaign.run("station", chosen.stations)
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
