"""Campaigns: fast paths beside their references on far more random models than the tests have time for.

A campaign goes on where the last one of the same commit and seed was interrupted, and writes a page to
`docs/campaigns`. What disagrees is named there by its seed and told at once; with `--again SEED` that one is compared
alone, such as `--again plain.1.27`.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

REPOSITORY = Path(__file__).parents[3]
KEPT_EVERY = 100  # of a kind
LARGEST = "most "


@dataclass(frozen=True)
class Kind:
    """What is compared: one random model by its seed, which says what has been met or raises; and how many of them.

    What has been found is kept after every `kept_every` of them. Of what begins with `most` the report has the largest
    number, and of all else the sum.
    """

    compare: Callable[[str], Counter[str]]
    number: int
    kept_every: int = KEPT_EVERY


@dataclass(frozen=True)
class Subject:
    """What a campaign is about: the name of its files, the title and the first words of its page."""

    name: str
    title: str
    about: str
    kinds: Mapping[str, Kind]


@dataclass
class Campaign:
    """How far one has come."""

    commit: str
    seed: int
    done: dict[str, int] = field(default_factory=dict)
    seconds: float = 0.0
    seen: dict[str, int] = field(default_factory=dict)
    disagreements: list[str] = field(default_factory=list)

    def run(self, name: str, kind: Kind, number: int, progress: Path) -> None:
        """Go on until so many of a kind have been compared."""
        while (first := self.done.get(name, 0)) < number:
            began = time.process_time()
            seen = Counter(self.seen)
            for each in range(first, min(first + kind.kept_every, number)):
                seed = f"{name}.{self.seed}.{each}"
                try:
                    seen = merged(seen, kind.compare(seed))
                except Exception as error:
                    self.disagreements.append(f"`{seed}`: {type(error).__name__}: {error}")
                    print(self.disagreements[-1], flush=True)
                self.done[name] = each + 1
            self.seen = dict(seen)
            self.seconds += time.process_time() - began
            progress.parent.mkdir(parents=True, exist_ok=True)
            progress.write_text(json.dumps(asdict(self)), encoding="utf-8")
            print(f"{name}: {self.done[name]} of {number}, {len(self.disagreements)} disagreements", flush=True)

    def report(self, subject: Subject) -> str:
        """The page about it."""
        met = "".join(f"| {what} | {number} |\n" for what, number in sorted(self.seen.items()))
        failed = "".join(f"- {each}\n" for each in self.disagreements) or "None.\n"
        done = " and ".join(f"{number} {name}" for name, number in self.done.items())
        return (
            f"# {subject.title}\n\n{subject.about} `make campaign` repeats it.\n\n"
            f"Commit {self.commit}, seed {self.seed}: {done}, {self.seconds:.0f} s of CPU time.\n\n"
            f"| met | times |\n|---|---|\n{met}\n## Disagreements\n\n{failed}"
        )


def main(subject: Subject) -> int:
    """Go on with the campaign, or begin one. 1 when something disagrees."""
    arguments = argparse.ArgumentParser(description=f"{subject.title}. {subject.about}")
    for name, kind in subject.kinds.items():
        arguments.add_argument(f"--{name}", type=int, default=kind.number, help="how many")
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--again", metavar="SEED", help="compare this one alone")
    chosen = arguments.parse_args()
    if chosen.again:
        print(dict(subject.kinds[chosen.again.partition(".")[0]].compare(chosen.again)))
        return 0
    progress = REPOSITORY / ".ci" / "results" / "campaigns" / f"{subject.name}.json"
    campaign = _begun(progress, chosen.seed)
    for name, kind in subject.kinds.items():
        campaign.run(name, kind, getattr(chosen, name), progress)
    report = REPOSITORY / "docs" / "campaigns" / f"{subject.name}.md"
    report.parent.mkdir(parents=True, exist_ok=True)
    report.write_text(campaign.report(subject), encoding="utf-8")
    print(campaign.report(subject))
    return 1 if campaign.disagreements else 0


def merged(one: Counter[str], other: Counter[str]) -> Counter[str]:
    """What was met by both."""
    largest = {what: max(one[what], number) for what, number in other.items() if what.startswith(LARGEST)}
    return Counter({**(one + other), **largest})


def commit() -> str:
    """The commit at hand, and whether the files differ from it."""
    git = ("git", "-C", str(REPOSITORY))
    name = subprocess.run([*git, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=True)
    changes = subprocess.run([*git, "status", "--porcelain", "backend"], capture_output=True, text=True, check=True)
    return name.stdout.strip() + (" with changes" if changes.stdout else "")


def _begun(progress: Path, seed: int) -> Campaign:
    """The campaign of this commit and seed as far as it has come."""
    at_hand = commit()
    if progress.exists():
        campaign = Campaign(**json.loads(progress.read_text(encoding="utf-8")))
        if (campaign.commit, campaign.seed) == (at_hand, seed):
            return campaign
    return Campaign(at_hand, seed)
