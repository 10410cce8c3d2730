"""All that the advisor's process can be asked, and what it answers."""

from __future__ import annotations

from sequence_planner.planning.advice.offer import Advice
from sequence_planner.planning.advice.request import AdviceRequest, ErrandRequest
from sequence_planner.planning.plan import PlanAnswer, PlanRequest
from sequence_planner.planning.reasons.diagnosis import Diagnosis, DiagnosisRequest

Request = AdviceRequest | ErrandRequest | PlanRequest | DiagnosisRequest
Answer = Advice | PlanAnswer | Diagnosis
