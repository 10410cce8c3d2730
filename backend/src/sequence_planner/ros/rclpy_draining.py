"""Taking all that waits, once rclpy's executor has taken the first.

The executor takes one message of each subscription, one request of each server and one response of each client, and
then builds its wait set anew; a busy station would fall behind. Whoever was called takes the rest, on the same thread.
"""

from __future__ import annotations

from collections.abc import Iterator

from rclpy.client import Client
from rclpy.service import Service
from rclpy.subscription import Subscription

from sequence_planner.ros.quality import READER_DEPTH
from sequence_planner.ros.rclpy_types import ServiceClass

#: What is taken in one go, so that a flood on one topic leaves the others their turn.
_GO = range(READER_DEPTH)


def messages_waiting(subscription: Subscription, message: type) -> Iterator[bytes]:
    """Yield the messages that wait in a subscription of raw bytes."""
    for _ in _GO:
        with subscription.handle:
            taken = subscription.handle.take_message(message, True)
        if taken is None:
            return
        yield taken[0]


def requests_waiting(server: Service, types: ServiceClass) -> Iterator[tuple[object, object]]:
    """Yield the requests that wait for a server, each with its header."""
    for _ in _GO:
        with server.handle:
            request, header = server.handle.service_take_request(types.Request)
        if header is None:
            return
        yield request, header


def responses_waiting(client: Client, types: ServiceClass) -> None:
    """Settle the calls whose responses wait for a client."""
    for _ in _GO:
        with client.handle:
            header, response = client.handle.take_response(types.Response)
        if header is None:
            return
        try:
            call = client.get_pending_request(header.request_id.sequence_number)
        except KeyError:  # Nobody waits for it any more.
            continue
        call.set_result(response)
