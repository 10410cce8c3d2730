"""Nothing is sent but to hosts on the list, by HTTPS, at public addresses; whatever somebody writes as a URL."""

from __future__ import annotations

from ipaddress import ip_address

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from sequence_planner.mes.webhooks.targets import Target, TargetRefused, Targets, host_and_port

LISTED = frozenset(map(host_and_port, ["mes.example", "mes.example:8443", "127.0.0.1:8080", "[::1]:8080"]))
TARGETS, WITH_LOOPBACK = Targets(LISTED), Targets(LISTED, loopback=True)
MES = Target("https", "mes.example", 443, "/")
PRIVATE = [
    "0.0.0.0",
    "10.0.0.1",
    "100.64.0.1",
    "169.254.169.254",
    "172.31.255.255",
    "192.0.2.1",
    "192.168.1.1",
    "198.18.0.1",
    "224.0.0.1",
    "240.0.0.1",
    "255.255.255.255",
    "::",
    "::10.0.0.1",
    "::ffff:10.0.0.1",
    "::ffff:169.254.169.254",
    "64:ff9b::a00:1",
    "64:ff9b:1::1",
    "100::1",
    "2001:db8::1",
    "2002:a00:1::1",
    "fc00::1",
    "fe80::1",
    "fe80::1%eth0",
    "fec0::1",
    "ff02::1",
]
LOOPBACK = ["127.0.0.1", "127.255.0.3", "::1", "::ffff:127.0.0.1"]


@pytest.mark.parametrize(
    ("url", "target"),
    [
        ("https://mes.example", MES),
        ("https://MES.Example./", MES),
        ("https://mes.example:443/hook?a=b&c", Target("https", "mes.example", 443, "/hook?a=b&c")),
        ("https://mes.example:8443/%2e%2e", Target("https", "mes.example", 8443, "/%2e%2e")),
    ],
)
def test_what_is_on_the_list_may_be_sent_to(url: str, target: Target) -> None:
    assert TARGETS.target(url) == target


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("https://mes.example:9443/", "mes.example:9443 is not on the list"),
        ("https://other.example/", "not on the list"),
        ("https://mes.example.other.example/", "not on the list"),
        ("https://sub.mes.example/", "not on the list"),
        ("https://0x7f.1:8080/", "not on the list"),
        ("https://2130706433:8080/", "not on the list"),
        ("http://mes.example:443/", "only https:// is sent to"),
        ("http://127.0.0.1:8080/", "only https:// is sent to"),
        ("https://user@mes.example/", "with a user"),
        ("https://other.example@mes.example/", "with a user"),
        ("https://mes.example@other.example/", "with a user"),
        ("https://mes.example/#part", "with a fragment"),
        ("https://mes.example\\@other.example/", "no URL"),
        ("https://mes.example\r\nx: y/", "no URL"),
        (" https://mes.example/", "no URL"),
        ("https://mes.exam\tple/", "no URL"),
        ("https://mes.example:0/", "no URL"),
        ("https://mes.example:/", "no URL"),
        ("https://mes.example:99999/", "no URL"),
        ("https://mes%2eexample/", "no URL"),
        ("https://[::1/", "no URL"),
        ("https:///hook", "no URL"),
        ("//mes.example/", "no URL"),
        ("ftp://mes.example/", "no URL"),
        ("file:///etc/passwd", "no URL"),
        ("https://mes.exämple/", "no URL"),
        ("https://mes.example/" + "x" * 2000, "no URL"),
        ("", "no URL"),
    ],
)
def test_what_is_not_plainly_on_the_list_may_not(url: str, words: str) -> None:
    with pytest.raises(TargetRefused, match=words):
        TARGETS.target(url)


@settings(max_examples=60, deadline=None)
@given(st.text(max_size=40).map("https://".__add__) | st.text(max_size=60))
@example("https://[v1.a]/")
@example("https://[::ffff:1%x]:8080/")
def test_whatever_is_written_is_on_the_list_or_refused(url: str) -> None:
    for targets in (TARGETS, WITH_LOOPBACK):
        try:
            target = targets.target(url)
        except TargetRefused:
            continue
        assert (target.host, target.port) in LISTED


@pytest.mark.parametrize("address", PRIVATE)
def test_no_address_that_is_not_public_is_sent_to(address: str) -> None:
    for targets in (TARGETS, WITH_LOOPBACK):
        with pytest.raises(TargetRefused, match="not public"):
            targets.judge(MES, [address])
        with pytest.raises(TargetRefused, match="not public"):
            targets.judge(MES, ["93.184.215.14", address])


@pytest.mark.parametrize("address", LOOPBACK)
def test_this_machine_is_sent_to_only_where_that_was_said(address: str) -> None:
    with pytest.raises(TargetRefused, match="this machine"):
        TARGETS.judge(MES, [address])
    WITH_LOOPBACK.judge(MES, [address])
    WITH_LOOPBACK.judge(Target("http", "127.0.0.1", 8080, "/"), [address])


@pytest.mark.parametrize("address", ["93.184.215.14", "2606:2800:21f::1", "64:ff9b::5db8:d70e"])
def test_public_addresses_are_sent_to_by_https_only(address: str) -> None:
    TARGETS.judge(MES, [address])
    with pytest.raises(TargetRefused, match="only https"):
        WITH_LOOPBACK.judge(Target("http", "mes.example", 80, "/"), [address])


@given(
    st.ip_addresses(network="10.0.0.0/8") | st.ip_addresses(network="fc00::/7") | st.ip_addresses(network="fe80::/10")
)
def test_no_address_of_a_private_network_is_sent_to(address: object) -> None:
    found = ip_address(str(address))
    forms = [str(found)]
    if found.version == 4:
        forms += [f"::ffff:{found}", str(ip_address(int(ip_address("64:ff9b::")) + int(found)))]
    for form in forms:
        with pytest.raises(TargetRefused):
            WITH_LOOPBACK.judge(MES, [form])


def test_a_name_without_an_address_is_not_sent_to() -> None:
    with pytest.raises(TargetRefused, match="no address"):
        TARGETS.judge(MES, [])


def test_the_list_is_written_as_it_is_read() -> None:
    assert frozenset(map(host_and_port, TARGETS.written)) == LISTED
    for wrong in ("", "mes.example/hook", "a@mes.example", "mes example", "https://mes.example"):
        with pytest.raises(TargetRefused):
            host_and_port(wrong)
