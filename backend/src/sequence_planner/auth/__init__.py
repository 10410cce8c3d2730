"""Those who may act: people, their sessions, watches and API keys. Pure of HTTP; everything lasting is in the
database.
"""
