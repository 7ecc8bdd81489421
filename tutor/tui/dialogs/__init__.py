"""The dialogs over the main screen, one module each; all but the checklist share one .tcss file."""
