"""A robot that is stuck on its way to a tool, at a station that runs: who is told what, and what is proposed."""

from __future__ import annotations

from running.faults import LONGEST_WAY, after, truck_at_work

TOOL = "AttachLFToolTCPPose"


def test_a_robot_that_is_stuck_is_not_blamed_on_the_end_effector_that_feels_the_tool() -> None:
    with truck_at_work() as (_, person, place):
        going = {"robot.target_pose": TOOL, "robot.pose": "UNKNOWN"}
        assert person.until(lambda: {name: person.value(name) for name in going} == going, LONGEST_WAY)
        seen = after(person, place, "robot stuck")
        alarms = person.get("alarms")["alarms"]
        assert [key for key, alarm in alarms.items() if alarm["priority"] != "low"] == ["still:robot"]
        parts = alarms["still:robot"]["parts"]
        assert any(part.startswith("End-effector reports end_effector.tool == LFTOOL") for part in parts)
        first, *others = seen.advice["offers"]
        assert {each["name"]: each["then"] for each in first["physical"]}["robot.pose"] == TOOL
        for offer in others:
            assert all(each["then"] != "UNKNOWN" for each in offer["physical"])
            assert not any(each["name"].startswith("end_effector.") for each in offer["physical"])
