"""The terminal page: commands typed at a prompt, several at once, each with its output."""
