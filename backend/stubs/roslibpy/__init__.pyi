from collections.abc import Mapping

class Message:
    def __init__(self, values: Mapping[str, object] | None = None) -> None: ...
