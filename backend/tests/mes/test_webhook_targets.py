"""Nothing is sent but to hosts and networks on the list, by HTTPS; whatever somebody writes as a URL."""

from __future__ import annotations

from ipaddress import ip_address, ip_network

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from sequence_planner.mes.webhooks.targets import Target, TargetRefused, Targets, host_and_port, network
from support.examples import examples

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


@examples(60)
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
        WITH_LOOPBACK.judge(Target("http", "mes.example", 443, "/"), [address])


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


PLANT = Targets(
    LISTED, networks=tuple(map(network, ("10.1.2.0/24", "192.168.7.9/32", "fd00:7::/32", "169.254.9.9/32")))
)
LOGISTICS = Target("https", "logistics.plant", 8443, "/")


@pytest.mark.parametrize(
    "address",
    ["10.1.2.0", "10.1.2.255", "192.168.7.9", "fd00:7::1", "::ffff:10.1.2.3", "64:ff9b::a01:203", "169.254.9.9"],
)
@pytest.mark.parametrize("target", [MES, LOGISTICS])
def test_a_network_on_the_list_may_be_sent_to_whatever_the_name(target: Target, address: str) -> None:
    assert PLANT.target(f"https://{target.authority}/") == target
    PLANT.judge(target, [address])
    with pytest.raises(TargetRefused, match="only https"):
        PLANT.target("http://logistics.plant/")


@pytest.mark.parametrize(
    "address", ["10.1.3.0", "10.0.0.1", "192.168.7.8", "172.16.0.1", "fd00:8::1", "::ffff:10.9.9.9"]
)
def test_no_other_private_network_is(address: str) -> None:
    with pytest.raises(TargetRefused, match="in a network that is not on the list"):
        PLANT.judge(MES, ["10.1.2.3", address])
    with pytest.raises(TargetRefused, match="or its network"):
        PLANT.judge(LOGISTICS, [address])


def test_a_public_address_needs_its_host_or_its_network_on_the_list() -> None:
    PLANT.judge(MES, ["93.184.215.14", "10.1.2.3"])
    with pytest.raises(TargetRefused, match="not on the list"):
        PLANT.judge(LOGISTICS, ["10.1.2.3", "93.184.215.14"])
    Targets(networks=(network("93.184.215.0/24"),)).judge(LOGISTICS, ["93.184.215.14"])


@pytest.mark.parametrize(
    ("within", "address"),
    [
        ("127.0.0.0/8", "127.0.0.1"),
        ("::/1", "::1"),
        ("169.254.0.0/16", "169.254.169.254"),
        ("169.254.0.0/16", "::ffff:169.254.169.254"),
        ("169.254.0.0/16", "64:ff9b::a9fe:a9fe"),
        ("127.0.0.0/8", "64:ff9b::7f00:1"),
        ("127.0.0.0/8", "2002:7f00:1::1"),
        ("fe80::/10", "fe80::1"),
        ("224.0.0.0/3", "224.0.0.1"),
        ("224.0.0.0/3", "240.0.0.1"),
        ("224.0.0.0/3", "255.255.255.255"),
        ("0.0.0.0/1", "0.0.0.0"),
        ("0.0.0.0/1", "0.0.0.7"),
        ("::/1", "::"),
        ("ff00::/8", "ff02::1"),
    ],
)
def test_what_is_special_is_sent_to_only_where_exactly_that_is_on_the_list(within: str, address: str) -> None:
    wide = Targets(LISTED, networks=(network(within),))
    for target in (MES, LOGISTICS):
        with pytest.raises(TargetRefused, match=r"this machine|exactly that address"):
            wide.judge(target, [address])
    meant = address.replace("::ffff:", "").replace("64:ff9b::a9fe:a9fe", "169.254.169.254")
    if "." in meant or meant in ("::1", "fe80::1", "::", "ff02::1"):
        Targets(networks=(network(meant),)).judge(LOGISTICS, [address])


def test_an_address_that_is_named_as_a_host_is_sent_to_and_no_other() -> None:
    exact = Targets(frozenset(map(host_and_port, ("10.9.8.7", "169.254.1.2:8443"))))
    exact.judge(exact.target("https://10.9.8.7/hook"), ["10.9.8.7"])
    exact.judge(exact.target("https://169.254.1.2:8443/"), ["169.254.1.2"])
    for url in ("https://10.9.8.6/", "https://169.254.1.2/", "https://169.254.169.254:8443/"):
        with pytest.raises(TargetRefused, match="not on the list"):
            exact.target(url)
    with pytest.raises(TargetRefused, match="not public"):
        exact.judge(exact.target("https://10.9.8.7/hook"), ["10.9.8.7", "10.9.8.8"])


@given(st.ip_addresses(), st.ip_addresses(v=4), st.integers(1, 32), st.booleans())
def test_whatever_is_sent_to_is_public_or_in_a_network_of_the_list(
    asked: object, inside: object, prefix: int, listed: bool
) -> None:
    wide = network(str(ip_network(f"{inside}/{prefix}", strict=False)))
    targets = Targets(LISTED, networks=(wide,))
    try:
        targets.judge(MES if listed else LOGISTICS, [str(asked)])
    except TargetRefused:
        return
    address = ip_address(str(asked))
    assert address in wide or getattr(address, "ipv4_mapped", None) or address.is_global or address.version == 6
    assert prefix == 32 or not (address.is_loopback or address.is_link_local or address.is_multicast)
    assert listed or address in wide or address.version == 6


@pytest.mark.parametrize("wrong", ["10.1.2.3/24", "0.0.0.0/0", "::/0", "plant", "", "10.1.2.0/33", "10.1.2.0/24:443"])
def test_what_is_no_network_is_refused(wrong: str) -> None:
    with pytest.raises(TargetRefused, match="network"):
        network(wrong)
