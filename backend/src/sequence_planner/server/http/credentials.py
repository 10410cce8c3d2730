"""Credentials of a request: cookies that only this server can set and read, and keys."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from starlette.requests import HTTPConnection
from starlette.responses import Response

from sequence_planner.server.settings import Settings

if TYPE_CHECKING:
    pass

# What a request shows to say who it is from: cookies that only this server can set and read, or a key.
#
# On HTTPS the names begin with `__Host-`: browsers then take the cookie from this very host alone, over HTTPS alone
# (RFC 6265bis). On the loopback they end in the port, since cookies know no ports and two stations may run beside each
# other.

NAME = "sequence-planner"
SESSION_COOKIE, WATCH_COOKIE = f"__Host-{NAME}", f"__Host-{NAME}-watch"
FLOW_COOKIE = f"__Host-{NAME}-sign-in"
LONGEST = 256  # characters of a credential; what is longer is none of ours


@dataclass(frozen=True)
class Credentials:
    """The secrets that a request shows; none of them is known to be right."""

    session: str | None = None
    watch: str | None = None
    key: str | None = None


def session_cookie(settings: Settings) -> str:
    """The name of the cookie that holds a session's token."""
    return SESSION_COOKIE if settings.https else f"{NAME}-{settings.port}"


def watch_cookie(settings: Settings) -> str:
    """The name of the cookie that holds a watch's token."""
    return WATCH_COOKIE if settings.https else f"{NAME}-watch-{settings.port}"


def flow_cookie(settings: Settings) -> str:
    """The name of the cookie that holds the token of a sign-in that was begun with a provider."""
    return FLOW_COOKIE if settings.https else f"{NAME}-sign-in-{settings.port}"


def flow_token(connection: HTTPConnection) -> str | None:
    """The token of the sign-in that this browser has begun; it is not known to be right."""
    return _short(connection.cookies.get(flow_cookie(connection.app.state.settings)))


def credentials(connection: HTTPConnection) -> Credentials:
    """Return what `connection` shows. A key is shown as `Authorization: Bearer sp_…`; other schemes are not ours."""
    settings: Settings = connection.app.state.settings
    scheme, _, secret = connection.headers.get("authorization", "").partition(" ")
    cookies = connection.cookies
    return Credentials(
        session=_short(cookies.get(session_cookie(settings))),
        watch=_short(cookies.get(watch_cookie(settings))),
        key=(_short(secret.strip()) or "") if scheme.lower() == "bearer" else None,
    )


def keep_session(response: Response, settings: Settings, token: str) -> None:
    """Have the browser keep a session's token until it is closed."""
    _keep(response, session_cookie(settings), token, settings, None)


def keep_watch(response: Response, settings: Settings, token: str, seconds: int) -> None:
    """Have the browser keep a watch's token for `seconds`."""
    _keep(response, watch_cookie(settings), token, settings, seconds)


def keep_flow(response: Response, settings: Settings, token: str, seconds: int) -> None:
    """Have the browser keep the token of a sign-in for `seconds`."""
    _keep(response, flow_cookie(settings), token, settings, seconds)


def forget_flow(response: Response, settings: Settings) -> None:
    """Have the browser forget the sign-in that it has begun."""
    _keep(response, flow_cookie(settings), "", settings, 0)


def forget_session(response: Response, settings: Settings) -> None:
    """Have the browser forget its session's token."""
    _keep(response, session_cookie(settings), "", settings, 0)


def _keep(response: Response, name: str, value: str, settings: Settings, seconds: int | None) -> None:
    response.set_cookie(name, value, max_age=seconds, httponly=True, samesite="strict", secure=settings.https)


def _short(secret: str | None) -> str | None:
    return secret if secret and len(secret) <= LONGEST else None
