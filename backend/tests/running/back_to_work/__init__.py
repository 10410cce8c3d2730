"""Stations that are stopped and get back to work, by somebody who knows no more than a person beside them does.

`floor` is what such a person's hands reach, `person` what is done through REST, `stops` how a station is stopped, and
`bolts` and `engine` are the two stations with what is true of what they build. `ways` goes through some ways.
"""
