"""YAML with the place of each word: read, and changed so that nothing else in the file changes."""
