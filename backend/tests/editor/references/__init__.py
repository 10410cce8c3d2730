"""Tests of what names of a draft mean: where parts are used, and that they can be given other names."""
