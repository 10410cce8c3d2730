# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
from rclpy.qos import QoSProfile
from rclpy.type_hash import TypeHash

class TopicEndpointInfo:
    def __init__(
        self,
        *,
        endpoint_gid: list[int] = ...,
        node_name: str = ...,
        node_namespace: str = ...,
        qos_profile: QoSProfile = ...,
        topic_type: str = ...,
        topic_type_hash: TypeHash = ...,
    ) -> None: ...
    endpoint_gid: list[int]
    node_name: str
    node_namespace: str
    qos_profile: QoSProfile
    topic_type: str
    topic_type_hash: TypeHash
