"""A client or a server of a service over cyclonedds: what it writes and what it reads."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic

from sequence_planner.ros import names
from sequence_planner.ros.call_header import CallHeader, with_header
from sequence_planner.ros.cyclone_qos import user_data
from sequence_planner.ros.cyclone_types import RawSample
from sequence_planner.ros.delivery import Delivery
from sequence_planner.ros.derived import ServiceType
from sequence_planner.ros.messages import MessageRegistry
from sequence_planner.ros.serving import check_hashes
from sequence_planner.ros.transport import NoServerError


@dataclass(eq=False)
class CallEnd:
    """Two endpoints: a client writes requests and reads replies, a server the other way round."""

    service: str
    types: ServiceType
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

    def server_there(self, registry: MessageRegistry, told_on: Callable[[str], list[bytes]]) -> bool:
        """Return whether there is a server whose reply would reach us.

        `told_on` gives the user data of all publishers of a topic of DDS. Raises NoServerError when a request would
        also reach somebody who would not understand it.
        """
        request, response = registry.type_hash(self.types.request), registry.type_hash(self.types.response)
        readers, writers = set(), set()
        for handle in self.writer.get_matched_subscriptions():
            reader = self.writer.get_matched_subscription_data(handle)
            if reader is None:
                continue
            data = user_data(reader.qos)
            server = names.server_of(data)
            if server is None:
                raise NoServerError(
                    f"{self.service} is served by a program whose DDS cannot tell calls apart from here "
                    "(no serviceid); it would execute garbage, so nothing was sent. "
                    "Run it with RMW_IMPLEMENTATION=rmw_cyclonedds_cpp, or run this station with rclpy"
                )
            check_hashes(self.service, self.types.request, names.type_hash_of(data), request)
            readers.add(server)
        for handle in self.reader.get_matched_publications():
            writer = self.reader.get_matched_publication_data(handle)
            if writer is not None:
                writers.add(names.server_of(user_data(writer.qos)))
        there = readers & writers
        # DDS does not match a reply of another definition, so we ask who announces one.
        for data in told_on(names.dds_service(self.service)[1]) if readers and not there else []:
            if names.server_of(data) in readers:
                check_hashes(self.service, self.types.response, names.type_hash_of(data), response)
        return bool(there)
