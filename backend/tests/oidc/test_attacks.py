"""Attempts to get in past the provider: with answers, codes and tokens that are forged, stolen, replayed or planted."""

from __future__ import annotations

import time
from typing import Any

import httpx
import pytest

from auth.situations import everything_kept
from oidc.conftest import SESSION, Scene
from oidc.providing import CLIENT, SECRET, at_provider
from sequence_planner.auth.roles import Role
from sequence_planner.auth.tokens import new_token
from sequence_planner.server.http.credentials import flow_cookie, session_cookie
from server.test_acting import problem

UNFIT = "provider-answer-invalid"


def stays_out(browser: httpx.Client) -> None:
    assert browser.get(SESSION).json()["person"] is None


@pytest.mark.parametrize("state", ["x", "x" * 43, "\u0000", "Ä"])
def test_a_forged_state_is_not_taken_and_does_not_end_the_sign_in_under_way(scene: Scene, state: str) -> None:
    with scene.browser() as browser:
        brought = scene.brought(browser, "otto")
        problem(scene.finish(browser, {**brought.said, "state": state}), 403, "sign-in-not-begun")
        stays_out(browser)
        assert scene.finish(browser, brought.said).status_code == 200
    assert [each.details["because"] for each in scene.entries() if each.outcome == "refused"] == ["sign-in-not-begun"]


def test_nobody_is_signed_in_as_somebody_else_by_a_link(scene: Scene) -> None:
    """Login CSRF: the attacker's own answer, opened in the browser of a victim, who may have begun to sign in too."""
    with scene.browser() as attacker, scene.browser() as victim, scene.browser() as other:
        brought = scene.brought(attacker, "otto")
        problem(scene.finish(other, brought.said), 403, "sign-in-not-begun")
        scene.begin(victim)
        problem(scene.finish(victim, brought.said), 403, "sign-in-not-begun")
        stays_out(victim)
        stays_out(other)


@pytest.mark.parametrize("headers", [{"Origin": "http://evil.example"}, {"Sec-Fetch-Site": "cross-site"}])
def test_a_foreign_page_neither_begins_nor_finishes(scene: Scene, headers: dict[str, str]) -> None:
    with scene.browser() as browser:
        brought = scene.brought(browser, "otto")
        for path, body in (("provider", {}), ("provider/answer", brought.said)):
            problem(browser.post(f"{SESSION}/{path}", json=body, headers=headers), 403, "foreign-origin")
        assert browser.get(f"{SESSION}/provider/answer", params=brought.said).status_code == 405
        stays_out(browser)


def test_an_answer_works_once(scene: Scene) -> None:
    with scene.browser() as browser:
        brought = scene.brought(browser, "otto")
        flow = browser.cookies[flow_cookie(scene.server.settings)]
        assert scene.finish(browser, brought.said).status_code == 200
        with scene.browser() as thief:
            thief.cookies.set(flow_cookie(scene.server.settings), flow, domain="127.0.0.1", path="/")
            problem(scene.finish(thief, brought.said), 403, "sign-in-not-begun")


def test_a_code_of_another_sign_in_is_not_taken(scene: Scene) -> None:
    """A stolen code, put into the answer of a sign-in that the thief has begun: PKCE and nonce tie it to its own."""
    with scene.browser() as victim, scene.browser() as thief:
        stolen = scene.brought(victim, "ada").said["code"]
        own = scene.brought(thief, "otto").said
        problem(scene.finish(thief, {**own, "code": stolen}), 403, UNFIT)
        stays_out(thief)
        used = scene.brought(victim, "ada").said
        assert scene.finish(victim, used).status_code == 200
        problem(scene.finish(thief, {**scene.brought(thief, "otto").said, "code": used["code"]}), 403, UNFIT)


def test_a_sign_in_takes_ten_minutes_at_most(scene: Scene) -> None:
    with scene.browser() as browser:
        brought = scene.brought(browser, "otto")
        scene.server.identity.now = lambda: time.time() + 601
        problem(scene.finish(browser, brought.said), 403, "sign-in-not-begun")


def test_an_answer_of_another_provider_is_not_taken(scene: Scene) -> None:
    with scene.browser() as browser:
        brought = scene.brought(browser, "otto").said
        assert brought["iss"] == scene.provider.issuer
        problem(scene.finish(browser, {**brought, "iss": "https://evil.example"}), 403, UNFIT)
        brought = scene.brought(browser, "otto").said
        del brought["iss"]
        problem(scene.finish(browser, brought), 403, UNFIT)


def test_what_the_provider_refuses_is_said(scene: Scene) -> None:
    with scene.browser() as browser:
        brought = scene.brought(browser, "otto").said
        told = {"state": brought["state"], "iss": brought["iss"], "error": "access_denied"}
        refused = problem(scene.finish(browser, told), 403, "provider-refused")
        assert "access_denied" in refused["detail"]
        script = {**told, "error": "<script>"}
        problem(scene.finish(browser, script), 422, "invalid-request")


HOUR = 3600.0
NOW = time.time()
# What is wrong with each, in the words of the refusal, and how it is made.
FORGED: dict[str, tuple[str, dict[str, Any]]] = {
    "wrong nonce": ("another sign-in", {"claims": {"nonce": "x" * 43}}),
    "no nonce": ("another sign-in", {"without": ["nonce"]}),
    "wrong audience": ("for another client", {"claims": {"aud": "another"}}),
    "audience of another beside": ("made out to another", {"claims": {"aud": [CLIENT, "another"]}}),
    "made out to another": ("made out to another", {"claims": {"aud": [CLIENT, "another"], "azp": "another"}}),
    "no audience": ("for another client", {"without": ["aud"]}),
    "another issuer": ("another issuer", {"claims": {"iss": "https://evil.example"}}),
    "expired": ("has expired", {"claims": {"exp": NOW - HOUR}}),
    "never expires": ("has expired", {"without": ["exp"]}),
    "expires as text": ("has expired", {"claims": {"exp": "2099"}}),
    "of a time to come": ("time to come", {"claims": {"iat": NOW + HOUR}}),
    "not valid yet": ("not valid yet", {"claims": {"nbf": NOW + HOUR}}),
    "of somebody who was there long ago": ("some time ago", {"claims": {"auth_time": NOW - HOUR}}),
    "of nobody": ("whom it is about", {"without": ["sub"]}),
    "of no text": ("whom it is about", {"claims": {"sub": 7}}),
    "of somebody else than the rest": ("somebody else", {"claims": {"sub": "ada"}}),
    "alg none": ("not signed as it must be", {"header": {"alg": "none"}}),
    "alg none without key": ("not signed as it must be", {"header": {"alg": "none", "kid": None}}),
    "signed with the client's secret": ("not signed as it must be", {"header": {"alg": "HS256"}, "secret": SECRET}),
    "signed with nothing": ("not signed as it must be", {"header": {"alg": "HS256"}}),
    "a wrong signature": ("signature", {"broken": True}),
    "an unknown key": ("none of its own", {"header": {"kid": "of nobody"}}),
    "a key of its own": ("none of its own", {"header": {"kid": "of nobody", "jwk": {"kty": "oct", "k": "AAAA"}}}),
}


@pytest.mark.parametrize("how", FORGED)
def test_a_forged_token_lets_nobody_in(scene: Scene, how: str) -> None:
    with scene.browser() as browser:
        brought = scene.brought(browser, "otto")
        wrong, forge = FORGED[how]
        scene.provider.tell(forge=forge)
        assert wrong in problem(scene.finish(browser, brought.said), 403, UNFIT)["detail"]
        stays_out(browser)
    assert scene.entries("person-created") == []


def test_a_token_that_is_only_made_again_is_taken(scene: Scene) -> None:
    """So that the tokens above are refused for what is wrong with them."""
    with scene.browser() as browser:
        brought = scene.brought(browser, "otto")
        scene.provider.tell(forge={"claims": {"azp": CLIENT}})
        assert scene.finish(browser, brought.said).status_code == 200


@pytest.mark.parametrize(
    "to",
    [
        "https://evil.example",
        "//evil.example",
        "/\\evil.example",
        "\\\\evil.example",
        "/.//evil.example",
        "/../..//evil.example",
        "/\t/evil.example",
        " /state",
        "/state\n",
        "javascript:alert(1)",
        "state",
        "",
    ],
)
def test_a_sign_in_leads_to_pages_of_this_server_alone(scene: Scene, to: str) -> None:
    with scene.browser() as browser:
        problem(browser.post(f"{SESSION}/provider", json={"to": to}), 422, "invalid-request")


def test_a_session_that_was_planted_is_not_taken_over(scene: Scene) -> None:
    planted, _ = scene.server.session(scene.server.person(Role.VIEWER))
    for before in (planted, new_token()):
        with scene.browser() as browser:
            browser.cookies.set(session_cookie(scene.server.settings), before, domain="127.0.0.1", path="/")
            answer = scene.sign_in(browser, "otto")
            assert answer.status_code == 200
            assert before not in "".join(answer.headers.get_list("set-cookie"))
            shown = httpx.get(f"{scene.server.address}/api/v1/state", headers=scene.server.cookie(before))
            assert shown.status_code == 401


def test_who_finds_a_browser_that_is_still_known_at_the_provider_is_not_let_in(scene: Scene) -> None:
    """As at a terminal that people share: the one before has signed out of the station, or was not there for long."""
    with scene.browser() as terminal, httpx.Client() as there:
        brought = at_provider(there, scene.begin(terminal), "otto")
        assert scene.finish(terminal, brought.said).status_code == 200
        assert terminal.delete(SESSION).status_code == 204
        asked = there.get(scene.begin(terminal))
        while asked.is_redirect:
            asked = there.get(asked.url.join(asked.headers["location"]))
            assert not str(asked.url).startswith(scene.server.address), "it leads back by itself"
        assert 'name="password"' in asked.text


def test_one_address_does_not_begin_without_end(scene: Scene) -> None:
    with scene.browser() as browser:
        answers = [browser.post(f"{SESSION}/provider", json={}) for _ in range(21)]
    assert [each.status_code for each in answers] == [200] * 20 + [429]
    assert int(answers[-1].headers["retry-after"]) <= 60


def test_however_many_forged_answers_come_one_record_a_minute_tells_of_them(scene: Scene) -> None:
    with scene.browser() as browser:
        for _ in range(30):
            problem(scene.finish(browser, {"state": "x", "code": "y"}), 403, "sign-in-not-begun")
    assert len(scene.entries()) == 1


def test_no_secret_of_a_sign_in_is_kept(scene: Scene) -> None:
    with scene.browser() as browser:
        brought = scene.brought(browser, "otto")
        secrets = [browser.cookies[flow_cookie(scene.server.settings)], brought.said["state"], brought.said["code"]]
        kept = everything_kept(scene.server.identity.database)
        assert scene.finish(browser, brought.said).status_code == 200
        kept += everything_kept(scene.server.identity.database)
    for secret in (*secrets, SECRET):
        assert secret not in kept
