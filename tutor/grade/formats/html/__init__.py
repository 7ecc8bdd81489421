"""The HTML pages of a class: one for its teacher, and one of feedback for each learner."""
