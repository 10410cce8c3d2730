"""The running station around the pure core of `execution`.

`io` speaks to the devices, `planner_client` has plans computed, `commands` and queries come from people, `alarms`
and `views` say how things stand, `recovery` gets the station going again, and `controller` brings them together on
one event loop, in the process that `service` starts. `preparation` holds what synthesis finds before that and
meanwhile.
"""
