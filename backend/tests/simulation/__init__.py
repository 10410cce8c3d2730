"""Tests of the emulated devices, without clock or network."""
