"""Time, immutable values, numbers in words, logs and files, for every other package: nothing here knows stations."""
