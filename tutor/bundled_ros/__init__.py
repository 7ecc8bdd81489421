"""What the bundled ROS lacks, and the exercises need. A real one, where installed, always goes first."""
