"""ros-tutor: hands-on ROS 2 exercises, judged by what the learner's node really does."""

__version__ = "1.0.0"
