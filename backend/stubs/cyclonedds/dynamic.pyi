from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct

class TypeIdentifier: ...

# Asks the network, without the interpreter's lock; `timeout` in ns.
def get_types_for_typeid(
    participant: DomainParticipant, type_id: TypeIdentifier, timeout: int
) -> tuple[type[IdlStruct], dict[str, type]]: ...
