"""What `ros2 topic echo` would show: type and QoS taken from the publishers (as in ros2cli, ros2topic, verb echo)."""

from __future__ import annotations

import asyncio

from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

from tutor.judge.trace import Echo
from tutor.ros.messages import UnknownType
from tutor.ros.observer import Observer


async def echo_topic(domain_id: int, topic: str, *, samples: int, limit_s: float) -> Echo:
    """Join as a new participant, choose type and QoS, get `samples` messages of `topic` within `limit_s` seconds."""
    changed = asyncio.Event()
    observer = Observer(domain_id, changed.set)
    loop = asyncio.get_running_loop()
    deadline = loop.time() + limit_s
    try:
        types: tuple[str, ...] = ()
        reliability, durability = ReliabilityPolicy.RELIABLE, DurabilityPolicy.VOLATILE
        while loop.time() < deadline:
            publishers = observer.node.get_publishers_info_by_topic(topic)
            types = tuple(sorted({info.topic_type for info in publishers}))
            if publishers:
                profiles = [info.qos_profile for info in publishers]
                if any(profile.reliability != ReliabilityPolicy.RELIABLE for profile in profiles):
                    reliability = ReliabilityPolicy.BEST_EFFORT
                if all(profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for profile in profiles):
                    durability = DurabilityPolicy.TRANSIENT_LOCAL
                break
            await asyncio.sleep(0.02)
        if len(types) == 1:
            try:
                observer.watch(topic, types[0], reliability=reliability, durability=durability)
            except UnknownType:
                types = ()
        while topic in observer.samples and len(observer.samples[topic]) < samples and loop.time() < deadline:
            changed.clear()
            try:
                await asyncio.wait_for(changed.wait(), deadline - loop.time())
            except TimeoutError:
                break
        return Echo(
            topic=topic,
            types=types,
            reliability=reliability.short_key,
            durability=durability.short_key,
            samples=tuple(observer.samples.get(topic, ())),
            limit_s=limit_s,
        )
    finally:
        observer.close()
