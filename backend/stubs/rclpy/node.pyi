# Made by make_rclpy.py from tests/ros/jazzy/rclpy.json.
from collections.abc import Callable
from typing import Any

from rclpy.client import Client
from rclpy.context import Context
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

class Node:
    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = ...,
        cli_args: list[str] | None = ...,
        namespace: str | None = ...,
        use_global_arguments: bool = ...,
        enable_rosout: bool = ...,
        start_parameter_services: bool = ...,
        parameter_overrides: list[Any] | None = ...,
        allow_undeclared_parameters: bool = ...,
        automatically_declare_parameters_from_overrides: bool = ...,
        enable_logger_service: bool = ...,
    ) -> None: ...
    def create_client(
        self, srv_type: Any, srv_name: str, *, qos_profile: QoSProfile = ..., callback_group: Any | None = ...
    ) -> Client: ...
    def create_publisher(
        self,
        msg_type: type,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: Any | None = ...,
        event_callbacks: PublisherEventCallbacks | None = ...,
        qos_overriding_options: Any | None = ...,
        publisher_class: type[Publisher] = ...,
    ) -> Publisher: ...
    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = ...,
        callback_group: Any | None = ...,
    ) -> Service: ...
    def create_subscription(
        self,
        msg_type: type,
        topic: str,
        callback: Callable[[Any], None],
        qos_profile: QoSProfile | int,
        *,
        callback_group: Any | None = ...,
        event_callbacks: SubscriptionEventCallbacks | None = ...,
        qos_overriding_options: Any | None = ...,
        raw: bool = ...,
    ) -> Subscription: ...
    def destroy_node(self) -> None: ...
    def get_name(self) -> str: ...
    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = ...) -> list[TopicEndpointInfo]: ...
    def get_service_names_and_types(self) -> list[tuple[str, list[str]]]: ...
    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = ...) -> list[TopicEndpointInfo]: ...
    def get_topic_names_and_types(self, no_demangle: bool = ...) -> list[tuple[str, list[str]]]: ...
