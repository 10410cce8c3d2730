"""A process that delivers events from a database, as the server does, until it is killed; see `main`."""

from __future__ import annotations

import asyncio
import sys

from sequence_planner.db.database import Database
from sequence_planner.mes.webhooks.deliveries import Pace
from sequence_planner.mes.webhooks.delivery import Deliverer, Sender
from sequence_planner.mes.webhooks.targets import Targets

if __name__ == "__main__":
    url, host, port = sys.argv[1:]
    targets = Targets(frozenset({(host, int(port))}), loopback=True)
    asyncio.run(Deliverer(Database.open(url), Sender(targets), Pace(first=0.01, longest=0.05, longest_hold=0.05)).run())
