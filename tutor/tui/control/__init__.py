"""What the learner can do, each part of it in a controller of its own. They know the screen only as a `HostScreen`."""
