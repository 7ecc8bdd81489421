"""The full screens, one module each, with its .tcss file (if any) beside it."""
