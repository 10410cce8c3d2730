"""A station of presses beside each other, each of which works a part in a fraction of a second: for many orders."""

from __future__ import annotations

from pathlib import Path

STATION = """\
name: presses
title: Presses
enumerations:
  part: [none, raw, stamped, trimmed]
"""

RESOURCE = """\
title: Press {n}
topics:
  /press_{n}/state: {{type: press_msgs/msg/PressState, direction: in, deadline: 2.0}}
  /press_{n}/command: {{type: press_msgs/msg/PressCommand, direction: out, every: 1.0}}
measured:
  down: {{type: bool, initial: false}}
output:
  press: {{type: bool, initial: false}}
estimated:
  part: {{type: part, initial: none}}
abilities:
  feed:
    enabled: not press and not down and part == none
    start: {{do: [part := raw]}}
  # It may have been left closed by whoever decided on its output.
  open:
    enabled: press and part in {{none, trimmed}}
    start: {{do: [press := false]}}
"""

ABILITY = """\
  {name}:
    enabled: not press and not down and part == {before}
    start: {{do: [press := true]}}
    executing: press and not down and part == {before}
    finish: {{when: press and down and part == {before}, do: [press := false, part := {after}]}}
"""

EFFECTS = """\
    effects:
      goes_down: {kind: executing, when: press and not down, do: [down := true], takes: [0.2, 0.4]}
      comes_up: {kind: finishing, when: not press and down, do: [down := false], takes: [0.2, 0.4]}
"""

OPERATIONS = """\
feed_{n}: {{precondition: press_{n}.part == none, goal: press_{n}.part != none}}
stamp_{n}: {{precondition: press_{n}.part == raw, goal: "press_{n}.part in {{stamped, trimmed}}"}}
trim_{n}: {{precondition: press_{n}.part == stamped, goal: press_{n}.part == trimmed}}
"""

WORK_MASTER = """\
part_{n}:
  title: A part of press {n}
  brings: [press_{n}.part := none]
  operations:
    feed_{n}:
    stamp_{n}: {{after: [feed_{n}]}}
    trim_{n}: {{after: [stamp_{n}]}}
"""

MESSAGES = {"PressState": "bool down\n", "PressCommand": "bool press\n"}


def write_presses(folder: Path, presses: int) -> Path:
    """The model of so many presses, in the new folder `folder`; its work masters are `part_1` and so on."""
    numbers = range(1, presses + 1)
    files = {
        "station.yaml": STATION,
        "operations.yaml": "".join(OPERATIONS.format(n=n) for n in numbers),
        "work_masters.yaml": "".join(WORK_MASTER.format(n=n) for n in numbers),
        **{f"messages/press_msgs/msg/{name}.msg": text for name, text in MESSAGES.items()},
        **{f"resources/press_{n}.yaml": _resource(n) for n in numbers},
    }
    for name, text in files.items():
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8")
    return folder


def _resource(number: int) -> str:
    stamp = ABILITY.format(name="stamp", before="raw", after="stamped")
    trim = ABILITY.format(name="trim", before="stamped", after="trimmed")
    return RESOURCE.format(n=number) + stamp + EFFECTS + trim
