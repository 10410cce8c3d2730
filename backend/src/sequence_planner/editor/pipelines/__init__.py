"""The pipelines of a draft: seen, tried and run while they are edited."""
