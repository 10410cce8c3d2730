"""ROS 2's qualities of service as DDS policies."""

from __future__ import annotations

from cyclonedds.qos import Policy, Qos
from cyclonedds.util import duration

from sequence_planner.ros.transport import QualityOfService

_INFINITE = duration(infinite=True)
_RELIABLE = Policy.Reliability.Reliable(max_blocking_time=_INFINITE)


def endpoint_qos(qos: QualityOfService, user_data: bytes = b"") -> Qos:
    """Return the policies of a reader or writer that ROS 2 would give it, with `user_data` for its peers to read."""
    history = Policy.History.KeepLast(qos.depth)
    policies = [
        _RELIABLE if qos.reliable else Policy.Reliability.BestEffort,
        history,
        # ROS 2 writes the first version of XCDR only.
        Policy.DataRepresentation(use_cdrv0_representation=True),
        # A publisher that leaves says nothing about its last sample.
        Policy.WriterDataLifecycle(autodispose=False),
    ]
    if qos.transient_local:
        policies += [Policy.Durability.TransientLocal, Policy.DurabilityService(0, history, -1, -1, -1)]
    if qos.deadline is not None:
        policies.append(Policy.Deadline(duration(seconds=qos.deadline)))
    if qos.liveliness is not None:
        policies.append(Policy.Liveliness.Automatic(duration(seconds=qos.liveliness)))
    if user_data:
        policies.append(Policy.Userdata(user_data))
    return Qos(*policies)


def discovery_qos(user_data: bytes, *, reader: bool) -> Qos:
    """Return the policies of `ros_discovery_info`, on which participants tell their nodes."""
    history = Policy.History.KeepAll if reader else Policy.History.KeepLast(1)
    return Qos(
        _RELIABLE,
        history,
        Policy.Durability.TransientLocal,
        Policy.DurabilityService(0, Policy.History.KeepLast(1), -1, -1, -1),
        Policy.DataRepresentation(use_cdrv0_representation=True),
        Policy.WriterDataLifecycle(autodispose=False),
        Policy.Userdata(user_data),
    )


def user_data(qos: Qos) -> bytes:
    """Return what a peer wrote into its user data."""
    return qos[Policy.Userdata].data if Policy.Userdata in qos else b""


def deadline(qos: Qos) -> float | None:
    """Return how often (s) a peer sends or wants a sample; None when it says nothing of that."""
    return _seconds(qos[Policy.Deadline].deadline) if Policy.Deadline in qos else None


def liveliness(qos: Qos) -> float | None:
    """Return how often (s) a peer shows that it is alive, or wants that shown; None when it says nothing of that."""
    # Asked for by one class, the library finds the policy of any kind.
    kind = Policy.Liveliness.Automatic
    return _seconds(qos[kind].lease_duration) if kind in qos else None


def _seconds(nanoseconds: int) -> float | None:
    return None if nanoseconds >= _INFINITE else nanoseconds / 1e9


def is_reliable(qos: Qos) -> bool:
    """Return whether a peer sends lost samples again, or wants them again."""
    return Policy.Reliability.BestEffort not in qos


def is_transient_local(qos: Qos) -> bool:
    """Return whether a peer keeps samples for late joiners, or wants the kept ones."""
    return Policy.Durability.Volatile not in qos
