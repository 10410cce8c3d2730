"""Whose DDS a peer uses, by the number that its participant bears."""

from __future__ import annotations

from uuid import UUID

#: Vendor identifiers as the OMG has assigned them (https://www.dds-foundation.org/dds-vendor-ids).
_VENDORS = {
    0x0101: "RTI Connext DDS",
    0x0102: "ADLINK OpenSplice DDS",
    0x0103: "OCI OpenDDS",
    0x0106: "TwinOaks CoreDX DDS",
    0x010A: "RTI Connext DDS Micro",
    0x010F: "eProsima Fast DDS",
    0x0110: "Eclipse Cyclone DDS",
    0x0111: "GurumDDS",
    0x0112: "RustDDS",
    0x0114: "Dust DDS",
}

#: The middleware of ROS 2 that each runs under, as RMW_IMPLEMENTATION names it.
_MIDDLEWARES = {
    "RTI Connext DDS": "rmw_connextdds",
    "eProsima Fast DDS": "rmw_fastrtps_cpp",
    "Eclipse Cyclone DDS": "rmw_cyclonedds_cpp",
    "GurumDDS": "rmw_gurumdds_cpp",
}


def worded(vendor: str | None) -> str:
    """Return what to call a vendor's DDS, with ROS 2's name for it.

    >>> worded("eProsima Fast DDS")
    'eProsima Fast DDS (rmw_fastrtps_cpp)'
    """
    middleware = _MIDDLEWARES.get(vendor or "")
    return f"{vendor} ({middleware})" if middleware else vendor or "another DDS"


def vendor_of(participant: UUID) -> str | None:
    """Return the vendor in the first two bytes of a participant's identifier, where RTPS puts it; None if unknown."""
    return _VENDORS.get(int.from_bytes(participant.bytes[:2]))
