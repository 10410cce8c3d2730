"""What the names of a draft mean and where they are used: for renaming, deleting, and seeing a draft as a whole."""
