"""The terminal page: the learner's own shell, several at once, each on a pseudo-terminal and drawn by an emulator."""
