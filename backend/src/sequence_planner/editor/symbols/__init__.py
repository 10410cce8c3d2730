"""The meaning of the names of a draft and where they are used: for renaming, deleting, and seeing a draft as a
whole.
"""
