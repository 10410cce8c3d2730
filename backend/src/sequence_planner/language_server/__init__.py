"""The language server: a station's documents in any editor that speaks the Language Server Protocol.

What names mean, what is wrong and what else can stand somewhere is found by `editor`, as for the browser.
"""
