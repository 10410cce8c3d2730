"""What a schedule means for the controller: which operations wait for which of other jobs."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from sequence_planner.mes.sequencing.work import Schedule, Step, Work


def waits_among(
    works: Sequence[Work], schedule: Schedule, jobs: Collection[str] | None = None
) -> dict[Step, list[Step]]:
    """Which operations of these jobs (all: None) wait for which of others of them, and for no more than is needed.

    Two operations of different jobs with a common resource are worked in the order in which they are expected to start.
    Left out is what follows from the rest and from the order inside the jobs. So one that waits for another through a
    third waits for it directly where the job of the third is not among these.
    """
    steps = [
        (schedule.starts[work.job, name][0], number, name)
        for number, work in enumerate(works)
        if jobs is None or work.job in jobs
        for name in work.operations
    ]
    return _waits(works, _before_each_other(works, steps))


def _before_each_other(works: Sequence[Work], steps: list[tuple[float, int, str]]) -> list[tuple[int, str]]:
    """By start; those that have started come first."""
    fresh = {(number, name): works[number].operations[name].started is None for _, number, name in steps}
    return [(number, name) for _, number, name in sorted(steps, key=lambda each: (fresh[each[1], each[2]], each))]


def _waits(works: Sequence[Work], order: list[tuple[int, str]]) -> dict[Step, list[Step]]:
    """Sets of steps are the bits of numbers: there can be thousands, each with thousands before it."""
    place = {step: number for number, step in enumerate(order)}
    before = [0] * len(order)  # all that a step comes after
    on_resource, of_job = dict[str, int](), dict[int, int]()
    found: dict[Step, list[Step]] = {}
    for number, (job, name) in enumerate(order):
        operation = works[job].operations[name]
        for each in sorted(operation.after):
            if (earlier := place.get((job, each))) is not None and earlier < number:
                before[number] |= before[earlier] | 1 << earlier
        if operation.started is None:
            others = 0
            for resource in operation.resources:
                others |= on_resource.get(resource, 0)
            others &= ~of_job.get(job, 0) & ~before[number]
            direct: list[Step] = []
            while others:  # the latest first: what it comes after is said by it
                latest = others.bit_length() - 1
                direct.append((works[order[latest][0]].job, order[latest][1]))
                before[number] |= before[latest] | 1 << latest
                others &= ~before[number]
            if direct:
                found[works[job].job, name] = sorted(direct)
        of_job[job] = of_job.get(job, 0) | 1 << number
        for resource in operation.resources:
            on_resource[resource] = on_resource.get(resource, 0) | 1 << number
    return found
