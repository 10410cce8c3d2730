"""Documents of an outline's devices: a resource each, and the messages that it says and is told."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from sequence_planner.editor.outline.outline import (
    Clamp,
    Device,
    FoundDevice,
    OutlineItem,
    OutlineStep,
    PersonDevice,
    Product,
    Robot,
    Tool,
)
from sequence_planner.editor.outline.writing import all_of, camel, in_both, in_one_line, stands, titled
from sequence_planner.model.yaml.editor import in_brackets

# Each of these devices is a shape that devices have again and again. Its document is written out, so that it can be
# changed like any other: it begins as a whole that is checked, plans and can be emulated.

BETWEEN = "between"
NOTHING = "nothing"
SUPPLY = "supply"  # the resource that brings the next product


@dataclass(frozen=True)
class Work:
    """A step that a device does, with the states of the `product` before and after it."""

    step: OutlineStep
    product: str
    before: str
    after: str

    @property
    def is_due(self) -> str:
        """The condition that the product is as the step finds it."""
        return f"{self.product} == {self.before}"

    @property
    def done(self) -> str:
        """The action that tells what has become of the product."""
        return f"{self.product} := {self.after}"


def works_of(device: OutlineItem, product: Product) -> list[Work]:
    """Return the steps that a device does, in order."""
    return [
        Work(step, product.name, before.name, after.name)
        for step, before, after in zip(product.steps, product.states, product.states[1:], strict=False)
        if step.by == device.name
    ]


def files_of(device: Device, product: Product, messages: str) -> Mapping[str, str]:
    """Return the files of a device, by their paths; `messages` is the package of the definitions."""
    works = works_of(device, product)
    match device:
        case Robot():
            return _robot(device, messages)
        case Tool():
            return _tool(device, works, messages)
        case Clamp():
            return _clamp(device, works, messages)
        case PersonDevice():
            return _person(device, works)
        case FoundDevice():
            return {_path(device): f"title: {in_brackets(titled(device))}\n"}


def enumerations_of(device: Device, product: Product) -> Mapping[str, tuple[list[OutlineItem], dict[str, str]]]:
    """Return the enumerations that a device needs: their values, and those before these with titles as YAML."""
    match device:
        case Robot():
            return {f"{device.name}_pose": (list(device.poses), {})}
        case PersonDevice():
            steps: list[OutlineItem] = [each.step for each in works_of(device, product)]
            return {f"{device.name}_request": (steps, {NOTHING: in_both("do nothing", "inte göra något")})}
        case _:
            return {}


def rest_of(device: Device) -> list[str]:
    """Return the conditions that a device is at rest."""
    name = device.name
    match device:
        case Robot():
            home = device.poses[0].name
            return [f"{name}.place == {home}", f"{name}.target == {home}"]
        case Tool():
            return [f"not {name}.run", f"not {name}.is_running", f"not {name}.is_done"]
        case Clamp():
            return [f"{name}.is_open", f"not {name}.close_it"]
        case PersonDevice():
            return [f"{name}.request == {NOTHING}", f"not {name}.is_acknowledged"]
        case FoundDevice():
            return []


def _path(device: OutlineItem) -> str:
    return f"resources/{device.name}.yaml"


def _definition(device: OutlineItem, kind: str, messages: str, fields: str) -> dict[str, str]:
    return {f"messages/{messages}/msg/{camel(device.name)}{kind}.msg": fields}


def _topics(device: OutlineItem, messages: str, state: str = "", command: str = "") -> str:
    """The two topics of a device, each with the lines of its pipeline."""
    of = f"{messages}/msg/{camel(device.name)}"
    heard = f"  /{device.name}/state:\n    type: {of}State\n    direction: in\n    deadline: 1.0\n{state}"
    told = f"  /{device.name}/command:\n    type: {of}Command\n    direction: out\n    every: 0.5\n{command}"
    return f"title: {in_brackets(titled(device))}\n\ntopics:\n{heard}{told}"


def _robot(robot: Robot, messages: str) -> dict[str, str]:
    name, title, home = robot.name, titled(robot), robot.poses[0].name
    count = len(robot.poses[0].joints)
    state = command = ""
    if count:
        angles = "".join(f"            {each.name}: {in_one_line(map(_number, each.joints))}\n" for each in robot.poses)
        state = (
            "    pipeline:\n      - discretise:\n          field: joint_positions\n          variable: place\n"
            f"          otherwise: {BETWEEN}\n          tolerance: 0.02\n          values: &poses # rad or m\n{angles}"
        )
        command = (
            "    pipeline:\n      - undiscretise:\n          variable: target\n          field: joint_positions\n"
            "          values: *poses\n"
        )
    row = robot.ways == "row" and len(robot.poses) > 2
    ways = ""
    if row:
        pairs = [(one.name, other.name) for one, other in zip(robot.poses, robot.poses[1:], strict=False)]
        told = in_one_line(f"[{one}, {other}], [{other}, {one}]" for one, other in pairs)
        ways = (
            "# The poses stand in a row: it goes from each to those beside it.\nrelations:\n  beside:\n"
            f"    between: [{name}_place, {name}_pose]\n    pairs: {told}\n\n"
        )
    enabled = "target == place and place != pose" + (" and beside(place, pose)" if row else "")
    document = f"""{_topics(robot, messages, state, command)}
measured:
  place:
    type: {name}_place
    initial: {home}
    title: {in_both(f"pose of {title}", f"läget för {title}")}
    phrase: {in_both(f"{title} is in the pose {{value}}", f"{title} är i läget {{value}}")}

output:
  target:
    type: {name}_pose
    initial: {home}
    title: {in_both(f"target of {title}", f"målet för {title}")}
    phrase: {in_both(f"{title} is sent to the pose {{value}}", f"{title} är skickad till läget {{value}}")}

{ways}abilities:
  move_to:
    title: {in_both(f"Move {title} to the pose {{pose}}", f"Kör {title} till läget {{pose}}")}
    parameters: {{pose: {name}_pose}}
    timeouts: {{react: 2, finish: 30}}
    duration: [1, 3]
    enabled: {enabled}
    start:
      do: [target := pose]
    executing: target == pose and place != pose
    finish:
      when: executing and place == pose
    effects:
      leaves:
        kind: starting
        when: target != place and place != {BETWEEN}
        do: [place := {BETWEEN}]
        takes: [0.1, 0.3]
      arrives:
        kind: executing
        when: target != place and place == {BETWEEN}
        do: [place := target]
        takes: [1, 2]
"""
    joints = f"float64[{count}] joint_positions\n"
    return {
        _path(robot): document,
        **_definition(robot, "State", messages, joints if count else "string place\n"),
        **_definition(robot, "Command", messages, joints if count else "string target\n"),
    }


def _number(angle: float) -> str:
    """A number as it is written, with its point."""
    text = f"{angle:.6f}".rstrip("0")
    return f"{text}0" if text.endswith(".") else text


def _tool(tool: Tool, works: list[Work], messages: str) -> dict[str, str]:
    title = titled(tool)
    abilities = "".join(_run(work, first=work is works[0]) for work in works)
    document = f"""{_topics(tool, messages)}
measured:
  is_running: {{type: bool, title: {in_both(f"{title} is running", f"{title} är i gång")}}}
  is_done: {{type: bool, title: {in_both(f"{title} is done", f"{title} är klar")}}}

output:
  run: {{type: bool, title: {in_both(f"{title} is told to run", f"{title} är beordrad att köra")}}}
"""
    return {
        _path(tool): document + (f"\nabilities:\n{abilities}" if works else ""),
        **_definition(tool, "State", messages, "bool is_running\nbool is_done\n"),
        **_definition(tool, "Command", messages, "bool run\n"),
    }


def _run(work: Work, *, first: bool) -> str:
    """The ability of one step of a tool. That the tool starts and settles is told once for all of them."""
    step, due = work.step, work.is_due
    begins = ["not run and not is_running and not is_done", due, *stands(step.where)]
    works = ["run and is_running and not is_done", *(f"{each.robot}.place == {each.pose}" for each in step.where)]
    always = """      starts:
        kind: starting
        when: run and not is_running and not is_done
        do: [is_running := true]
        takes: [0.3, 0.6]
      settles:
        kind: finishing
        when: not run and (is_running or is_done)
        do: [is_running := false, is_done := false]
        takes: [0.2, 0.4]
"""
    return f"""  {step.name}:
    title: {in_brackets(titled(step))}
    timeouts: {{react: 5, finish: 30}}
    duration: [2, 4]
    enabled: {all_of(begins)}
    start:
      do: [run := true]
    executing: run and not is_done and {due}
    finish:
      # With the result: a short run could be over before it was seen.
      when: run and is_done and {due}
      do: [run := false, {work.done}]
    cancel:
      do: [run := false]
    effects:
      is_done:
        kind: executing
        when: {all_of(works)}
        do: [is_running := false, is_done := true]
        takes: [1.5, 2.5]
{always if first else ""}"""


def _clamp(clamp: Clamp, works: list[Work], messages: str) -> dict[str, str]:
    title = titled(clamp)
    closing = [each for each in works if each.step.action != "open"]
    opening = [each for each in works if each.step.action == "open"]
    plain = OutlineItem(name="close", title=title), OutlineItem(name="open", title=title)
    # As `problems_of` has it, what is closed by a step is opened by one too.
    abilities = [_turned(each, close=True) for each in closing] or [_turning(plain[0], [], close=True)]
    abilities += [_turned(each, close=False) for each in opening] or [_turning(plain[1], [], close=False)]
    document = f"""{_topics(clamp, messages)}
measured:
  is_open: {{type: bool, initial: true, title: {in_both(f"{title} is open", f"{title} är öppen")}}}
  is_closed: {{type: bool, title: {in_both(f"{title} is closed", f"{title} är stängd")}}}

output:
  close_it: {{type: bool, title: {in_both(f"{title} is told to close", f"{title} är beordrad att stänga")}}}

abilities:
{"".join(abilities)}"""
    return {
        _path(clamp): document,
        **_definition(clamp, "State", messages, "bool is_open\nbool is_closed\n"),
        **_definition(clamp, "Command", messages, "bool close_it\n"),
    }


def _turned(work: Work, *, close: bool) -> str:
    """The ability of a step that closes or opens."""
    return _turning(work.step, [work.is_due, *stands(work.step.where)], close=close, work=work)


def _turning(named: OutlineItem, conditions: list[str], *, close: bool, work: Work | None = None) -> str:
    at, to = ("is_open", "is_closed") if close else ("is_closed", "is_open")
    told, not_told = ("close_it", "not close_it") if close else ("not close_it", "close_it")
    both = (
        (f"Close {named.title}", f"Stäng {named.title}") if close else (f"Open {named.title}", f"Öppna {named.title}")
    )
    title = in_both(*both) if work is None else in_brackets(titled(named))
    due = "" if work is None else f" and {work.is_due}"
    done = "" if work is None else f"\n      do: [{work.done}]"
    return f"""  {named.name}:
    title: {title}
    timeouts: {{finish: 10}}
    duration: 1
    enabled: {all_of([f"{not_told} and {at}", *conditions])}
    start:
      do: [close_it := {str(close).lower()}]
    executing: {told} and not {to}{due}
    finish:
      when: {told} and {to}{due}{done}
    effects:
      leaves:
        kind: starting
        when: {told} and {at}
        do: [{at} := false]
        takes: [0.1, 0.2]
      arrives:
        kind: executing
        when: {told} and not {at} and not {to}
        do: [{to} := true]
        takes: [0.5, 1]
"""


def _person(person: PersonDevice, works: list[Work]) -> dict[str, str]:
    name, title = person.name, titled(person)
    acknowledged = in_both(f"{title} has acknowledged the task", f"{title} har kvitterat uppgiften")
    request = in_both(f"task of {title}", f"uppgiften för {title}")
    asked = in_both(f"{title} is asked to “{{value}}”", f"{title} är ombedd att ”{{value}}”")
    document = f"""title: {in_brackets(title)}

topics:
  # Whoever likes to listen hears what the person is asked for. The person sees it on the watch page.
  /{name}/task:
    type: std_msgs/msg/String
    direction: out
    every: 1.0
    pipeline:
      - rename: {{data: request}}

measured:
  is_acknowledged: {{type: bool, title: {acknowledged}}} # by the watch page

output:
  request:
    type: {name}_request
    title: {request}
    phrase: {asked}
"""
    abilities = "".join(_task(work, first=work is works[0]) for work in works)
    return {_path(person): document + (f"\nabilities:\n{abilities}" if works else "")}


def _task(work: Work, *, first: bool) -> str:
    """The ability of one task of a person. What a person does is told once for all of them."""
    step = work.step
    begins = [f"request == {NOTHING} and not is_acknowledged", work.is_due, *stands(step.where)]
    always = f"""    effects:
      acknowledges:
        kind: executing
        when: request != {NOTHING} and not is_acknowledged
        do: [is_acknowledged := true]
        takes: [3, 6]
      is_free:
        kind: finishing
        when: request == {NOTHING} and is_acknowledged
        do: [is_acknowledged := false]
        takes: 0
"""
    return f"""  {step.name}:
    title: {in_brackets(titled(step))}
    human: {{task: {in_brackets(_sentence(titled(step)))}, acknowledgement: is_acknowledged}}
    duration: [3, 20]
    enabled: {all_of(begins)}
    start:
      do: [request := {step.name}]
    executing: request == {step.name} and not is_acknowledged
    finish:
      when: request == {step.name} and is_acknowledged
      do: [request := {NOTHING}, {work.done}]
{always if first else ""}"""


def _sentence(text: str) -> str:
    """A text as a sentence: with a full stop, unless it ends otherwise."""
    return text if re.search(r"[.!?]$", text) else f"{text}."
