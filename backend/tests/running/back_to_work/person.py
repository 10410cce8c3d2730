"""Somebody who gets a station back to work through REST alone, doing what its advice and its refusals say."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from typing import Any, Protocol

import httpx

Document = dict[str, Any]

MOST_ROUNDS = 15  # of asking and doing until the station works again
QUIET = 1.0  # seconds without a change of the state, after which nothing moves any more
LONGEST_ERRAND, LONGEST_MOVING, LONGEST_WITHOUT_WORK = 90.0, 20.0, 60.0  # seconds
AWAY = (httpx.codes.BAD_GATEWAY, httpx.codes.SERVICE_UNAVAILABLE, httpx.codes.GATEWAY_TIMEOUT)


class StuckError(AssertionError):
    """The station says nothing that would get it back to work, or what it says does not."""


class Place(Protocol):
    """A station that runs."""

    @property
    def browser(self) -> httpx.Client:
        """Somebody is signed in there."""


class Hands(Protocol):
    """What the person does beside the station, and knows from that."""

    known: dict[str, object]  # estimates that are otherwise than the station believes

    def can_bring(self, changes: Mapping[str, object]) -> bool:
        """Whether hands reach that."""

    def bring(self, changes: Mapping[str, object]) -> None:
        """Give measured variables these values, at their devices."""

    def online(self, resource: str) -> None:
        """Bring a resource back."""

    def told_anew(self, resources: Collection[str]) -> None:
        """Devices were told something else: a drive that stood still takes a new command."""

    def make_true(self, estimate: str, value: object) -> bool:
        """Do to the product what an estimate shall say; False where hands cannot."""

    def serve(self, task: Document) -> None:
        """A task on the watch is done, and was acknowledged."""


class Person:
    """An engineer who is signed in. `seen` counts what was done."""

    def __init__(self, station: Place, hands: Hands, *, serves: bool = True) -> None:
        """`serves` the watch of the station too."""
        self._station = station
        self._serves = serves
        self.hands = hands
        self.seen: Counter[str] = Counter()
        self.story: list[str] = []

    def tell(self, what: str) -> None:
        """For who reads why it went wrong."""
        self.story.append(f"{time.strftime('%H:%M:%S')} {what}")

    def get(self, path: str) -> Document:
        """A document of the station; a busy or restarting one is asked again."""
        for _ in range(60):
            try:
                answer = self._station.browser.get(path, timeout=30)
                if answer.status_code not in AWAY:
                    answer.raise_for_status()
                    document: Document = answer.json()
                    return document
            except httpx.TransportError:
                pass
            time.sleep(0.5)
        raise StuckError(f"{path} cannot be read")

    def act(self, method: str, path: str, body: object) -> httpx.Response:
        """Ask for something; control is taken where the refusal asks for that."""
        for _ in range(20):
            try:
                answer = self._station.browser.request(method, path, json=body, timeout=30)
            except httpx.TransportError:
                time.sleep(0.5)
                continue
            slug = problem(answer)
            if slug == "control-needed":
                self._station.browser.put("control-lock", json={"over": None}).raise_for_status()
            elif answer.status_code in AWAY:
                time.sleep(0.5)
            else:
                return answer
        raise StuckError(f"{method} {path} is not answered")

    def do(self, method: str, path: str, body: object) -> None:
        """What must not be refused."""
        answer = self.act(method, path, body)
        if answer.status_code >= 300:
            raise StuckError(f"{method} {path} {body}: {answer.status_code} {answer.text}")

    def value(self, name: str) -> object:
        return self.get("state")["variables"][name]["value"]

    def serve(self) -> None:
        """Do and acknowledge whatever the watch asks for."""
        if not self._serves:
            return
        for id_, task in self.get("tasks")["tasks"].items():
            if self.act("POST", f"tasks/{id_}/acknowledgement", {"revision": task["revision"]}).status_code < 300:
                self.hands.serve(task)

    def until(self, what: Callable[[], bool], seconds: float) -> bool:
        """Serve the watch until something is so; False if it does not become so."""
        end = time.monotonic() + seconds
        while not what():
            if time.monotonic() > end:
                return False
            self.serve()
            time.sleep(0.1)
        return True

    def wait_for_rest(self) -> None:
        """Nothing moves any more, or it has moved for long enough."""
        last, since = -1, time.monotonic()

        def quiet() -> bool:
            nonlocal last, since
            revision = self.get("station")["revision"]
            if revision != last:
                last, since = revision, time.monotonic()
            return time.monotonic() - since > QUIET

        self.until(quiet, LONGEST_MOVING)

    def completed(self) -> int:
        return sum(int(each["completed"]) for each in self.get("operations")["operations"].values())

    def works(self, seconds: float = LONGEST_WITHOUT_WORK, operations: int = 1) -> bool:
        """Whether so many operations are done in this time."""
        before = self.completed()
        return self.until(lambda: self.completed() >= before + operations, seconds)

    def get_back(self, prefers: str = "") -> None:
        """Until the station works again. Offers of the kind that is preferred are taken before others."""
        for _ in range(MOST_ROUNDS):
            if self.look_and_act(prefers) and self.works():
                return
        raise StuckError(f"it does not work after {MOST_ROUNDS} rounds")

    def look_and_act(self, prefers: str) -> bool:
        """One look and one act; whether the station has been told to go on."""
        station = self.get("station")
        if station["production"] == "waiting":
            self.start_production(station)
        self._let_errands_end()
        if station["mode"] != "restart":
            self.do("POST", "restart/enter", {"reason": "to get back to work"})
        self.wait_for_rest()
        if self.hands.known:
            self._correct_what_is_known()
        advice = self._advice()
        offer = self._chosen(advice, prefers)
        self.tell(f"{offer['kind']}: {offer['title']}")
        if offer["kind"] == "replan" or self._nothing_to_do(offer):
            self.do("POST", "restart/leave", {})
            answer = self.act("PUT", "mode", {"mode": "automatic"})
            self.tell(f"goes on: {problem(answer) or 'yes'}")
            return answer.status_code < 300
        self._carry_out(offer)
        return False

    def _advice(self) -> Document:
        """Asked for again as long as there was too little time to find anything."""
        for _ in range(5):
            advice = self.get("recovery/proposals")
            if advice["offers"] or advice["complete"]:
                break
            self.seen["advice asked for again"] += 1
        return advice

    def _nothing_to_do(self, offer: Document) -> bool:
        return not (
            offer["physical"] or offer["online"] or offer["in_service"] or offer["corrections"] or offer["errand"]
        )

    def start_production(self, station: Document) -> None:
        """Decide on outputs, then start production."""
        for name, output in station["undecided"].items():
            quiet = output["quiet"]
            value = quiet[0] if quiet else output["value"]
            self.tell(f"decides {name} := {value}")
            self.seen["outputs decided"] += 1
            answer = self.act("PUT", "restored-outputs", {"values": {name: value}, "reason": "it stays where it is"})
            if problem(answer) == "output-unsafe":
                self.do("PUT", "restored-outputs", {"values": {name: output["value"]}, "reason": "it shall go on"})
        self.do("POST", "production/start", {"reason": "to get back to work"})

    def _let_errands_end(self) -> None:
        if not self.until(lambda: self.get("station")["errand"] is None, LONGEST_ERRAND):
            self.tell("the errand does not end: stopped")
            self.seen["errands stopped"] += 1
            self.do("POST", "operator-plans/stop", {"reason": "nothing goes on"})

    def _correct_what_is_known(self) -> None:
        """The person has seen it: no advice is needed for that."""
        values = dict(self.hands.known)
        preview = self.act("POST", "corrections/preview", {"values": values}).json()
        answer = self.act(
            "POST", "corrections", {"values": values, "revision": preview["revision"], "reason": "I have seen it"}
        )
        self.tell(f"corrects {values}: {problem(answer) or 'done'}")
        if answer.status_code < 300:
            self.hands.known.clear()
            self.seen["corrections"] += 1
        elif problem(answer) != "stale-revision":
            raise StuckError(f"{values}: {answer.text}")

    def _chosen(self, advice: Document, prefers: str) -> Document:
        """The first that hands are able to, but what is preferred before it, and what needs none at the product."""
        able = [offer for offer in advice["offers"] + advice["if_checked"] if self.hands.can_bring(brought(offer))]
        offers = [offer for offer in able if not offer["left_out"]]
        if not offers:
            raise StuckError(f"no way back is offered: {advice}, {self.get('alarms')}")
        first = [offer for offer in offers if offer["kind"] == "replan"]
        wanted = [offer for offer in offers if offer["kind"] == prefers]
        plain = [offer for offer in offers if not offer["corrections"]]
        chosen: Document = (first or wanted or plain or offers)[0]
        return chosen

    def _carry_out(self, offer: Document) -> None:
        if offer["physical"] or offer["online"] or offer["in_service"]:
            for resource in offer["online"]:
                self.hands.online(resource)
            self.until(lambda: self._online(offer["online"]), LONGEST_MOVING * 3)
            for name in offer["in_service"]:
                self.do("PUT", f"availability/ability/{name}", {"in_service": True, "reason": "it was looked after"})
            if offer["physical"]:
                self.hands.bring(brought(offer))
            self.seen["physical changes"] += 1
            return
        for change in offer["corrections"]:
            if not self.hands.make_true(change["name"], change["then"]):
                raise StuckError(f"{change} is offered, and is not so")
        self.take(offer)

    def _online(self, resources: Collection[str]) -> bool:
        seen = self.get("resources")["resources"]
        return all(seen[name]["online"] for name in resources)

    def take(self, offer: Document) -> bool:
        """Take an offer and let it be carried out; False where the state has moved meanwhile."""
        steps = [] if offer["errand"] is None else offer["errand"]["steps"]
        corrections = {change["name"]: change["then"] for change in offer["corrections"]}
        body = {
            "offer": offer["id"],
            "starts": [step["ability"] for step in steps],
            "corrections": corrections,
            "reason": "as advised",
        }
        answer = self.act("POST", "operator-plans", body)
        self.tell(f"takes {offer['kind']} {body['starts']} {corrections}: {problem(answer) or 'done'}")
        if problem(answer) in ("stale-revision", "proposal-gone"):
            self.seen["offers asked for again"] += 1
            return False
        if answer.status_code >= 300:
            raise StuckError(f"{offer['title']} is refused: {answer.text}")
        self.hands.told_anew({step["resource"] for step in steps})
        self.seen["corrections"] += bool(corrections)
        self.seen["restart abilities"] += any(step["restart"] for step in steps)
        self.seen["ways back from outside the safe states"] += offer["unsupervised"]
        self.seen["resets"] += offer["kind"] == "reset"
        self._let_errands_end()
        self.tell(f"ended: {self.get('station')['last_errand']}")
        return True

    def reset(self, operation: str) -> bool:
        """Reset an operation; False where there is no plan for that."""
        for _ in range(5):
            answer = self.act("POST", "operator-plans/reset-preview", {"operation": operation})
            if answer.status_code >= 300:
                self.tell(f"reset of {operation}: {answer.text}")
                return False
            if self.take(answer.json()):
                return True
        return False


def brought(offer: Document) -> dict[str, object]:
    """What somebody does at devices for an offer: measured variables and their values."""
    return {change["name"]: change["then"] for change in offer["physical"]}


def problem(answer: httpx.Response) -> str:
    """The last word of a refusal's type; empty where nothing was refused."""
    if answer.status_code < 300:
        return ""
    try:
        return str(answer.json()["type"]).rpartition("/")[2]
    except (ValueError, KeyError):
        return answer.text
