"""Types of resources: documents with parameters, which instances fill in, and the packages that bring them.

All of it is done while a station is loaded: what is made of an instance is a resource as if it had been written out.
"""
