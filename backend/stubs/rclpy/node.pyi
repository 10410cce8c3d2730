from collections.abc import Callable

from rclpy.client import Client
from rclpy.context import Context
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rosidl_runtime_py.utilities import ServiceClass

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
    def create_publisher(
        self, msg_type: type, topic: str, qos_profile: QoSProfile, *, event_callbacks: PublisherEventCallbacks
    ) -> Publisher: ...
    # With `raw`, the callback gets CDR bytes.
    def create_subscription(
        self,
        msg_type: type,
        topic: str,
        callback: Callable[[bytes], None],
        qos_profile: QoSProfile,
        *,
        event_callbacks: SubscriptionEventCallbacks,
        raw: bool,
    ) -> Subscription: ...
    def create_client(self, srv_type: ServiceClass, srv_name: str) -> Client: ...
    def create_service(
        self, srv_type: ServiceClass, srv_name: str, callback: Callable[[object, object], object]
    ) -> Service: ...
    def get_topic_names_and_types(self, no_demangle: bool = False) -> list[tuple[str, list[str]]]: ...
    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]: ...
    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]: ...
    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]: ...
    def destroy_node(self) -> None: ...
