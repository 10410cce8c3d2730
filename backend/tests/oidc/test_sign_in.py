"""Signing in with a real provider: who comes in, as whom, with which role, and what becomes of it."""

from __future__ import annotations

import time
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest

from oidc.conftest import SESSION, Scene
from sequence_planner.auth import users
from sequence_planner.auth.oidc import provider
from sequence_planner.auth.oidc.provider import DiscoveryCache
from sequence_planner.auth.roles import Role
from sequence_planner.auth.users import Person
from sequence_planner.core.actor import SYSTEM
from server.test_acting import problem


def someone(scene: Scene, name: str) -> Person:
    with scene.server.identity.database.reading() as connection:
        found = users.find_by_name(connection, name)
    assert found is not None
    return found


def test_a_person_is_made_at_the_first_sign_in_and_found_at_the_next(scene: Scene) -> None:
    with scene.browser() as browser:
        brought = scene.brought(browser, "ada", "/state?of=robot")
        assert brought.page == f"{scene.server.address}/sign-in/provider"
        answer = scene.finish(browser, brought.said)
        assert answer.status_code == 200, answer.text
        told = answer.json()
        assert told["to"] == "/state?of=robot"
        assert (told["session"]["state"], told["session"]["must_change_password"]) == ("signed-in", False)
        person = told["session"]["person"]
        assert (person["name"], person["role"], person["issuer"]) == ("Ada", "administrator", scene.provider.issuer)
        set_cookies = [each.lower() for each in answer.headers.get_list("set-cookie")]
        [kept] = [each for each in set_cookies if each.startswith(f"sequence-planner-{scene.server.settings.port}=")]
        assert {"httponly", "path=/", "samesite=strict"} == {each.strip() for each in kept.split(";")[1:]}
        assert any("sign-in" in each and "max-age=0" in each for each in set_cookies)
        assert browser.get("/api/v1/users").status_code == 200
    scene.provider.say("ada", preferred_username="Ada the Second")
    with scene.browser() as browser:
        again = scene.sign_in(browser, "ada").json()["session"]["person"]
    assert again == person
    [second, first] = scene.entries()
    assert first.details["issuer"] == second.details["issuer"] == scene.provider.issuer
    assert first.details["role"] == "administrator"
    [made] = scene.entries("person-created")
    assert (made.details["known_as"], made.actor.name) == ("ada", "Ada")


def test_who_has_no_role_stays_out_and_the_journal_says_so(scene: Scene) -> None:
    with scene.browser() as browser:
        problem(scene.sign_in(browser, "nils"), 403, "no-role")
        assert browser.get(SESSION).json()["state"] == "first-start"
    [refused] = scene.entries()
    assert (refused.outcome, refused.details["because"]) == ("refused", "no-role")
    assert scene.entries("person-created") == []


def test_the_role_is_taken_anew_at_each_sign_in(scene: Scene) -> None:
    with scene.browser() as before, scene.browser() as after:
        assert scene.sign_in(before, "ada").json()["session"]["person"]["role"] == "administrator"
        scene.provider.say("ada", groups="station-operators")
        assert scene.sign_in(after, "ada").json()["session"]["person"]["role"] == "operator"
        problem(before.get("/api/v1/users"), 401, "signed-out")
        problem(after.get("/api/v1/users"), 403, "role-too-low")
        scene.provider.say("ada", groups=[])
        with scene.browser() as third:
            problem(scene.sign_in(third, "ada"), 403, "no-role")
        problem(after.get("/api/v1/audit"), 401, "signed-out")
    [changed] = scene.entries("person-changed")
    assert changed.details["role"] == ["administrator", "operator"]


def test_disabled_people_stay_out(scene: Scene) -> None:
    with scene.browser() as browser:
        scene.sign_in(browser, "otto")
        otto = someone(scene, "Otto")
        with scene.server.identity.database.writing() as connection:
            users.change(connection, otto.id, otto.revision, SYSTEM, time.time(), disabled=True)
        problem(scene.sign_in(browser, "otto"), 403, "disabled")
        assert browser.get(SESSION).json()["person"] is None
    assert scene.entries()[0].actor.name == "Otto"


@pytest.mark.parametrize("wanted", ["Ada", "ada", "Аda", "demonstration", "\u0000", "x" * 300])
def test_a_name_that_somebody_has_is_never_taken_over(scene: Scene, wanted: str) -> None:
    local = scene.server.person(Role.ADMINISTRATOR, name="Ada")
    scene.provider.say("otto", preferred_username=wanted, name=wanted)
    with scene.browser() as browser:
        person = scene.sign_in(browser, "otto").json()["session"]["person"]
    assert person["id"] != local.id
    assert person["role"] == "operator"
    assert person["name"] not in ("Ada", "demonstration", "")
    assert someone(scene, "Ada") == local


def test_who_comes_from_the_provider_has_no_password_here(scene: Scene) -> None:
    with scene.browser() as browser, scene.browser() as ada:
        otto = scene.sign_in(browser, "otto").json()["session"]["person"]
        for password in ("", "none", "a password that is long"):
            answer = browser.post(SESSION, json={"name": "Otto", "password": password or "x"})
            problem(answer, 401, "wrong-name-or-password")
        change = {"old": "a password that is long", "new": "another one that is long"}
        problem(browser.put(f"{SESSION}/password", json=change), 403, "no-password")
        scene.sign_in(ada, "ada")
        given = {"password": "given by an administrator"}
        problem(ada.put(f"/api/v1/users/{otto['id']}/password", json=given), 409, "no-password-here")
        revision = next(each for each in ada.get("/api/v1/users").json()["people"] if each["id"] == otto["id"])
        headers = {"If-Match": f'"{revision["revision"]}"'}
        changed = ada.patch(f"/api/v1/users/{otto['id']}", json={"role": "administrator"}, headers=headers)
        problem(changed, 409, "role-from-provider")
        assert revision["issuer"] == scene.provider.issuer
        assert ada.patch(f"/api/v1/users/{otto['id']}", json={"disabled": True}, headers=headers).status_code == 200


def test_an_administrator_gets_back_in_with_a_password_until_the_provider_is_there_again(scene: Scene) -> None:
    office, password = scene.server.identity, "for the time without it"
    with scene.browser() as browser, scene.browser() as again:
        ada = scene.sign_in(browser, "ada").json()["session"]["person"]
        hashed = scene.server.loop.run(office.passwords.hash(password))
        with office.database.writing() as connection:
            users.set_password(connection, ada["id"], hashed, SYSTEM, time.time(), temporary=False, recovery=True)
        assert browser.post(SESSION, json={"name": "Ada", "password": password}).status_code == 200
        scene.sign_in(again, "ada")
        problem(browser.get("/api/v1/users"), 401, "signed-out")
        answer = browser.post(SESSION, json={"name": "Ada", "password": password})
        problem(answer, 401, "wrong-name-or-password")


def test_signing_out_ends_the_session_here_and_tells_where_the_other_one_ends(scene: Scene) -> None:
    with scene.browser() as browser:
        scene.sign_in(browser, "otto")
        assert browser.delete(SESSION).status_code == 204
        told = browser.get(SESSION).json()
        assert told["person"] is None
        assert told["provider"]["title"] == "Works ID"
        where = urlsplit(told["provider"]["sign_out"])
        asked = parse_qs(where.query)
        assert asked["post_logout_redirect_uri"] == [f"{scene.server.address}/sign-in"]
        with httpx.Client() as there:
            answer = there.get(where.geturl())
        assert answer.status_code == 200
        assert "logout" in answer.text.lower()


def test_the_keys_of_a_provider_may_change(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(provider, "KEYS_AGAIN", 0.0)
    with scene.browser() as browser:
        assert scene.sign_in(browser, "otto").status_code == 200
        scene.provider.stop()
        scene.provider.start("second")
        assert scene.sign_in(browser, "otto").status_code == 200


def test_while_the_provider_is_away_people_sign_in_with_passwords(scene: Scene) -> None:
    office, password = scene.server.identity, "seven green bolts"
    hashed = scene.server.loop.run(office.passwords.hash(password))
    with office.database.writing() as connection:
        users.create(connection, "Eva", Role.OPERATOR, hashed, SYSTEM, time.time(), temporary=False)
    with scene.browser() as browser, scene.browser() as late:
        brought = scene.brought(late, "otto")
        scene.provider.stop()
        try:
            office.provider.provider._known = DiscoveryCache(scene.provider.issuer)  # type: ignore[union-attr]
            problem(browser.post(f"{SESSION}/provider", json={}), 503, "provider-unavailable")
            problem(scene.finish(late, brought.said), 503, "provider-unavailable")
            assert browser.get(SESSION).json()["provider"] == {"title": "Works ID", "sign_out": None}
            assert browser.post(SESSION, json={"name": "Eva", "password": password}).status_code == 200
        finally:
            scene.provider.start()
        assert scene.sign_in(late, "otto").status_code == 200
