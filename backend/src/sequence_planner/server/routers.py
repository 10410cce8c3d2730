"""The routes of the REST interface and the streams, in the order of its document."""

from __future__ import annotations

from typing import Final

from sequence_planner.server import openapi_document
from sequence_planner.server.api import (
    declared,
    history,
    job_orders,
    model,
    revisions,
    session,
    station,
    storage,
    users,
    watches,
    webhooks,
    what_if,
)
from sequence_planner.server.api.drafting import attachments, outlines, talk
from sequence_planner.server.stream import endpoints

ROUTERS: Final = (
    session.session_router,
    session.provider_router,
    station.router,
    station.instructions_router,
    declared.router,
    attachments.attachments_router,
    station.ros_router,
    endpoints.stream_router,
    users.people_router,
    users.people_bodiless,
    users.keys_router,
    users.keys_bodiless,
    watches.router,
    endpoints.watch_stream_router,
    job_orders.order_of_work_router,
    webhooks.router,
    webhooks.bodiless,
    storage.backups_router,
    storage.backups_bodiless,
    storage.storage_router,
    storage.storage_bodiless,
    history.audit_router,
    history.history_router,
    job_orders.job_orders_router,
    job_orders.job_orders_bodiless,
    job_orders.job_responses_router,
    history.events_router,
    job_orders.capabilities_router,
    model.model_router,
    model.examples_router,
    outlines.router,
    talk.router,
    model.language_router,
    model.draft_pipelines_router,
    revisions.router,
    what_if.router,
    what_if.recordings_router,
    openapi_document.router,
)
