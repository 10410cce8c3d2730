from typing import TypeVar

class BasePolicy: ...

_P = TypeVar("_P", bound=BasePolicy)

class Policy:
    class Reliability:
        BestEffort: BasePolicy

        class Reliable(BasePolicy):
            def __init__(self, max_blocking_time: int) -> None: ...

    class Durability:
        Volatile: BasePolicy
        TransientLocal: BasePolicy

    class History:
        KeepAll: BasePolicy

        class KeepLast(BasePolicy):
            def __init__(self, depth: int) -> None: ...

    class DurabilityService(BasePolicy):
        def __init__(
            self,
            cleanup_delay: int,
            history: BasePolicy,
            max_samples: int,
            max_instances: int,
            max_samples_per_instance: int,
        ) -> None: ...

    class WriterDataLifecycle(BasePolicy):
        def __init__(self, autodispose: bool) -> None: ...

    class DataRepresentation(BasePolicy):
        def __init__(self, use_cdrv0_representation: bool = False, use_xcdrv2_representation: bool = False) -> None: ...

    class Deadline(BasePolicy):
        deadline: int
        def __init__(self, deadline: int) -> None: ...

    class Liveliness:
        class Automatic(BasePolicy):
            lease_duration: int
            def __init__(self, lease_duration: int) -> None: ...

    class Userdata(BasePolicy):
        data: bytes
        def __init__(self, data: bytes) -> None: ...

class Qos:
    def __init__(self, *policies: BasePolicy) -> None: ...
    def __contains__(self, policy: BasePolicy | type[BasePolicy]) -> bool: ...
    def __getitem__(self, policy: type[_P]) -> _P: ...
