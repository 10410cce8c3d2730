class SampleInfo:
    instance_state: int
    valid_data: bool
    source_timestamp: int
    publication_handle: int

class InvalidSample:
    sample_info: SampleInfo
