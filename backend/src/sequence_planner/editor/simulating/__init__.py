"""The draft, tried with emulated devices and a clock that somebody leads."""
