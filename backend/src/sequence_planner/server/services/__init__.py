"""What the server does beside answering requests: orders, backups, retention, and the processes of the editor."""
