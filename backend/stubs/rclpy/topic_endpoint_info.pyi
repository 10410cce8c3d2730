from rclpy.qos import QoSProfile
from rclpy.type_hash import TypeHash

class TopicEndpointInfo:
    node_name: str
    node_namespace: str
    topic_type: str
    topic_type_hash: TypeHash
    endpoint_gid: list[int]
    qos_profile: QoSProfile
