"""What `ros2 topic echo` would show, with type and QoS taken from the publishers (as ros2topic's echo verb does)."""

from __future__ import annotations

import asyncio

from tutor.errors import UnknownType
from tutor.judge.trace import Echo
from tutor.ros.observer import Observer
from tutor.ros.qos import from_rclpy
from tutor.ros_model import QoS, echo_qos


async def echo_topic(domain_id: int, topic: str, *, samples: int, over: asyncio.Event) -> Echo:
    """Join as a new participant, choose type and QoS, and collect `samples` messages of `topic` until `over` is set."""
    changed = asyncio.Event()
    observer = Observer(domain_id, changed.set)
    loop = asyncio.get_running_loop()
    began, ending = loop.time(), asyncio.ensure_future(over.wait())
    ending.add_done_callback(lambda _: changed.set())
    try:
        types: tuple[str, ...] = ()
        qos = QoS()
        while not over.is_set():
            publishers = observer.node.get_publishers_info_by_topic(topic)
            types = tuple(sorted({info.topic_type for info in publishers}))
            if publishers:
                qos = echo_qos(from_rclpy(info.qos_profile) for info in publishers)
                break
            await asyncio.sleep(0.02)
        if len(types) == 1:
            try:
                observer.watch(topic, types[0], qos)
            except UnknownType:
                types = ()
        while topic in observer.samples and len(observer.samples[topic]) < samples and not over.is_set():
            changed.clear()
            await changed.wait()
        shown = tuple(observer.samples.get(topic, ()))
        return Echo(topic=topic, types=types, qos=qos, samples=shown, limit_s=round(loop.time() - began, 1))
    finally:
        ending.cancel()
        observer.close()
