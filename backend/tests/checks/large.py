"""A station of many abilities, as it is written: robots with grippers around tables that they share."""

from __future__ import annotations

from pathlib import Path

STATION = """
name: large
enumerations:
  place: [home, above, left, right, out]
  pose: [home, above, left, right, out, between]
  part: [none, raw, done]
estimated:
{tables}
rest: true
"""

ROBOT = """
measured:
  pose: {type: pose, initial: home}
  closed: {type: bool}
  opened: {type: bool, initial: true}
output:
  target: {type: place, initial: home}
  grip: {type: bool}
estimated:
  holds: {type: part, initial: none}
  cycles: {type: 0..3}
abilities:
  move:
    parameters: {to: place}
    enabled: target == pose and pose != to and (pose == above or to == above)
    start: {do: [target := to]}
    executing: target == to and pose != to
    finish: {when: target == to and pose == to}
    effects:
      leaves: {kind: starting, when: target != pose and pose != between, do: [pose := between]}
      arrives: {kind: executing, when: target != pose and pose == between, do: [pose := target]}
  pick:
    enabled: not grip and opened and pose == left and holds == none and %(here)s != none
    start: {do: [grip := true]}
    executing: grip and not closed
    finish: {when: grip and closed and pose == left and %(here)s != none, do: ["holds := %(here)s", "%(here)s := none"]}
    effects:
      closes: {kind: executing, when: grip and not closed, do: [closed := true, opened := false]}
  put:
    enabled: grip and closed and pose == right and holds == done and %(there)s == none
    start: {do: [grip := false]}
    executing: not grip and not opened
    finish:
      when: not grip and opened and pose == right and holds == done and %(there)s == none
      do: ["holds := none", "%(there)s := raw"]
    effects:
      opens: {kind: executing, when: not grip and not opened, do: [closed := false, opened := true]}
  work:
    enabled: pose == out and holds == raw
    start: {do: [holds := done]}
  count:
    enabled: pose == home and holds == done and cycles < 3
    start: {do: [cycles := cycles + 1]}
  restart_cycles:
    enabled: cycles == 3
    start: {do: [cycles := 0]}
"""


def write_large_station(folder: Path, robots: int = 100) -> Path:
    """Write a station with ten ground abilities for each of so many robots."""
    (folder / "resources").mkdir(parents=True)
    tables = "\n".join(f"  table_{number}: {{type: part, initial: raw}}" for number in range(robots))
    (folder / "station.yaml").write_text(STATION.format(tables=tables), encoding="utf-8")
    for number in range(robots):
        tables_beside = {"here": f"table_{number}", "there": f"table_{(number + 1) % robots}"}
        (folder / "resources" / f"robot_{number}.yaml").write_text(ROBOT % tables_beside, encoding="utf-8")
    return folder
