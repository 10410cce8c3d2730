"""The variable of the environment that says where a station's database is, for the programs that open it."""

# A URL may hold a password, and what stands on a command line `ps` shows to everybody on the machine.
DATABASE = "SEQUENCE_PLANNER_DATABASE"
