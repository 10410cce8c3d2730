"""The command line.

Exit codes: 0 fine, 1 findings, 2 unusable input or surroundings, which are said on standard error.
"""
