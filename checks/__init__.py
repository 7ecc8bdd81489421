"""What is done to a learner's node, and what must be seen: one package for each exercise, named after it."""
