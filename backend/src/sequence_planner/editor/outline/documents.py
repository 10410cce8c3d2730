"""The documents that an outline becomes: the station, its devices, what is wanted, what must never be, and a test."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import chain, count

from sequence_planner.editor.outline.devices import BETWEEN, SUPPLY, enumerations_of, files_of, rest_of
from sequence_planner.editor.outline.facts import STEP, condition_of, sentence_of
from sequence_planner.editor.outline.outline import Fact, Never, Outline, OutlineStep, Robot
from sequence_planner.editor.outline.writing import enumeration, in_both, in_one_line, spoken, titled
from sequence_planner.editor.outline.wrong import problems_of
from sequence_planner.model.yaml.editor import in_brackets

LONGEST_NAME = 60  # of what must never be

# Not finished outlines are none of its concern: `problems_of` tells what is missing.


def files_made_of(outline: Outline, name: str) -> dict[str, str]:
    """Return the files of a station called `name`, by their paths. Raises `ValueError` for an outline with problems."""
    if problems_of(outline):
        raise ValueError("an outline with problems")
    messages = f"{name}_msgs"
    files = {"station.yaml": _station(outline, name)}
    for each in outline.devices:
        files |= files_of(each, outline.product, messages)
    if outline.product.then == "next":
        files[f"resources/{SUPPLY}.yaml"] = _supply(outline)
    files["operations.yaml"] = _operations(outline)
    if outline.product.then == "order":
        files["work_masters.yaml"] = _work_master(outline)
    if outline.never:
        files["specifications.yaml"] = _specifications(outline)
    files["tests/first.yaml"] = _test(outline)
    return files


def _station(outline: Outline, name: str) -> str:
    product, title = outline.product, spoken(outline.title)
    sections = [f"name: {name}\n" + (f"title: {in_brackets(title)}\n" if title else "")]
    enumerations = enumeration(f"{product.name}_state", product.states)
    for device in outline.devices:
        for each, (values, before) in enumerations_of(device, product).items():
            enumerations += enumeration(each, values, before)
        if isinstance(device, Robot):
            between = in_both("on its way", "på väg")
            enumerations += (
                f"  {device.name}_place: # where it can be; it is sent to a pose\n    values: [{BETWEEN}]\n"
                f"    includes: [{device.name}_pose]\n    titles:\n      {BETWEEN}: {between}\n"
            )
    sections.append(f"enumerations:\n{enumerations}")
    sections.append(
        "# No sensor sees it: it follows from what has been done.\nestimated:\n"
        f"  {product.name}: {{type: {product.name}_state, title: {in_brackets(titled(product))}}}\n"
    )
    if rest := [each for device in outline.devices for each in rest_of(device)]:
        told = " and\n  ".join(rest)
        sections.append(
            "# The station can always be brought back to this: nothing is started that would make it impossible.\n"
            f"rest: >-\n  {told}\n"
        )
    return "\n".join(sections)


def _supply(outline: Outline) -> str:
    product = outline.product
    title = titled(product)
    return f"""# Where the next product comes from. Give it a device, if one brings them.
title: {in_both(f"Supply of {title}", f"Tillförsel av {title}")}

abilities:
  next:
    title: {in_both(f"Bring in the next one: {title}", f"Hämta in nästa: {title}")}
    enabled: {product.name} == {product.states[-1].name}
    start:
      do: [{product.name} := {product.states[0].name}]
"""


def _operations(outline: Outline) -> str:
    product = outline.product
    entries = [
        f"{each}:\n  title: {in_brackets(titled(step))}\n"
        f"  precondition: {product.name} == {before.name}\n  goal: {product.name} == {after.name}\n"
        for (each, step), before, after in zip(_wanted(outline), product.states, product.states[1:], strict=False)
    ]
    if product.then == "next":
        title = in_both(f"Next one: {titled(product)}", f"Nästa: {titled(product)}")
        first, last = product.states[0].name, product.states[-1].name
        entries.append(
            f"next_{product.name}:\n  title: {title}\n"
            f"  precondition: {product.name} == {last}\n  goal: {product.name} == {first}\n"
        )
    return "\n".join(entries)


def _wanted(outline: Outline) -> Iterator[tuple[str, OutlineStep]]:
    """The operations by their names: as the steps are called, with the device where others are called so too."""
    steps = outline.product.steps
    called = [each.name for each in steps]
    for step in steps:
        yield (step.name if called.count(step.name) == 1 else f"{step.name}_by_{step.by}"), step


def _work_master(outline: Outline) -> str:
    product = outline.product
    return (
        f"{product.name}:\n  title: {in_brackets(titled(product))}\n"
        f"  brings: [{product.name} := {product.states[0].name}]\n"
        f"  sequence: {in_one_line(each for each, _ in _wanted(outline))}\n"
    )


def _specifications(outline: Outline) -> str:
    entries, taken = list[str](), set[str]()
    for each in outline.never:
        title = spoken(each.title) or sentence_of(each, outline)
        name = _free(_called(each), taken)
        taken.add(name)
        facts = condition_of(each.facts, outline)
        if each.during:
            said = f"  never: {facts}\n  while: {condition_of(each.during, outline)}\n"
        else:
            said = f"  forbidden: {facts}\n"
        entries.append(f"{name}:\n  title: {in_brackets(title)}\n{said}")
    return "\n".join(entries)


def _called(never: Never) -> str:
    """What must never be, as a name: `never_arm_fixture_and_clamp_open`."""
    facts, during = ("_and_".join(_fact_name(each) for each in part) for part in (never.facts, never.during))
    name = f"never_{facts}_while_{during}" if during else f"never_{facts}"
    return name if len(name) <= LONGEST_NAME else "never"


def _fact_name(fact: Fact) -> str:
    """The thing and its value; of a step the step alone, which is under way."""
    thing = fact.thing.rpartition(".")[2] if fact.thing.startswith(STEP) else f"{fact.thing}_{fact.value}"
    return thing if fact.holds else f"not_{thing}"


def _free(name: str, taken: Collection[str]) -> str:
    """The name, or with a number behind it where others have it."""
    return next(each for each in chain([name], (f"{name}_{n}" for n in count(2))) if each not in taken)


def _test(outline: Outline) -> str:
    product = outline.product
    wanted = [each for each, _ in _wanted(outline)]
    if product.then == "next":  # what was left behind by the one is met by the other
        wanted = [*wanted, f"next_{product.name}", *wanted]
    steps = "".join(f"    - completes: {each}\n      within: 120\n" for each in wanted)
    return (
        "# `sequence-planner test`, and Tests in the browser, carry this out in simulated time with emulated devices.\n"
        f"one_is_made:\n  title: {in_both(f'One is made: {titled(product)}', f'En tillverkas: {titled(product)}')}\n"
        f"  steps:\n{steps}"
    )
