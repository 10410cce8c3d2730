"""The poses that are saved in the robot's driver. Joint angles in rad, invented."""

from __future__ import annotations

Joints = tuple[float, ...]

PAIRS = tuple(f"AtBoltPair{number}TCPPose" for number in range(1, 7))
HOME = "HomeJOINTPose"
ABOVE_ENGINE = "AboveEngineTCPPose"
FRAME_IN_KIT = "AtLadderFrameTCPPose"
FRAME_ON_ENGINE = "LadderFrameOnEngineTCPPose"
OIL_FILTER = "OF_1_TIGHTENED"

# Where each tool stands, and is met by the robot.
TOOL_PLACES = {"LFTOOL": "AttachLFToolTCPPose", "ATLASTOOL": "AttachAtlasTCPPose", "OFTOOL": "AttachOFToolTCPPose"}

POSES: dict[str, Joints] = {
    HOME: (0.0, -1.57, 1.57, -1.57, -1.57, 0.0),
    ABOVE_ENGINE: (0.8, -1.2, 1.4, -1.77, -1.57, 0.8),
    **{
        pair: (0.65 + 0.06 * number, -0.95, 1.55, -2.17, -1.57, 0.65 + 0.06 * number)
        for number, pair in enumerate(PAIRS)
    },
    "PRE_OF_1_UNTIGHTENED": (1.3, -1.1, 1.3, -1.6, -1.2, 1.3),
    OIL_FILTER: (1.3, -0.9, 1.5, -1.9, -1.2, 2.4),
    "AboveKitJOINTPose": (-0.8, -1.3, 1.4, -1.67, -1.57, -0.8),
    FRAME_IN_KIT: (-0.8, -1.0, 1.6, -2.17, -1.57, -0.8),
    FRAME_ON_ENGINE: (0.8, -0.9, 1.6, -2.27, -1.57, 0.8),
    "PreAttachAtlasFarJOINTPose": (2.0, -1.4, 1.5, -1.67, -1.57, 2.0),
    TOOL_PLACES["ATLASTOOL"]: (2.0, -1.1, 1.7, -2.17, -1.57, 2.0),
    "PreAttachLFToolFarJOINTPose": (-1.6, -1.4, 1.5, -1.67, -1.57, -1.6),
    TOOL_PLACES["LFTOOL"]: (-1.6, -1.1, 1.7, -2.17, -1.57, -1.6),
    "PreAttachOFToolFarJOINTPose": (-2.2, -1.4, 1.5, -1.67, -1.57, -2.2),
    TOOL_PLACES["OFTOOL"]: (-2.2, -1.1, 1.7, -2.17, -1.57, -2.2),
}

# Where the arm is over, at or on the engine.
AT_ENGINE = frozenset({ABOVE_ENGINE, *PAIRS, FRAME_ON_ENGINE, OIL_FILTER, "PRE_OF_1_UNTIGHTENED"})

SAME = 0.01  # within which every joint of a saved pose agrees


def named(joints: Joints, within: float = SAME) -> str | None:
    """The first saved pose all of whose joints are `within` of `joints`."""
    for name, pose in POSES.items():
        if all(abs(a - b) <= within for a, b in zip(joints, pose, strict=True)):
            return name
    return None
