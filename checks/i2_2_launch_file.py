"""I2.2 Launch File Creation: one command starts two nodes, with launch arguments for topic and namespace."""

from __future__ import annotations

from tutor.exercise import (
    ArgumentMovesNamespace,
    ArgumentMovesTopic,
    EndsCleanly,
    LaunchFile,
    PairCommunicates,
    StartsPair,
    check,
)

starts = StartsPair("starts")
topic = ArgumentMovesTopic("topic", "topic", after=starts)

CHECK = check(
    "i2.2",
    LaunchFile("my_launch.py"),
    starts,
    topic,
    ArgumentMovesNamespace("namespace", "namespace", and_topic=topic, after=starts),
    PairCommunicates("communicates", after=starts),
    EndsCleanly("shutdown", after=starts, bonus=True),
    expected_s=0.5,
    expected_reason="the first message of our solution",
)
