"""Everything that a request goes through before a route sees it, and connections that are closed in good time."""
