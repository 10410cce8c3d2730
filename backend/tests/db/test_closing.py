"""The end of a database's connections."""

from __future__ import annotations

import gc
import warnings

import pytest
from sqlalchemy import text

from sequence_planner.db.database import Database


def test_a_connection_that_is_in_use_ends_when_it_is_given_back(database_url: str) -> None:
    database = Database.open(database_url)
    with database.reading() as connection:
        driver = connection.connection.driver_connection
        assert driver is not None
        database.close()
        assert connection.execute(text("SELECT 1")).scalar_one() == 1, "what has begun goes on to its end"
    with pytest.raises(Exception, match="closed"):
        driver.cursor()
    del connection, driver
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        gc.collect()


def test_a_database_that_was_closed_can_be_used_again(database_url: str) -> None:
    database = Database.open(database_url)
    database.close()
    for _ in range(2):
        with database.reading() as connection:
            used = connection.connection.driver_connection
    with database.reading() as connection:
        assert connection.connection.driver_connection is used, "connections are kept again"
    database.close()
