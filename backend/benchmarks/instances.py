"""CPU time to load a station of 20 instances of one type with 10 abilities each, beside the same written out."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path
from statistics import median

from sequence_planner.model.loader import load_station
from sequence_planner.process.gc_tuning import collection_put_off

INSTANCES, ABILITIES, RUNS = 20, 10, 7
ABILITY = """
  do_{n}:
    title: Do {n} at the {{stop}}
    parameters: {{stop: POSES}}
    timeouts: {{react: 2, finish: 15}}
    duration: [1, 3]
    enabled: at == target and at != stop and not busy and stop != HOME
    start: {{do: [target := stop, busy := true]}}
    executing: target == stop and at != stop
    finish: {{when: target == stop and at == stop, do: [busy := false]}}
    effects:
      arrives: {{kind: executing, when: target != at, do: [at := target], takes: MOVING}}
"""
RESOURCE = """
title: Robot SPACE
measured: {at: {type: POSES, initial: HOME}}
output: {target: {type: POSES, initial: HOME}}
estimated: {busy: {type: bool}}
abilities:
""" + "".join(ABILITY.format(n=n) for n in range(ABILITIES))


def filled(space: str, poses: str, home: str, moving: str) -> str:
    """The resource with these words in it."""
    words = {"SPACE": space, "POSES": poses, "HOME": home, "MOVING": moving}
    text = RESOURCE
    for name, word in words.items():
        text = text.replace(name, word)
    return text


def write(folder: Path, typed: bool) -> Path:
    """The station, of instances or written out."""
    for each in ("resources", "types"):
        (folder / each).mkdir(parents=True)
    (folder / "station.yaml").write_text("name: many\nenumerations: {pose: [rest, left, right]}\n")
    parameters = "parameters: {space: text, poses: enumeration, home: {kind: value, of: poses}, moving: number}\n"
    if typed:
        (folder / "types" / "robot.yaml").write_text(parameters + filled("{space}", "poses", "home", "moving"))
    for n in range(INSTANCES):
        given = f"type: robot\narguments: {{space: r{n}, poses: pose, home: rest, moving: 1.5}}\n"
        text = given if typed else filled(f"r{n}", "pose", "rest", "1.5")
        (folder / "resources" / f"r{n}.yaml").write_text(text)
    return folder


@collection_put_off()
def seconds(folder: Path) -> float:
    """CPU time of one load."""
    begun = time.process_time()
    load_station(folder)
    return time.process_time() - begun


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as beside:
        plain, typed = write(Path(beside) / "plain", typed=False), write(Path(beside) / "typed", typed=True)
        found = [(seconds(plain), seconds(typed)) for _ in range(RUNS)][1:]
    one, other = (median(each) for each in zip(*found, strict=True))
    print(f"written out {one * 1000:.0f} ms, instances of a type {other * 1000:.0f} ms, ratio {other / one:.2f}")
