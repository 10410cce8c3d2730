# Every name here is an annotation that `make_idl_struct` reads, so none has a static type worth telling.
class _Parametrised(type):
    def __getitem__(cls, parameters: object) -> object: ...

class array(metaclass=_Parametrised):
    subtype: object
    length: int

class sequence(metaclass=_Parametrised):
    subtype: object
    max_length: int | None

class bounded_str(metaclass=_Parametrised):
    max_length: int

int8: object
int16: object
int32: object
int64: object
uint8: object
uint16: object
uint32: object
uint64: object
float32: object
float64: object
