"""The tasks of the server beside answering requests: orders, backups, retention, and the processes of the editor."""
