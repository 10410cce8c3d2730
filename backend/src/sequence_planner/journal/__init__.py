"""The durable record of who did what (`audit`) and of what has happened (`run_journal`), chained and signed."""
