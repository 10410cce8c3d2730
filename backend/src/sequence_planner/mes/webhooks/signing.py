"""How a delivery says that it comes from this station and is new: the signature of Standard Webhooks.

`webhook-signature` is `v1,` and the HMAC-SHA256, in base64, of the text `ID.TIMESTAMP.BODY` under the webhook's secret,
of which the part after `whsec_` is the key in base64. A receiver refuses what is signed otherwise, what is older than
its replay window, and does nothing for an id that it has seen. See standardwebhooks.com.
"""

from __future__ import annotations

import base64
import hmac
import secrets
from hashlib import sha256
from typing import Final

ID, TIMESTAMP, SIGNATURE = "webhook-id", "webhook-timestamp", "webhook-signature"
PREFIX: Final = "whsec_"
REPLAY_WINDOW: Final = 300.0  # seconds that a receiver should allow between its clock and the time stamp


def new_secret() -> str:
    """A secret of 32 random bytes."""
    return PREFIX + base64.b64encode(secrets.token_bytes(32)).decode()


def signed(secret: str, id: str, now: float, body: bytes) -> dict[str, str]:
    """The headers that sign a body which is sent now."""
    key, stamp = base64.b64decode(secret.removeprefix(PREFIX)), str(int(now))
    mac = hmac.new(key, f"{id}.{stamp}.".encode() + body, sha256).digest()
    return {ID: id, TIMESTAMP: stamp, SIGNATURE: f"v1,{base64.b64encode(mac).decode()}"}
