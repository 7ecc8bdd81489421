"""What fills the terminal: one module and one .tcss file for each screen."""
