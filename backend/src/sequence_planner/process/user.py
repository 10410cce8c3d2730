"""The user who runs the program, as the machine knows; what the environment says anybody may write there."""

from __future__ import annotations

import os
import pwd


def user_name() -> str:
    """The name of the user, or their number where they have none, as in a container."""
    try:
        return pwd.getpwuid(os.getuid()).pw_name
    except KeyError:
        return f"user {os.getuid()}"
