"""What a file and the environment tell `run`, which comes before which, and what is said of mistakes."""

from __future__ import annotations

import inspect
from importlib.metadata import version
from pathlib import Path

import pytest

from sequence_planner import launcher
from sequence_planner.cli.station.run import run
from sequence_planner.core.logging import LogFormat
from sequence_planner.launcher import Launch
from sequence_planner.settings import Configuration
from support.commands import as_json, command
from support.places import CELL

SECRET = "postgresql://press:s3cret@127.0.0.1/press"
SECRETS = (SECRET, "postgresql://press@127.0.0.1/press?password=s3cret")  # both are ways that PostgreSQL knows


@pytest.fixture
def launched(monkeypatch: pytest.MonkeyPatch) -> list[Launch]:
    """What would be run, once all that was told is put together; nothing is."""
    found: list[Launch] = []

    def note(request: Launch) -> int:
        found.append(request)
        return 0

    monkeypatch.setattr(launcher, "launch", note)
    return found


def written(folder: Path, text: str, mode: int = 0o644) -> Path:
    file = folder / "station.toml"
    file.write_text(text, encoding="utf-8")
    file.chmod(mode)
    return file


def test_it_has_all_that_the_command_line_has() -> None:
    # That a new station is meant is said once, by a person, and never by a file that stays.
    parameters = set(inspect.signature(run).parameters) - {"context", "configuration", "new"}
    assert parameters == set(Configuration.model_fields)


def test_the_command_line_comes_before_the_environment_and_that_before_the_file(
    tmp_path: Path, launched: list[Launch], monkeypatch: pytest.MonkeyPatch
) -> None:
    file = written(
        tmp_path,
        f'model = "{CELL}"\nport = 8001\nname = ["a.example"]\n'
        'emulator = true\nemulator_speed = 2\nlog_format = "json"\n',
    )
    monkeypatch.setenv("SEQUENCE_PLANNER_PORT", "8002")
    monkeypatch.setenv("SEQUENCE_PLANNER_NAME", "b.example c.example:8443")
    monkeypatch.setenv("SEQUENCE_PLANNER_START", "true")
    assert command("run", "--configuration", file) == (0, "", "")
    assert command("run", "--configuration", file, "--port", 8003, "--name", "d.example") == (0, "", "")
    monkeypatch.setenv("SEQUENCE_PLANNER_CONFIGURATION", str(file))
    assert command("run") == (0, "", "")
    first, second, third = launched
    assert (first.endpoint.port, first.endpoint.names) == (8002, ("b.example", "c.example:8443"))
    assert (second.endpoint.port, second.endpoint.names) == (8003, ("d.example",))
    assert (first.model, first.emulator, first.start, first.emulator_speed) == (CELL, True, True, 2.0)
    assert first.log_format is LogFormat.JSON
    assert first.endpoint.host == "127.0.0.1"  # told nowhere
    assert third == first


def test_paths_are_seen_from_the_file(tmp_path: Path, launched: list[Launch]) -> None:
    (tmp_path / "model").symlink_to(CELL)
    (tmp_path / "url").write_text(f"{SECRET}\n", encoding="utf-8")
    file = written(tmp_path, 'model = "model"\ndatabase_file = "url"\ncertificate = "a.pem"\nprivate_key = "/b.pem"\n')
    assert command("run", "--configuration", file) == (0, "", "")
    (request,) = launched
    assert (request.model, request.database) == (tmp_path / "model", SECRET)
    assert request.endpoint.certificate == tmp_path / "a.pem"
    assert request.endpoint.private_key == Path("/b.pem")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("host = 'localhost'\nprot = 8443\n", "2: there is no setting `prot`; did you mean `port`?"),
        ("\n\nport = 70000\n", "3: `port` is not as it must be: expected a number of at most 65535"),
        ("port = '8443'\n", "1: `port` is not as it must be: expected an integer"),
        ("name = 'station.example'\n", "1: `name` is not as it must be: expected a list"),
        ("emulator = 1\n", "1: `emulator` is not as it must be"),
        (
            "transport = 'zenoh'\n",
            "1: `transport` is not as it must be: expected `auto`, `rclpy` or `cyclonedds`",
        ),
        ("[server]\nport = 1\n", "1: there is no setting `server`"),
        ("port = \n", "this is no TOML"),
    ],
)
def test_a_mistake_in_a_file_is_told_with_its_line(tmp_path: Path, text: str, said: str) -> None:
    file = written(tmp_path, text)
    for arguments in (("configuration", "check", file), ("run", CELL, "--configuration", file)):
        code, out, err = command(*arguments)
        assert (code, out) == (2, "")
        assert f"{file}:" in err
        assert said in err


@pytest.mark.parametrize(
    ("variable", "value", "said"),
    [
        ("SEQUENCE_PLANNER_PROT", "1", "there is no such variable; did you mean `SEQUENCE_PLANNER_PORT`?"),
        ("SEQUENCE_PLANNER_PORT", "high", "`port` is not as it must be: expected an integer"),
        ("SEQUENCE_PLANNER_DEMONSTRATION", "perhaps", "`demonstration` is not as it must be"),
    ],
)
def test_a_mistake_in_the_environment_is_told_with_its_variable(
    variable: str, value: str, said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(variable, value)
    code, _, err = command("run", CELL)
    assert code == 2
    assert err.startswith(f"{variable}: ")
    assert said in err


def test_all_mistakes_are_told_at_once(tmp_path: Path) -> None:
    code, _, err = command("configuration", "check", written(tmp_path, "port = 0\nhots = 'a'\nstart = 'no'\n"))
    assert code == 2
    assert len(err.splitlines()) == 3


@pytest.mark.parametrize("secret", SECRETS)
def test_a_password_comes_from_no_command_line_and_no_file_that_others_read(
    tmp_path: Path, launched: list[Launch], monkeypatch: pytest.MonkeyPatch, secret: str
) -> None:
    code, _, err = command("run", CELL, "--database", secret)
    assert (code, "command line" in err, "s3cret" in err) == (2, True, False)
    open_to_all = written(tmp_path, f'database = "{secret}"\n')
    code, _, err = command("run", CELL, "--configuration", open_to_all)
    assert (code, f"chmod 600 {open_to_all}" in err, "s3cret" in err) == (2, True, False)
    closed = written(tmp_path, f'database = "{secret}"\n', mode=0o600)
    assert command("run", CELL, "--configuration", closed)[0] == 0
    monkeypatch.setenv("SEQUENCE_PLANNER_DATABASE", secret)
    assert command("run", CELL)[0] == 0
    assert [each.database for each in launched] == [secret, secret]
    code, _, err = command("run", CELL, "--database-file", closed)
    assert (code, "named twice" in err) == (2, True)


@pytest.mark.parametrize("secret", SECRETS)
def test_what_is_told_is_shown_without_passwords(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, secret: str) -> None:
    file = written(tmp_path, f'port = 8001\nhost = "::"\ndatabase = "{secret}"\n', mode=0o600)
    monkeypatch.setenv("SEQUENCE_PLANNER_PORT", "8002")
    code, out, err = command("configuration", "show", file)
    assert (code, err) == (0, "")
    assert f'host = "::"  # {file}:2\n' in out
    assert 'port = "8002"  # SEQUENCE_PLANNER_PORT\n' in out
    assert "press:***@127.0.0.1" in out
    assert "s3cret" not in out
    _, document = as_json("configuration", "show", file)
    assert document["host"] == {"value": '"::"', "where": f"{file}:2"}
    code, out, err = command("configuration", "check", file)  # no server is there
    assert (code, out) == (2, "")
    without_https, without_name, without_server = err.splitlines()
    assert without_https.startswith(f"{file}:2: cannot serve on :: without HTTPS")
    assert without_name.startswith(f"{file}: use `name` with the host name")
    assert without_server.startswith(f"{file}:3: ")
    assert "s3cret" not in err


def test_a_check_looks_whether_what_is_named_is_there_and_fit(tmp_path: Path) -> None:
    """The file as it stands in the documentation, on a machine where nothing of it is there."""
    (tmp_path / "empty").write_text("", encoding="utf-8")
    file = written(
        tmp_path,
        'model = "missing"\ncertificate = "press.pem"\nprivate_key = "press.key"\ndatabase_file = "url"\n'
        'oidc_client_secret_file = "empty"\nbackup_folder = "backups"\narchive_folder = "old"\n',
    )
    code, out, err = command("configuration", "check", file)
    assert (code, out) == (2, "")
    assert err.splitlines() == [
        f"{file}:1: {tmp_path}/missing/station.yaml:1:1: a station is a folder with a station.yaml: there is none here",
        f"{file}:2: {tmp_path}/press.pem cannot be read: No such file or directory; use `certificate`",
        f"{file}:3: {tmp_path}/press.key cannot be read: No such file or directory; use `private_key`",
        f"{file}:4: {tmp_path}/url cannot be read: No such file or directory",
        f"{file}:5: {tmp_path}/empty is empty: write the secret there",
        f"{file}:6: {tmp_path}/backups cannot hold backups: there is no folder {tmp_path}/backups",
        f"{file}:7: {tmp_path}/old cannot hold the archive: there is no folder {tmp_path}/old",
    ]


def test_a_check_of_a_database_makes_none(tmp_path: Path) -> None:
    file = written(tmp_path, f'model = "{CELL}"\ndatabase = "sqlite:///{tmp_path}/station.sqlite"\n')
    assert command("configuration", "check", file) == (0, f"{file} can be used: model, database\n", "")
    assert not (tmp_path / "station.sqlite").exists()
    (tmp_path / "station.sqlite").write_text("no database", encoding="utf-8")
    code, _, err = command("configuration", "check", file)
    assert (code, err.startswith(f"{file}:2: ")) == (2, True)
    assert "station.sqlite" in err


def test_one_half_of_https_is_not_enough(tmp_path: Path) -> None:
    file = written(tmp_path, 'private_key = "press.key"\n')
    assert command("configuration", "check", file)[2] == (
        f"{file}:1: `certificate` and `private_key` belong together: give both, or none\n"
    )


def test_all_that_is_wrong_is_told_at_once(tmp_path: Path) -> None:
    file = written(
        tmp_path,
        'hots = "::1"\nhost = "press"\nport = "high"\nname = ["a b", "press.example"]\ncertificate = "press.pem"\n',
    )
    code, out, err = command("configuration", "check", file)
    assert (code, out) == (2, "")
    assert err.splitlines() == [
        f"{file}:1: there is no setting `hots`; did you mean `host`?",
        f"{file}:3: `port` is not as it must be: expected an integer",
        f"{file}:2: 'press' is no address; use `host` with localhost or one of this machine",
        f"{file}:4: 'a b' is no name; use `name` with what people open, such as station.example:8443",
        f"{file}:5: `certificate` and `private_key` belong together: give both, or none",
    ]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("start = true\n", ["1: `start` is for emulated devices"]),
        ("demonstration = true\n", ["1: `demonstration` is for emulated devices"]),
        (
            'emulator = true\ndemonstration = true\ndatabase = "sqlite:////a/b.sqlite"\n',
            ["2: `demonstration` has a database of its own", "3: /a/b.sqlite cannot be made"],
        ),
        (
            'emulator = true\ndemonstration = true\nhost = "0.0.0.0"\nproxy = ["10.0.0.1"]\nname = ["a.example"]\n',
            ["2: `demonstration` is for this machine alone"],
        ),
        ('hot_standby = "press a"\n', ["1: `hot_standby` takes a name"]),
        (
            'hot_standby = "a"\ndatabase = "sqlite:////b.sqlite"\n',
            ["1: several stations cannot share /b.sqlite"],
        ),
        ('\noidc_client = "x"\n', ["2: `oidc_issuer` is missing"]),
        ('oidc_issuer = "https://a.example"\noidc_client = "x"\n', ["1: nobody of the provider could sign in"]),
        (
            'oidc_issuer = "https://a.example"\noidc_client = "x"\noidc_role = ["boss=all"]\n',
            ["3: 'boss=all' says no role of a group"],
        ),
        (
            'webhook_network = ["10.1.2.0/24", "10.1.2.3/24", "x"]\nwebhook_host = ["https://mes.example/"]\n',
            ["2: `webhook_host`: ", "1: `webhook_network`: '10.1.2.3/24' is no", "1: `webhook_network`: 'x' is no"],
        ),
    ],
)
def test_what_does_not_go_together_is_told_before_it_is_run(tmp_path: Path, text: str, said: list[str]) -> None:
    file = written(tmp_path, text)
    code, out, err = command("configuration", "check", file)
    assert (code, out) == (2, "")
    lines = err.splitlines()
    assert [line.startswith(f"{file}:{each}") for line, each in zip(lines, said, strict=True)] == [True] * len(said), (
        err
    )
    assert command("run", CELL, "--configuration", file)[0] == 2


def test_run_calls_what_it_refuses_as_it_was_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = written(tmp_path, f'model = "{CELL}"\ncertificate = "press.pem"\n')
    monkeypatch.setenv("SEQUENCE_PLANNER_PRIVATE_KEY", "press.key")
    monkeypatch.setenv("SEQUENCE_PLANNER_HOST", "press")
    host = ("--host", "elsewhere")
    in_file, by_variable = f"`certificate` ({file}:2)", "SEQUENCE_PLANNER_PRIVATE_KEY"
    unread = "cannot be read: No such file or directory; use"
    files = f"{tmp_path}/press.pem {unread} {in_file}\npress.key {unread} {by_variable}\n"
    by_host = "is no address; use {} with localhost or one of this machine\n"
    told = f"'press' {by_host.format('SEQUENCE_PLANNER_HOST')}{files}"
    typed = f"'elsewhere' {by_host.format('--host')}{files}"
    assert command("run", "--configuration", file) == (2, "", told)
    assert command("run", "--configuration", file, *host) == (2, "", typed)


def test_the_version() -> None:
    assert command("--version") == (0, f"sequence-planner {version('sequence-planner')}\n", "")
