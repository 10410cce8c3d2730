"""Supervisor synthesis: the starts that must wait so that nothing forbidden happens and rest stays reachable.

`enumeration` follows the definition of `docs/semantics.md`, "Supervisor", state by state.
"""
