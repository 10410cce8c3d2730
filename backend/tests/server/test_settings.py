"""Where the server may be reached, by which names, and with which certificate; all that is refused before it starts."""

from __future__ import annotations

import dataclasses
import ssl
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sequence_planner.server.binding import bind, check_demonstration, check_endpoint, server_context
from sequence_planner.server.settings import Endpoint, SettingsError, origin_of, split_name
from support.certificates import certify
from support.examples import examples
from support.network import free_port

NAME = "station.example"


def secured(folder: Path, *names: str, host: str = "0.0.0.0", port: int = 8443) -> Endpoint:
    """An endpoint beyond the loopback with a certificate for its names."""
    made = certify(folder, *(split_name(name)[0].strip("[]") for name in names))
    return Endpoint(
        host=host, port=port, certificate=made.certificate, private_key=made.private_key, names=tuple(names)
    )


def refusal(endpoint: Endpoint) -> str:
    with pytest.raises(SettingsError) as refused:
        check_endpoint(endpoint)
    return str(refused.value)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.0.2.7", "2001:db8::7"])
def test_with_a_certificate_every_address_may_be_served(tmp_path: Path, host: str) -> None:
    check_endpoint(secured(tmp_path, NAME, "192.0.2.7", "[2001:db8::7]", host=host))


@pytest.mark.parametrize("host", ["0.0.0.0", "127.0.0.1", "::1"])
def test_behind_a_proxy_every_address_may_be_served(host: str) -> None:
    check_endpoint(Endpoint(host=host, proxies=("192.0.2.1", "2001:db8::1"), names=(NAME,)))


def test_without_a_name_nobody_could_open_it(tmp_path: Path) -> None:
    unnamed = dataclasses.replace(secured(tmp_path, NAME), names=())
    assert refusal(unnamed).startswith("use --name with the host name")
    assert refusal(Endpoint(proxies=("127.0.0.1",))).startswith("use --name with the host name")
    check_endpoint(dataclasses.replace(unnamed, host="127.0.0.1"))


@pytest.mark.parametrize("proxy", ["proxy.example", "192.0.2.0/24", "", "*"])
def test_a_proxy_is_an_address(proxy: str) -> None:
    assert "use --proxy with the one that the proxy connects from" in refusal(Endpoint(proxies=(proxy,), names=(NAME,)))


@pytest.mark.parametrize(
    "name",
    ["", "https://station.example", "station.example/", "a b", "station.example:", "x:0", "x:65536", "*.example", "@x"],
)
def test_a_name_is_what_browsers_send(name: str) -> None:
    assert "is no name; use --name" in refusal(Endpoint(proxies=("127.0.0.1",), names=(name,)))


@pytest.mark.parametrize(
    ("endpoint", "hosts", "address"),
    [
        (Endpoint(), {"127.0.0.1:8000", "localhost:8000", "[::1]:8000"}, "http://127.0.0.1:8000"),
        (Endpoint(host="::1", port=80), {"[::1]", "localhost", "127.0.0.1:80"}, "http://[::1]"),
        (Endpoint(proxies=("192.0.2.1",), names=("Station.example",)), {NAME, f"{NAME}:443"}, f"https://{NAME}"),
        (Endpoint(proxies=("192.0.2.1",), names=(f"{NAME}:8443",)), {f"{NAME}:8443"}, f"https://{NAME}:8443"),
    ],
)
def test_each_name_means_the_port_that_is_opened(endpoint: Endpoint, hosts: set[str], address: str) -> None:
    assert hosts <= endpoint.hosts
    assert endpoint.address == address
    assert {f"{endpoint.scheme}://{host}" for host in endpoint.hosts} == endpoint.origins
    if endpoint.proxies:
        assert endpoint.hosts == hosts


def test_with_a_certificate_a_name_means_the_port_that_is_served(tmp_path: Path) -> None:
    endpoint = secured(tmp_path, NAME, "[2001:DB8:0::7]")
    assert endpoint.hosts == {f"{NAME}:8443", "[2001:db8::7]:8443"}
    assert endpoint.origins == {f"https://{NAME}:8443", "https://[2001:db8::7]:8443"}
    usual = dataclasses.replace(endpoint, port=443)
    assert usual.address == f"https://{NAME}"
    assert f"{NAME}:443" in usual.hosts


@examples(100)
@given(
    labels=st.lists(st.from_regex("[a-z0-9]([a-z0-9-]{0,10}[a-z0-9])?", fullmatch=True), min_size=1, max_size=4),
    port=st.none() | st.integers(1, 65535),
)
def test_a_name_is_read_as_it_was_written(labels: list[str], port: int | None) -> None:
    host = ".".join(labels)
    written = host if port is None else f"{host}:{port}"
    assert split_name(written) == split_name(written.upper()) == (host, port)


def test_an_address_of_nobody_here_is_said(tmp_path: Path) -> None:
    endpoint = secured(tmp_path, "192.0.2.7", host="192.0.2.7", port=free_port())
    with pytest.raises(SettingsError, match=r"192\.0\.2\.7 is no address of this machine; use --host"):
        bind(endpoint)


def test_a_certificate_comes_with_its_key(tmp_path: Path) -> None:
    endpoint = secured(tmp_path, NAME)
    for alone in (dataclasses.replace(endpoint, private_key=None), dataclasses.replace(endpoint, certificate=None)):
        with pytest.raises(SettingsError):
            check_endpoint(alone)
    assert "give both, or none" in refusal(Endpoint(private_key=endpoint.private_key))


@pytest.mark.parametrize(("days", "reason"), [((-30, -1), "has expired; renew it"), ((1, 30), "is not valid yet")])
@pytest.mark.parametrize("self_signed", [True, False])
def test_a_certificate_is_valid_today(tmp_path: Path, days: tuple[int, int], reason: str, self_signed: bool) -> None:
    made = certify(tmp_path, NAME, days=days, self_signed=self_signed)
    said = refusal(Endpoint(certificate=made.certificate, private_key=made.private_key))
    assert said.startswith(f"the certificate {made.certificate} {reason}")


@pytest.mark.parametrize("self_signed", [True, False])
def test_a_certificate_is_for_the_names_that_people_open(tmp_path: Path, self_signed: bool) -> None:
    made = certify(tmp_path, NAME, "192.0.2.7", self_signed=self_signed)
    endpoint = Endpoint(host="0.0.0.0", certificate=made.certificate, private_key=made.private_key)
    check_endpoint(dataclasses.replace(endpoint, names=(NAME, "192.0.2.7:8443")))
    for other in ("other.example", "192.0.2.8", f"sub.{NAME}"):
        assert f"is not for {other}: its subject" in refusal(dataclasses.replace(endpoint, names=(NAME, other)))


def test_files_that_are_no_certificate_are_refused_in_plain_words(tmp_path: Path) -> None:
    ours, theirs = certify(tmp_path / "ours", NAME), certify(tmp_path / "theirs", NAME)
    locked = certify(tmp_path / "locked", NAME, passphrase=b"horse")
    text = tmp_path / "text"
    text.write_text("no PEM")
    gone = tmp_path / "gone.pem"
    for certificate, key, reason in [
        (ours.certificate, theirs.private_key, f"{theirs.private_key} is not the private key of {ours.certificate}"),
        (gone, ours.private_key, f"{gone} cannot be read: No such file or directory; use --certificate"),
        (ours.certificate, tmp_path, f"{tmp_path} cannot be read: Is a directory; use --private-key"),
        (text, ours.private_key, "both must be PEM files"),
        (ours.certificate, text, "both must be PEM files"),
        (ours.private_key, ours.certificate, "both must be PEM files"),
        (locked.certificate, locked.private_key, f"{locked.private_key} is locked with a passphrase"),
    ]:
        assert reason in refusal(Endpoint(certificate=certificate, private_key=key))


def test_nothing_older_than_tls_1_2_is_spoken(tmp_path: Path) -> None:
    made = certify(tmp_path, NAME)
    assert server_context(made.certificate, made.private_key).minimum_version == ssl.TLSVersion.TLSv1_2


def test_a_demonstration_is_for_this_machine_alone(tmp_path: Path) -> None:
    check_demonstration(Endpoint())
    check_demonstration(Endpoint(host="::1"))
    for beyond in (
        secured(tmp_path, NAME),
        dataclasses.replace(secured(tmp_path, NAME), host="127.0.0.1"),
        Endpoint(host="0.0.0.0"),
        Endpoint(proxies=("127.0.0.1",), names=(NAME,)),
        Endpoint(names=(NAME,)),
    ):
        with pytest.raises(SettingsError, match="--demonstration is for this machine alone"):
            check_demonstration(beyond)


@pytest.mark.parametrize(
    "url, origin",
    [
        ("http://127.0.0.1:8001", "http://127.0.0.1:8001"),
        ("HTTPS://Weld.Example/", "https://weld.example"),
        ("https://weld.example:443", "https://weld.example"),
        ("http://[::1]:80/", "http://[::1]"),
        ("https://weld.example:80", "https://weld.example:80"),
    ],
)
def test_a_station_beside_is_told_by_its_origin(url: str, origin: str) -> None:
    assert origin_of(url) == origin
    assert origin_of(origin) == origin


@pytest.mark.parametrize(
    "url",
    [
        "weld.example",
        "ftp://weld.example",
        "https://",
        "https://weld.example/wall",
        "https://a b",
        "https://*",
        "https://u@weld.example",
    ],
)
def test_what_is_no_station_does_not_stand_beside(url: str) -> None:
    said = refusal(Endpoint(wall_beside=(url,)))
    assert repr(url) in said
    assert "--wall-beside" in said


def test_a_page_of_https_shows_no_wall_by_http(tmp_path: Path) -> None:
    endpoint = dataclasses.replace(secured(tmp_path, NAME), wall_beside=("http://weld.example",))
    assert "no HTTPS" in refusal(endpoint)
    check_endpoint(dataclasses.replace(endpoint, wall_beside=("https://weld.example",)))
