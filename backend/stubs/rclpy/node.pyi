from collections.abc import Callable

from rclpy.context import Context
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

class Node:
    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
    ) -> None: ...
    def create_publisher(self, msg_type: type, topic: str, qos_profile: QoSProfile) -> Publisher: ...
    # With `raw`, the callback gets CDR bytes.
    def create_subscription(
        self, msg_type: type, topic: str, callback: Callable[[bytes], None], qos_profile: QoSProfile, *, raw: bool
    ) -> Subscription: ...
    def get_topic_names_and_types(self, no_demangle: bool = False) -> list[tuple[str, list[str]]]: ...
    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]: ...
    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]: ...
    def destroy_node(self) -> None: ...
