from collections.abc import Mapping
from typing import ClassVar

from cyclonedds.idl import types as types

class IdlStruct:
    __idl__: ClassVar[object]
    __idl_typename__: ClassVar[str]
    def __init_subclass__(cls, typename: str | None = None) -> None: ...
    def __init__(self, **fields: object) -> None: ...
    def serialize(self, *, use_version_2: bool | None = None) -> bytes: ...

def make_idl_struct(
    class_name: str, typename: str, fields: Mapping[str, object], *, dataclassify: bool = True
) -> type[IdlStruct]: ...
