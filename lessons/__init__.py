"""The lessons: text, skeletons and solutions. Nothing here imports the program: a learner reads plain ROS code."""
