"""Outlines of stations: what a first station is told in few answers, and the plain documents it becomes."""
