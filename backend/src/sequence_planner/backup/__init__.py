"""A station's backup: its database, its revisions and its model in one file, made while it runs.

The key that signs checkpoints is no part of it: who has both a backup and the key could write another past.
"""
