# Every name here is an annotation that `make_idl_struct` reads, so none has a static type worth telling.
class _Parametrised:
    def __getitem__(self, parameters: object) -> object: ...

array: _Parametrised
sequence: _Parametrised
bounded_str: _Parametrised
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
