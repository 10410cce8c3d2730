"""What a large station costs before it runs: reading its files, grounding them, checking everything.

Two generated stations: 1000 abilities that are all written, and 100 written ones for each of 10 values. Run with
`make bench`; figures are medians, ratios are taken within the run.
"""

from __future__ import annotations

import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from sequence_planner.automaton.grounding.station import ground
from sequence_planner.cli.analysing import Limits
from sequence_planner.cli.model.check import check_model
from sequence_planner.model.loader import load_station
from sequence_planner.model.yaml.reader import compose, compose_slowly
from sequence_planner.pipelines.builder import load_messages
from sequence_planner.pipelines.inference import with_inferred_variables
from sequence_planner.station import prepare_station

RESOURCES = 50
REPEATS = 5

ABILITY = """
  # Device {number} works on what stands in front of it, unless its neighbour does.
  work_{number}:
    title: Work with device {number}
    enabled: >- # the neighbours share their air
      not busy_{number} and not run_{number} and stage_{number} < 3 and
      not device_{neighbour}.busy_{number}
    start:
      do: [run_{number} := true]
    executing: run_{number} and busy_{number}
    finish:
      when: run_{number} and not busy_{number} and stage_{number} == 3
      do: [run_{number} := false]
    effects:
      begins:
        kind: starting
        when: run_{number} and not busy_{number} and stage_{number} < 3
        do: [busy_{number} := true]
        takes: [0.1, 0.3]
      ends:
        kind: executing
        when: run_{number} and busy_{number}
        do: [busy_{number} := false, stage_{number} := 3]
      clears:
        kind: finishing
        when: not run_{number} and stage_{number} == 3
        do: [stage_{number} := 0]
"""

# The same, for each place that the device can be sent to.
ABILITY_FOR_PLACES = """
  # Device {number} goes to any place, unless its neighbour is there.
  move_{number}:
    title: Move device {number} to {{place}}
    parameters: {{place: place}}
    enabled: at_{number} == goto_{number} and at_{number} != place and device_{neighbour}.at_{number} != place
    start:
      do: [goto_{number} := place]
    executing: goto_{number} == place and at_{number} != place
    finish:
      when: goto_{number} == place and at_{number} == place
    effects:
      arrives:
        kind: executing
        when: goto_{number} != at_{number}
        do: [at_{number} := goto_{number}]
        takes: [0.5, 1.5]
"""


def write_station(folder: Path, abilities: int, with_places: bool) -> Path:
    """A station whose resources have `abilities` written abilities between them."""
    each = range(abilities // RESOURCES)
    messages = folder / "messages" / "device_msgs" / "msg"
    messages.mkdir(parents=True)
    (folder / "resources").mkdir()
    places = ", ".join(f"place_{number}" for number in range(10))
    (folder / "station.yaml").write_text(f"name: {folder.name}\nenumerations:\n  place: [{places}]\n")
    measured = ("string at_{}",) if with_places else ("bool busy_{}", "uint8 stage_{}")
    commanded = "string goto_{}" if with_places else "bool run_{}"
    (messages / "State.msg").write_text("".join(f"{field.format(n)}\n" for n in each for field in measured))
    (messages / "Command.msg").write_text("".join(f"{commanded.format(n)}\n" for n in each))
    for device in range(RESOURCES):
        (folder / "resources" / f"device_{device}.yaml").write_text(resource(device, each, with_places))
    return folder


def resource(device: int, each: range, with_places: bool) -> str:
    """The file of one resource."""
    topics = "".join(
        f"  /device_{device}/{name}: {{type: device_msgs/msg/{name.title()}, direction: {direction}}}\n"
        for name, direction in (("state", "in"), ("command", "out"))
    )
    if with_places:
        measured = "".join(f"  at_{n}: {{type: place}}\n" for n in each)
        output = "".join(f"  goto_{n}: {{type: place}}\n" for n in each)
    else:
        measured = "".join(f"  busy_{n}: {{type: bool}}\n  stage_{n}: {{type: 0..3}} # how far it is\n" for n in each)
        output = "".join(f"  run_{n}: {{type: bool, initial: false}}\n" for n in each)
    form = ABILITY_FOR_PLACES if with_places else ABILITY
    written = "".join(form.format(number=n, neighbour=(device + 1) % RESOURCES) for n in each)
    return (
        f"title: Device {device}\n\ntopics:\n{topics}\nmeasured:\n{measured}\noutput:\n{output}\nabilities:\n{written}"
    )


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as temporary:
        measure("1000 written", write_station(Path(temporary) / "written", 1000, with_places=False))
        measure("100 for 10 places", write_station(Path(temporary) / "places", 100, with_places=True))


def measure(name: str, folder: Path) -> None:
    """What the station in `folder` costs."""
    texts = [path.read_text(encoding="utf-8") for path in folder.glob("**/*.yaml")]
    ours = seconds(lambda: read_each(compose, texts))
    reference = seconds(lambda: read_each(compose_slowly, texts), 1)
    station = load_station(folder)
    inferred = with_inferred_variables(station, load_messages(station))
    abilities = len(ground(inferred).abilities)
    lines = sum(text.count("\n") for text in texts)
    print(f"{name}: {abilities} abilities, {lines} lines in {len(texts)} files")
    print(f"  compose the YAML   {ours:7.3f} s   ruamel.yaml alone {reference:.3f} s, ratio {reference / ours:.1f}")
    print(f"  load               {seconds(lambda: load_station(folder)):7.3f} s")
    print(f"  ground             {seconds(lambda: ground(inferred)):7.3f} s")
    print(f"  ready to run       {seconds(lambda: prepare_station(folder)):7.3f} s")
    checked = check_model(folder, Limits())
    whole = seconds(lambda: check_model(folder, Limits()))
    print(f"  load and check all {whole:7.3f} s   {len(checked.findings)} findings")


def read_each(read: Callable[[str], object], texts: list[str]) -> None:
    """Read all texts, one after the other, and keep nothing."""
    for text in texts:
        read(text)


def seconds(work: Callable[[], object], repeats: int = REPEATS) -> float:
    """Median time of `work`."""
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        work()
        times.append(time.perf_counter() - began)
    return statistics.median(times)


if __name__ == "__main__":
    main()
