"""The running station.

`execution` takes ticks and follows plans, free of clock, network and threads. Around it: `feeds` and `commander` speak
to the devices, `planner_process` has plans computed, `tasks` waits for people, `alarms` and `viewing` say how things
stand, and `controller` brings them together on one event loop, in the process that `process` starts. `preparation`
holds what synthesis finds before that and meanwhile.
"""
