"""What fills the terminal: a module for each screen, with its .tcss file beside it."""
