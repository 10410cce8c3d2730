"""A large model: 200 resources with 1 000 abilities, of which each reads the resource before its own.

`python benchmarks/stations/large.py FOLDER` writes it into an empty folder.
"""

from __future__ import annotations

import sys
from pathlib import Path

RESOURCES, ABILITIES = 200, 5  # the abilities of each

# What every ability reads; one of them writes it.
EVERYWHERE = "automatic"
STATION = f"""name: large
title: Large
enumerations:
  place: [p0, p1, p2]
estimated:
  {EVERYWHERE}: {{type: bool, initial: true}}
"""


def resource(number: int, abilities: int = ABILITIES) -> str:
    """A file of YAML."""
    before = f"{EVERYWHERE} and machine_{number - 1}.held" if number else EVERYWHERE
    more = "" if number else f", {EVERYWHERE} := true"
    written = "".join(
        f"""
  step_{step}:
    title: Step {step}
    # What must be so before.
    enabled: {before} and place == {("p0", "p1", "p2")[step % 3]}
    start:
      do: [target := {("p1", "p2", "p0")[step % 3]}]
    executing: place != target
    finish: {{when: place == target, do: [held := true{more}]}}
    effects:
      arrives_{step}: {{kind: executing, when: place != target, do: [place := target]}}
"""
        for step in range(abilities)
    )
    return f"""title: Machine {number}
measured:
  place: {{type: place, initial: p0}}
output:
  target: {{type: place, initial: p0}}
estimated:
  held: {{type: bool}}
abilities:{written}"""


def files(abilities: int = ABILITIES) -> dict[str, str]:
    """The model: texts by their paths below its folder."""
    operations = "".join(
        f"work_{n}:\n  precondition: true\n  goal: machine_{n}.held\n" for n in range(0, RESOURCES, 20)
    )
    made = {"station.yaml": STATION, "operations.yaml": operations}
    return {**made, **{f"resources/machine_{number}.yaml": resource(number, abilities) for number in range(RESOURCES)}}


def main() -> None:
    """Write it."""
    folder = Path(sys.argv[1])
    (folder / "resources").mkdir(parents=True)
    for path, text in files().items():
        (folder / path).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
