"""`language-server`: the documents of stations in any editor that speaks the Language Server Protocol."""

from __future__ import annotations

import logging
import sys
from typing import NoReturn

from sequence_planner.process.gc_tuning import collection_put_off


def language_server() -> NoReturn:
    """Serve editors that speak the Language Server Protocol, over standard input and output.

    An editor starts it by itself (docs/editors.md). What there is to log goes to standard error.

    Exit codes: 0 after a shutdown, else 1.
    """
    logging.basicConfig(stream=sys.stderr, level=logging.WARNING, format="%(asctime)s %(levelname)s %(message)s")
    with collection_put_off():  # all that is imported stays
        from sequence_planner.language_server.serving import serve_editor  # noqa: PLC0415

    sys.exit(serve_editor())
