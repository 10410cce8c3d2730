from ctypes import CDLL

class SampleInfo:
    instance_state: int
    valid_data: bool
    source_timestamp: int
    publication_handle: int

class InvalidSample:
    sample_info: SampleInfo

class CountedStatus:
    total_count: int
    total_count_change: int

class IncompatibleQosStatus(CountedStatus):
    last_policy_id: int

class LivelinessChangedStatus:
    not_alive_count: int
    not_alive_count_change: int

def load_cyclonedds() -> CDLL: ...
