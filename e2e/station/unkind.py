"""A station that is unkind to pages: nothing has a title, names are of 80 characters, and there is much of everything.

`unkind.py FOLDER` writes its model, `unkind.py FOLDER --hostile` with a picture as well that binds what is not there,
and with drawings that would run, load or never end, were they drawn as they are written.
"""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

RESOURCES, OPERATIONS, ALARMS, LENGTH = 40, 60, 12, 80
DEVICES = 20  # resources that have one: each is a node of its own on the network
LEVELS = 4  # of a part: three starts from the first to the last
TYPE = "unkind_msgs/msg"
WORDS = "somebody_who_had_much_time_and_no_mercy_has_given_this_a_name_that_goes_on_and_on_until_it_ends"
ONE_WORD = "donaudampfschiffahrtselektrizitaetenhauptbetriebswerkbauunterbeamtengesellschaftswagen"

# Each would call `globalThis.ran`, or ask a server, in one way that a browser knows.
DRAWINGS = {
    "script": '<script>globalThis.ran = "script"</script><script href="http://127.0.0.1:9/script.js"/>',
    "handler": '<rect width="50" height="40" onload="globalThis.ran = 1" onclick="globalThis.ran = 1" '
    'fill="url(http://127.0.0.1:9/f)"/>',
    "link": '<a href="javascript:globalThis.ran = 1"><rect width="100" height="60"/></a>'
    '<g href="javascript:globalThis.ran = 1"/>',
    "foreign": '<foreignObject width="100" height="60">'
    '<img xmlns="http://www.w3.org/1999/xhtml" src="x" onerror="globalThis.ran = 1"/>'
    '<iframe xmlns="http://www.w3.org/1999/xhtml" src="javascript:parent.ran = 1"/></foreignObject>',
    "style": '<style>@import "http://127.0.0.1:9/s.css"; rect { fill: url(http://127.0.0.1:9/p.svg#p) }</style>'
    '<rect width="100" height="60" style="fill: url(http://127.0.0.1:9/q.svg#q); background: url(http://127.0.0.1:9/b.png)"/>',
    "use": '<use href="http://127.0.0.1:9/u.svg#u"/><use href="data:image/svg+xml;base64,PHN2Zy8+#u"/>'
    '<image href="http://127.0.0.1:9/i.png" width="100" height="60"/>',
    "animate": '<a><animate attributeName="href" values="javascript:globalThis.ran = 1"/>'
    '<set attributeName="onclick" to="ran = 1"/><rect width="100" height="60"/></a>',
    "itself": '<g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g>',
}
BOMB = (
    '<!DOCTYPE svg [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;"><!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;">'
    '<!ENTITY f SYSTEM "file:///etc/hostname">]>'
)
BROKEN = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 60"><g><rect width="100"'


def name(kind: str, number: int) -> str:
    """A name of 80 characters; every third one is a single word."""
    end = f"_{kind}_{number:02}"
    return (WORDS if number % 3 else ONE_WORD)[: LENGTH - len(end)].rstrip("_") + end


def resource(number: int) -> str:
    """What works on its parts, each with an ability: a device with its own command and answer, or by thought alone."""
    if number >= DEVICES:
        return "abilities:\n" + "".join(
            f"  {name('work', part)}:\n    parameters: {{level: lower}}\n"
            f"    enabled: {name('part', part)} == level and is_there\n"
            f"    start: {{do: ['{name('part', part)} := higher[level]']}}\n"
            for part in range(number, OPERATIONS, RESOURCES)
        )
    abilities = []
    for part in range(number, OPERATIONS, RESOURCES):
        abilities.append(f"""\
  {name("work", part)}:
    parameters: {{level: lower}}
    timeouts: {{finish: 60}}
    duration: [2, 3]
    enabled: {name("part", part)} == level and not {name("told", number)} and not {name("busy", number)} and is_there
    start: {{do: [{name("told", number)} := true]}}
    executing: {name("told", number)} and not {name("busy", number)}
    finish:
      when: {name("told", number)} and {name("busy", number)} and {name("part", part)} == level
      do: [{name("told", number)} := false, "{name("part", part)} := higher[level]"]
    effects:
      works: {{kind: executing, when: "{name("told", number)}", do: ["{name("busy", number)} := true"], takes: [2, 3]}}
      rests: {{kind: finishing, when: "not {name("told", number)}", do: ["{name("busy", number)} := false"], takes: 0}}
""")
    return f"""\
topics:
  /unkind/device_{number:02}/state: {{type: {TYPE}/State{number:02}, direction: in, deadline: 5.0}}
  /unkind/device_{number:02}/command: {{type: {TYPE}/Command{number:02}, direction: out, every: 1.0}}
abilities:
{"".join(abilities)}"""


PERSON = f"""\
measured:
  acknowledged: {{type: bool}}
output:
  asked: {{type: bool}}
topics:
  /unkind/person/task: {{type: {TYPE}/Task, direction: out, every: 1.0}}
abilities:
  {name("task", 1)}:
    human: {{task: "{" ".join([WORDS.replace("_", " "), ONE_WORD] * 4)}", acknowledgement: acknowledged}}
    enabled: not is_there and not asked and not acknowledged
    start: {{do: [asked := true]}}
    executing: asked and not acknowledged
    finish: {{when: asked and acknowledged, do: [asked := false, is_there := true]}}
    effects:
      acknowledges: {{kind: executing, when: asked and not acknowledged, do: [acknowledged := true], takes: 5}}
      is_free: {{kind: finishing, when: not asked and acknowledged, do: [acknowledged := false], takes: 0}}
"""


def mimic() -> str:
    """A picture that names what is not there, and draws what nobody may draw."""
    symbols = [
        f"""\
  {each}:
    at: [{20 + 105 * (number % 8)}, {20 + 160 * (number // 8)}]
    size: [100, 140]
    title: {name("title", number)}
    resource: {name("device", number)}
    drawing: drawings/{each}.svg
    text: [{{say: "{{{name("part", number)}}}"}}]
    bind: {{nobody: {{role: high, when: {{nowhere.at_all: true}}}}}}
"""
        for number, each in enumerate([*DRAWINGS, "bomb", "broken", "missing"])
    ]
    return f"""\
size: [872, 346]
symbols:
  nobody: {{at: [700, 180], size: [150, 60], resource: no_such_resource}}
  elsewhere: {{at: [5000, 5000], size: [150, 60], symbol: tank, level: no.such_level}}
{"".join(symbols)}"""


def write(folder: Path, *, is_hostile: bool) -> None:
    """Write the model into an empty folder."""
    messages = folder / "messages" / "unkind_msgs" / "msg"
    messages.mkdir(parents=True)
    (folder / "resources").mkdir()
    (messages / "Task.msg").write_text("bool asked\n")
    levels = [name("level", number) for number in range(LEVELS)]
    parts = "".join(f"  {name('part', number)}: {{type: level}}\n" for number in range(OPERATIONS))
    higher = ", ".join(f"{level}: {next_one}" for level, next_one in pairwise(levels))
    alarms = "".join(
        f"  {name('alarm', number)}: {{when: not is_there, priority: {('high', 'medium', 'low')[number % 3]}}}\n"
        for number in range(ALARMS)
    )
    (folder / "station.yaml").write_text(f"""\
name: {name("station", 1)}
enumerations:
  level: [{", ".join(levels)}]
sets:
  lower: {{of: level, except: [{levels[-1]}]}}
maps:
  higher: {{from: lower, to: level, values: {{{higher}}}}}
estimated:
  is_there: {{type: bool}}
{parts}alarms:
{alarms}""")
    (folder / "operations.yaml").write_text(
        "".join(
            f"{name('operation', number)}: {{precondition: {name('part', number)} == {levels[0]}, "
            f"goal: {name('part', number)} == {levels[-1]}}}\n"
            for number in range(OPERATIONS)
        )
    )
    (folder / "specifications.yaml").write_text("{}\n")
    for number in range(DEVICES):
        (messages / f"State{number:02}.msg").write_text(f"bool {name('busy', number)}\n")
        (messages / f"Command{number:02}.msg").write_text(f"bool {name('told', number)}\n")
    for number in range(RESOURCES):
        (folder / "resources" / f"{name('device', number)}.yaml").write_text(resource(number))
    (folder / "resources" / f"{name('person', 1)}.yaml").write_text(PERSON)
    if is_hostile:
        (folder / "drawings").mkdir()
        (folder / "mimic.yaml").write_text(mimic())
        head = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 60" onload="globalThis.ran = 1">'
        for each, inside in DRAWINGS.items():
            text = f'{head}<circle id="kept" cx="20" cy="30" r="18"/>{inside}</svg>'
            (folder / "drawings" / f"{each}.svg").write_text(text)
        (folder / "drawings" / "bomb.svg").write_text(f"{BOMB}{head}<text>&c;&f;</text></svg>")
        (folder / "drawings" / "broken.svg").write_text(BROKEN)


if __name__ == "__main__":
    write(Path(sys.argv[1]), is_hostile="--hostile" in sys.argv[2:])
