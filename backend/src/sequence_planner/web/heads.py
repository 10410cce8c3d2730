"""Heads of requests as HTTP/1.1 has them (RFC 9112), no larger than is allowed.

h11 looks at the size of a head only as long as it is not complete, and takes a line feed alone for the end of a line. A
proxy that does not could take one request for two.
"""

from __future__ import annotations

import re

import h11

LARGEST_HEAD = 32 * 1024  # bytes
_END = re.compile(rb"\n\r?\n")
_BARE = re.compile(rb"(?<!\r)\n")


class StrictConnection(h11.Connection):
    """Refuses heads that are too large or whose lines do not end with CR LF; `refusal` is the status and the reason."""

    refusal = (400, "This is no request of HTTP/1.1.")

    def __init__(self) -> None:
        super().__init__(h11.SERVER, LARGEST_HEAD)

    def next_event(self) -> h11.Event | type[h11.NEED_DATA] | type[h11.PAUSED]:
        """What has come. Raises `h11.RemoteProtocolError`."""
        if self.their_state is h11.IDLE:
            self._look_at_head()
        return super().next_event()

    def _look_at_head(self) -> None:
        waiting = self.trailing_data[0]
        end = _END.search(waiting)
        head = waiting if end is None else waiting[: end.end()]
        if len(head) > LARGEST_HEAD:
            self._refuse(431, f"The head of a request has at most {LARGEST_HEAD} bytes.")
        if _BARE.search(head):
            self._refuse(400, "Lines of the head end with CR LF, and not with LF alone.")

    def _refuse(self, status: int, why: str) -> None:
        self.refusal = status, why
        raise h11.RemoteProtocolError(why, status)
