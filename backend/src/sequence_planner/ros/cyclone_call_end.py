"""A client or a server of a service over cyclonedds: what it writes and what it reads."""

from __future__ import annotations

from dataclasses import dataclass

from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from sequence_planner.ros import names
from sequence_planner.ros.call_header import CallHeader, with_header
from sequence_planner.ros.cyclone_qos import user_data
from sequence_planner.ros.cyclone_types import RawSample
from sequence_planner.ros.delivery import Delivery


@dataclass(eq=False)
class CallEnd:
    """Two endpoints: a client writes requests and reads replies, a server the other way round."""

    type_name: str
    writer: DataWriter[RawSample]
    raw: type[RawSample]
    reader: DataReader[RawSample]
    delivery: Delivery
    topics: tuple[Topic[RawSample], Topic[RawSample]]

    def write(self, header: CallHeader, message: bytes) -> None:
        """Send the CDR bytes of a request or a response; raises DDSException."""
        self.writer.write(self.raw(with_header(header, message)))

    def reaches(self, client: str) -> bool:
        """Return whether what is written now would be read by the client of this identity."""
        readers = map(self.writer.get_matched_subscription_data, self.writer.get_matched_subscriptions())
        return any(reader is not None and names.client_of(user_data(reader.qos)) == client for reader in readers)
