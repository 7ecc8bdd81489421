"""General edits of a learner's node: a function, or one line of it, written so that it does what is asked for.

Each gives a next step in words, or None where the file gives no hold for it; edits are tried before they are given.
"""
