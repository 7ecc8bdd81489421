"""A screen reader's way through the course: lines of text in, lines of text out."""
