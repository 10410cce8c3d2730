"""Who may act: people, their sessions, watches and keys. Pure of HTTP; everything lasting is in the database."""
