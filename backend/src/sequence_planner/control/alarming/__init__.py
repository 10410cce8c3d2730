"""Alarms after ISA-18.2: why there is one (`of_…`), what is one alarm (`folding`), and what becomes of it (`life`)."""
