"""Alarms after ISA-18.2: why there is one (`…_conditions`), what is one alarm, and what becomes of it (`manager`)."""
