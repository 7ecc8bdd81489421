"""What `ros-tutor grade` writes: one renderer for each format."""
