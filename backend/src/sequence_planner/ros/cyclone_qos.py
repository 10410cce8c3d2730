"""ROS 2's qualities of service as DDS policies."""

from __future__ import annotations

from cyclonedds.qos import Policy, Qos
from cyclonedds.util import duration

from sequence_planner.ros.transport import QualityOfService

_HISTORIES = {qos: Policy.History.KeepLast(qos.depth) for qos in QualityOfService}
_RELIABLE = Policy.Reliability.Reliable(max_blocking_time=duration(infinite=True))


def endpoint_qos(qos: QualityOfService, user_data: bytes = b"") -> Qos:
    """Return the policies of a reader or writer that ROS 2 would give it, with `user_data` for its peers to read."""
    history = _HISTORIES[qos]
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
    if user_data:
        policies.append(Policy.Userdata(user_data))
    return Qos(*policies)


def discovery_qos(*, reader: bool) -> Qos:
    """Return the policies of `ros_discovery_info`, on which participants tell their nodes."""
    history = Policy.History.KeepAll if reader else Policy.History.KeepLast(1)
    return Qos(
        _RELIABLE,
        history,
        Policy.Durability.TransientLocal,
        Policy.DurabilityService(0, Policy.History.KeepLast(1), -1, -1, -1),
        Policy.DataRepresentation(use_cdrv0_representation=True),
        Policy.WriterDataLifecycle(autodispose=False),
    )


def user_data(qos: Qos) -> bytes:
    """Return what a peer wrote into its user data."""
    return qos[Policy.Userdata].data if Policy.Userdata in qos else b""


def is_reliable(qos: Qos) -> bool:
    """Return whether a peer sends lost samples again, or wants them again."""
    return Policy.Reliability.BestEffort not in qos


def is_transient_local(qos: Qos) -> bool:
    """Return whether a peer keeps samples for late joiners, or wants the kept ones."""
    return Policy.Durability.Volatile not in qos
