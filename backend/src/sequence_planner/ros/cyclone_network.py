"""Joining the DDS network with cyclonedds.

Unless told otherwise a station stays on the loopback interface: cyclonedds is configured to use no other, to send no
multicast, and to look for peers on the first ports of this computer. A configuration belongs to a domain and can be set
once in a process, before its first participant.
"""

from __future__ import annotations

import sys
import threading
from weakref import WeakValueDictionary
from xml.sax.saxutils import quoteattr

from cyclonedds.core import DDSException, Entity
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.qos import Policy, Qos

from sequence_planner.ros import environment
from sequence_planner.ros.environment import DiscoveryRange
from sequence_planner.ros.transport import TransportError

#: Participants that can be found on one computer and domain.
MAX_PARTICIPANTS = 32

_domains: WeakValueDictionary[int, Domain] = WeakValueDictionary()
_lock = threading.Lock()


def loopback_configuration() -> str:
    """Return the cyclonedds configuration that reaches this computer only."""
    interface = "lo0" if sys.platform == "darwin" else "lo"
    return f"""<CycloneDDS><Domain>
      <General>
        <Interfaces><NetworkInterface name="{interface}"/></Interfaces>
        <AllowMulticast>false</AllowMulticast>
      </General>
      <Discovery>
        <ParticipantIndex>auto</ParticipantIndex>
        <MaxAutoParticipantIndex>{MAX_PARTICIPANTS}</MaxAutoParticipantIndex>
        <Peers><Peer address="localhost"/></Peers>
      </Discovery>
    </Domain></CycloneDDS>"""


def interface_configuration(interface: str) -> str:
    """Return the cyclonedds configuration that uses the network interface of this name and no other."""
    return f"""<CycloneDDS><Domain>
      <General><Interfaces><NetworkInterface name={quoteattr(interface)}/></Interfaces></General>
    </Domain></CycloneDDS>"""


def join(domain_id: int, discovery: DiscoveryRange) -> tuple[Domain | None, DomainParticipant]:
    """Return a participant of the domain, and the domain's configuration, which must live as long.

    With the range LOCALHOST the loopback configuration holds. With SUBNET it is the interface that the environment
    names, if any; without one, and with SYSTEM_DEFAULT, the configuration of CYCLONEDDS_URI, if any. Raises
    TransportError when there is no network to join, or one that this library must not join.
    """
    if environment.security_wanted():
        raise TransportError(
            f"{environment.SECURITY} asks for DDS Security, which this build of cyclonedds lacks: use ROS 2 with rclpy"
        )
    if discovery is DiscoveryRange.OFF:
        raise TransportError(f"{environment.DISCOVERY_RANGE} is OFF, so no device could be found: use LOCALHOST")
    interface = environment.interface(discovery)
    qos = Qos(Policy.Userdata(b"enclave=/;"))
    try:
        domain = None
        if discovery is DiscoveryRange.LOCALHOST:
            domain = _configured(domain_id, loopback_configuration())
        elif interface is not None:
            domain = _configured(domain_id, interface_configuration(interface))
        return domain, DomainParticipant(domain_id, qos)
    except DDSException as error:
        way = "loopback interface" if discovery is DiscoveryRange.LOCALHOST else "network interface"
        raise TransportError(
            f"DDS cannot join domain {domain_id} ({error}). Check that a {way} is up, that fewer than "
            f"{MAX_PARTICIPANTS} programs share the domain on this computer, and what CYCLONEDDS_URI says"
        ) from error


def _configured(domain_id: int, configuration: str) -> Domain:
    with _lock:
        domain = _domains.get(domain_id)
        if domain is None:
            domain = _domains[domain_id] = Domain(domain_id, configuration)
        return domain


def release(entity: Entity) -> None:
    """Delete a DDS entity now.

    cyclonedds deletes an entity when Python frees the object, and has no other way; a reference cycle inside the
    library would put that off, and the peers would go on seeing us.
    """
    entity.__del__()
