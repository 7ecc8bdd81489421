"""What opens over the main screen: a module for each dialog, and one .tcss file for all but the checklist."""
