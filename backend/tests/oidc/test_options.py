"""How a provider is named at the start, what is refused then, and which role comes of which claims."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.auth.oidc.addresses import is_safe
from sequence_planner.auth.oidc.flow import SignInFlow
from sequence_planner.auth.oidc.options import ProviderOptionError, ProviderOptions
from sequence_planner.auth.oidc.settings import ProviderSettings
from sequence_planner.auth.roles import Role
from sequence_planner.cli.station.run import server as server_command
from sequence_planner.core.secrets import CLIENT_SECRET
from support.commands import command
from support.examples import examples
from support.places import BOLT_TIGHTENING

ISSUER = "https://id.example/realms/works"
OPTIONS = ProviderOptions(issuer=ISSUER, client="station", roles=("operator=shift", "administrator=it=admins"))


def options(**changes: Any) -> ProviderOptions:  # noqa: ANN401 (of each option its own type)
    given = {name: getattr(OPTIONS, name) for name in OPTIONS.__dataclass_fields__}
    return ProviderOptions(**{**given, **changes})


def test_what_is_named_is_meant() -> None:
    found = OPTIONS.settings({CLIENT_SECRET: "of the client"})
    assert found == ProviderSettings(
        issuer=ISSUER,
        client="station",
        secret="of the client",
        title="id.example",
        roles=((Role.OPERATOR, "shift"), (Role.ADMINISTRATOR, "it=admins")),
    )
    assert "of the client" not in repr(found)
    assert ProviderOptions().settings({CLIENT_SECRET: "of nobody"}) is None
    public = options(scopes=("email", "openid"), others="viewer", roles=()).settings({})
    assert public is not None
    assert (public.secret, public.scopes, public.others) == (None, ("openid", "email"), Role.VIEWER)


def test_the_secret_comes_from_a_file_and_is_no_argument_of_another_process(tmp_path: Path) -> None:
    file = tmp_path / "secret"
    file.write_text("of the client\n", encoding="utf-8")
    named = options(secret_file=file, title="Works ID", scopes=("profile",))
    found = named.settings({})
    assert found is not None
    assert found.secret == "of the client"
    arguments = named.arguments()
    assert f"--oidc-client-secret-file={file}" in arguments
    assert "of the client" not in " ".join(arguments)
    assert ProviderOptions().arguments() == []
    parameters = set(server_command.__annotations__)
    for argument in arguments:
        assert argument.partition("=")[0].removeprefix("--").replace("-", "_") in parameters


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"issuer": None}, "--oidc-issuer is missing"),
        ({"client": None}, "--oidc-client is missing"),
        ({"issuer": "http://id.example"}, "is no issuer"),
        ({"issuer": "https://id.example?realm=works"}, "is no issuer"),
        ({"issuer": "https://someone:secret@id.example"}, "is no issuer"),
        ({"issuer": "id.example"}, "is no issuer"),
        ({"issuer": f"https://id.example/{'x' * 400}"}, "is no issuer"),
        ({"roles": ()}, "nobody of the provider could sign in"),
        ({"roles": ("owner=shift",)}, "says no role of a group"),
        ({"roles": ("operator",)}, "says no role of a group"),
        ({"others": "operator"}, "--oidc-others is refused or viewer"),
        ({"secret_file": Path("/nowhere/secret")}, "cannot be read"),
    ],
)
def test_what_cannot_be_used_is_said(changes: dict[str, Any], why: str) -> None:
    with pytest.raises(ProviderOptionError, match=why):
        options(**changes).settings({})


@pytest.mark.parametrize(("text", "why"), [("", "in one line"), ("a\nb\n", "in one line"), (b"\xff", "no text")])
def test_a_file_without_a_secret_is_refused(tmp_path: Path, text: str | bytes, why: str) -> None:
    file = tmp_path / "secret"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ProviderOptionError, match=why):
        options(secret_file=file).settings({})
    file.write_text("of the client")
    with pytest.raises(ProviderOptionError, match="said twice"):
        options(secret_file=file).settings({CLIENT_SECRET: "another"})


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("--oidc-issuer", "http://id.example", "--oidc-client", "station"), "is no issuer"),
        (("--oidc-client", "station"), "--oidc-issuer is missing"),
        (
            ("--emulator", "--demonstration", "--oidc-issuer", ISSUER, "--oidc-client", "x", "--oidc-others", "viewer"),
            "--demonstration is for whoever sits here",
        ),
    ],
)
def test_a_station_does_not_start_with_what_cannot_be_used(arguments: tuple[str, ...], why: str) -> None:
    code, out, err = command("run", BOLT_TIGHTENING, *arguments)
    assert (code, out) == (2, "")
    assert why in err


@pytest.mark.parametrize(
    ("claims", "name", "role"),
    [
        ({"groups": ["shift"]}, "groups", Role.OPERATOR),
        ({"groups": ["shift", "it=admins"]}, "groups", Role.ADMINISTRATOR),
        ({"groups": "shift"}, "groups", Role.OPERATOR),
        ({"realm_access": {"roles": ["shift"]}}, "realm_access.roles", Role.OPERATOR),
        ({"https://works.example/groups": ["shift"]}, "https://works.example/groups", Role.OPERATOR),
        ({"groups": ["Shift", " shift", "shift "]}, "groups", None),
        ({"groups": [["shift"], {"shift": 1}, None]}, "groups", None),
        ({"groups": {"shift": True}}, "groups", None),
        ({"groups": ["shift"] * 10_001}, "groups", None),
        ({}, "groups", None),
    ],
)
def test_the_role_is_that_of_the_groups(claims: dict[str, object], name: str, role: Role | None) -> None:
    for others in (None, Role.VIEWER):
        word = "refused" if others is None else "viewer"
        found = options(groups=name, others=word).settings({})
        assert found is not None
        assert found.role(claims) == (role or others)


@pytest.mark.parametrize(
    ("address", "safe"),
    [
        ("https://id.example/auth", True),
        ("http://127.0.0.1:8080/auth", True),
        ("http://[::1]:8080/auth", True),
        ("http://localhost/auth", True),
        ("http://localhost.evil.example/auth", False),
        ("http://id.example/auth", False),
        ("https:///auth", False),
        ("https://id.example:port/auth", False),
        ("https://id.example\\@evil.example/", False),
        ("https://user@id.example/", False),
        ("https://id.example/a b", False),
        ("javascript:alert(1)", False),
        ("", False),
    ],
)
def test_a_provider_is_asked_where_nobody_listens_in(address: str, safe: bool) -> None:
    assert is_safe(address) is safe


@examples(100)
@given(st.text(min_size=1, max_size=60), st.text(max_size=60))
def test_what_follows_from_a_token_tells_nothing_of_the_rest(token: str, other: str) -> None:
    flow = SignInFlow(token)
    made = {flow.state, flow.nonce, flow.verifier, flow.challenge}
    assert len(made) == 4
    assert all(len(each) == 43 and each.isascii() for each in made)
    assert flow.is_state(flow.state)
    assert not flow.is_state(other)
    assert other == token or SignInFlow(other).verifier != flow.verifier
