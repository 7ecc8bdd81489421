"""The controllers behind the learner's commands, one per area. They know the screen only as a `HostScreen`."""
