class TypeHash:
    version: int
    value: bytes
