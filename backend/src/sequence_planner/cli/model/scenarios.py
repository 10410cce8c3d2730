"""`test`: carry out the scenarios of a station in simulated time, and say which did not come about."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Annotated
from xml.etree import ElementTree

import typer

from sequence_planner.cli.analysing import USUAL_DEADLINE, Deadline, Limits, supervisor_of
from sequence_planner.cli.loading import usable_model
from sequence_planner.cli.options import (
    FINDINGS,
    USUAL_MEMORY,
    AsJson,
    Memory,
    StationFolder,
    print_json,
    refuse,
)
from sequence_planner.core.numerals import counted
from sequence_planner.editor.simulating.scenario_run import ScenarioRun, not_exercised, run_scenarios
from sequence_planner.editor.simulating.simulation import SimulatedMoment
from sequence_planner.editor.usable import Usable
from sequence_planner.language.printer import print_value
from sequence_planner.model.paths import EditError
from sequence_planner.process.budget import Budget
from sequence_planner.scenarios.scenario import Scenario, named_scenario, scenarios_of
from sequence_planner.synthesis.supervisor import SynthesisError

_LAST = 5  # moments that are told of a scenario that failed
_NAMED = 6  # names in one line

# A run, and how many seconds the machine needed for it.
Timed = tuple[ScenarioRun, float]


def test(
    model: StationFolder,
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[SCENARIO]...", help="Those to carry out; without names all.")
    ] = None,
    junit: Annotated[
        Path | None, typer.Option("--junit", metavar="FILE", help="Write what was found as JUnit XML, too.")
    ] = None,
    deadline: Deadline = USUAL_DEADLINE,
    memory: Memory = USUAL_MEMORY,
    json: AsJson = False,
) -> None:
    """Carry out the scenarios of a station, which stand in its `tests`, in simulated time with emulated devices.

    There is a line for each; below one that failed stands what happened last. The exit code is 1 where one failed, and
    2 where one of them cannot be carried out: what is wrong with it goes to standard error, and none is carried out.
    With --json: {model, scenarios: [{name, title, file, line, passed, seconds, failure}], not_exercised: {abilities,
    operations}}, or {model, scenarios, wrong: [{file, line, column, message}]}; `seconds` are those of simulated time,
    and `failure` is {file, line, column, message} or null.
    """
    limits = Limits(deadline, memory)
    if junit is not None and (junit.is_dir() or not junit.parent.is_dir()):
        refuse(f"{junit}: no file can be written there: name one in a folder that exists")
    meant, chosen = _read(model, limits, names or (), json=json)
    runs: list[Timed] = []
    began = time.monotonic()
    for run in run_scenarios(meant, chosen, Budget.seconds(limits.left)):
        runs.append((run, time.monotonic() - began))
        began = time.monotonic()
        if not json:
            typer.echo("\n".join(_run_lines(run)))
    if junit is not None:
        _write_junit(junit, meant.automaton.title, runs)
    unused = not_exercised(meant, [run for run, _ in runs])
    if json:
        documents = [_document(run) for run, _ in runs]
        print_json({"model": str(model), "scenarios": documents, "not_exercised": unused})
    else:
        typer.echo("\n".join(_summary_lines(runs, {} if names else unused)))
    if any(run.failure is not None for run, _ in runs):
        raise typer.Exit(FINDINGS)


def _read(model: Path, limits: Limits, names: Sequence[str], *, json: bool) -> tuple[Usable, list[Scenario]]:
    """Return what a station means, and its scenarios, or those with these names; end with what keeps any of them from
    being carried out.
    """
    station = usable_model(model).station
    if station is None or station.written is None:
        refuse(f"{model}: scenarios are those of a station, and this is a plain automaton")
    scenarios, wrong = scenarios_of(station.automaton, station.written, station.pipelines)
    if wrong and not (names and set(names) <= {each.name for each in scenarios}):
        if json:
            documents = [{**each.place._asdict(), "message": str(each.message)} for each in wrong]
            print_json({"model": str(model), "scenarios": [], "wrong": documents})
        refuse("\n".join(map(str, wrong)))
    if not scenarios:
        refuse(f"{model}: there are no scenarios: write one in {model / 'tests'}, in a file such as work.yaml")
    try:
        chosen = [named_scenario(scenarios, name) for name in dict.fromkeys(names)] or scenarios
        return Usable(station, supervisor_of(station.automaton, limits)), chosen
    except EditError as error:
        refuse(str(error.why))
    except SynthesisError as error:
        refuse(f"{model}: {error}")


def _run_lines(run: ScenarioRun) -> Iterator[str]:
    seconds = f"{run.seconds:.1f} s"
    if run.failure is None:
        yield f"passed  {run.scenario.name}  {seconds}"
        return
    yield f"FAILED  {run.scenario.name}  {seconds}"
    yield f"  {run.failure.place}: {run.failure.why}"
    for moment in run.moments[-_LAST:]:
        if said := _moment_text(moment):
            yield f"    {moment.seconds:6.1f} s  {said}"


def _moment_text(moment: SimulatedMoment) -> str:
    """Say what happened in a moment: what somebody did, what started and ended, and else what changed."""
    said = [*map(str, moment.began), *(f"{name} := {print_value(value)}" for name, value in moment.sets.items())]
    said += [f"{name} is done" for name in moment.done]
    said += [f"{name} starts" for name in moment.started] + [f"{name} ends" for name in moment.ended]
    said += [f"{name} is completed" for name in sorted(moment.completed)]
    if not said:
        values = {name: after for name, (_, after) in moment.changes.items()}
        said = [f"{name}: {'not known' if value is None else print_value(value)}" for name, value in values.items()]
    return ", ".join(said)


def _summary_lines(runs: Sequence[Timed], unused: Mapping[str, Sequence[str]]) -> Iterator[str]:
    failed = sum(run.failure is not None for run, _ in runs)
    yield f"{counted(len(runs), 'scenario')}: {len(runs) - failed} passed, {failed} failed"
    for what, names in unused.items():
        if names:
            more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
            yield f"{what} in none of them: {', '.join(names[:_NAMED])}{more}"


def _document(run: ScenarioRun) -> dict[str, object]:
    scenario, failure = run.scenario, None
    if run.failure is not None:
        place = run.failure.place
        failure = {"file": place.file, "line": place.line, "column": place.column, "message": str(run.failure.why)}
    return {
        "name": scenario.name,
        "title": scenario.title,
        "file": scenario.place.file,
        "line": scenario.place.line,
        "passed": run.failure is None,
        "seconds": round(run.seconds, 1),
        "failure": failure,
    }


def _write_junit(path: Path, title: str, runs: Sequence[Timed]) -> None:
    """Write what was found as JUnit XML, as build servers read it."""
    failed = sum(run.failure is not None for run, _ in runs)
    took = sum(seconds for _, seconds in runs)
    counts = {"tests": str(len(runs)), "failures": str(failed), "errors": "0", "time": f"{took:.3f}"}
    suites = ElementTree.Element("testsuites", counts)
    suite = ElementTree.SubElement(suites, "testsuite", {"name": title, **counts})
    for run, seconds in runs:
        place = run.scenario.place
        case = ElementTree.SubElement(
            suite,
            "testcase",
            {
                "name": run.scenario.name,
                "classname": Path(place.file).stem,
                "file": place.file,
                "line": str(place.line),
                "time": f"{seconds:.3f}",
            },
        )
        if run.failure is not None:
            failure = ElementTree.SubElement(case, "failure", {"message": str(run.failure.why)})
            failure.text = "\n".join(_run_lines(run))
    ElementTree.indent(suites)
    try:
        path.write_bytes(ElementTree.tostring(suites, encoding="utf-8", xml_declaration=True) + b"\n")
    except OSError as error:
        refuse(f"{path}: {error.strerror}")
