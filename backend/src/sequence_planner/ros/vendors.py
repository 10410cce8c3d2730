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


def vendor_of(participant: UUID) -> str | None:
    """Return the vendor in the first two bytes of a participant's identifier, where RTPS puts it; None if unknown."""
    return _VENDORS.get(int.from_bytes(participant.bytes[:2]))
