"""All that the planner's process can be asked, and what it answers."""

from __future__ import annotations

from sequence_planner.planning.plan import PlanAnswer, PlanRequest, WayBackAnswer, WayBackRequest
from sequence_planner.planning.reasons.diagnosis import Diagnosis, DiagnosisRequest

Request = PlanRequest | WayBackRequest | DiagnosisRequest
Answer = PlanAnswer | WayBackAnswer | Diagnosis
