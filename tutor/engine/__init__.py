"""The engine: runs checks on real processes and real DDS, and streams events."""
