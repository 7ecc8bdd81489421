"""General edits of a learner's node: they rewrite a line, a function or the program so that it does what is required.

An edit that does not fit the file comes out empty or as None; all edits are tried out before they are shown.
"""
