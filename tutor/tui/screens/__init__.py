"""What fills the terminal: a module for each screen and dialog. Screens have a .tcss file, dialogs share one."""
