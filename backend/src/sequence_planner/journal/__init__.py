"""The durable record of who did what."""
