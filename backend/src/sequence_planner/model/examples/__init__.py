"""The example stations that come with the program."""
