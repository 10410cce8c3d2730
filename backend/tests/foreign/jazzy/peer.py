# mypy: ignore-errors
"""A node of genuine ROS 2, written as its manual teaches; it shares no code with the station.

    python peer.py DOMAIN

It echoes /ping on /pong and /pose/in on /pose/out, keeps "last" on /genuine/latched, and serves /genuine/add and the
action /genuine/fibonacci. Each line of its input is one of these; what comes of it is printed.

    add COUNT                   call /station/add so many times at once
    fibonacci ORDER [cancel]    have /station/fibonacci do it, and cancel it when feedback comes
    graph                       the nodes, and the topics, services and publishers of the node /station
"""

import sys
import threading
import time
from contextlib import suppress

import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import PoseStamped
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String


class Genuine(Node):
    def __init__(self):
        super().__init__("genuine", namespace="/cell")
        self.pong = self.create_publisher(String, "/pong", 10)
        self.create_subscription(String, "/ping", lambda said: self.pong.publish(String(data=said.data * 2)), 10)
        self.pose = self.create_publisher(PoseStamped, "/pose/out", 10)
        self.create_subscription(PoseStamped, "/pose/in", self.turn, 10)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.latched = self.create_publisher(String, "/genuine/latched", latched)
        self.latched.publish(String(data="last"))
        self.create_subscription(String, "/station/latched", lambda said: say("latched", said.data), latched)
        self.create_service(AddTwoInts, "/genuine/add", self.add)
        accept = lambda goal: CancelResponse.ACCEPT  # noqa: E731
        self.server = ActionServer(self, Fibonacci, "/genuine/fibonacci", self.execute, cancel_callback=accept)
        # The default keeps ten answers, and more may come at once.
        self.adder = self.create_client(AddTwoInts, "/station/add", qos_profile=QoSProfile(depth=100))
        self.goals = ActionClient(self, Fibonacci, "/station/fibonacci")

    def turn(self, pose):
        pose.pose.position.x *= -1
        pose.header.frame_id += pose.header.frame_id
        self.pose.publish(pose)

    def add(self, request, response):
        response.sum = request.a + request.b
        return response

    def execute(self, goal):
        feedback = Fibonacci.Feedback(sequence=[0, 1])
        while len(feedback.sequence) < goal.request.order:
            if goal.is_cancel_requested:
                goal.canceled()
                return Fibonacci.Result(sequence=feedback.sequence)
            feedback.sequence.append(feedback.sequence[-1] + feedback.sequence[-2])
            goal.publish_feedback(feedback)
            time.sleep(0.1)
        goal.succeed()
        return Fibonacci.Result(sequence=feedback.sequence)

    def ask(self, count):
        self.adder.wait_for_service(20)
        calls = [self.adder.call_async(AddTwoInts.Request(a=number, b=1)) for number in range(count)]
        until(lambda: all(call.done() for call in calls))
        say("added", [call.result().sum for call in calls])

    def pursue(self, order, cancel):
        self.goals.wait_for_server(20)
        told = []
        sent = self.goals.send_goal_async(
            Fibonacci.Goal(order=order), feedback_callback=lambda each: told.append(list(each.feedback.sequence))
        )
        until(sent.done)
        goal = sent.result()
        result = goal.get_result_async()
        if cancel:
            until(lambda: told)
            cancelled = goal.cancel_goal_async()
            until(cancelled.done)
            say("cancelling", len(cancelled.result().goals_canceling))
        until(result.done)
        names = {GoalStatus.STATUS_SUCCEEDED: "succeeded", GoalStatus.STATUS_CANCELED: "canceled"}
        say("told", bool(told))
        say(names.get(result.result().status, result.result().status), list(result.result().result.sequence))

    def look(self):
        say("nodes", sorted(f"{space.rstrip('/')}/{name}" for name, space in self.get_node_names_and_namespaces()))
        for what in ("publisher", "subscriber", "service", "client"):
            ask = getattr(self, f"get_{what}_names_and_types_by_node")
            try:
                say(what, [f"{name} {types[0]}" for name, types in sorted(ask("station", "/"))])
            except Exception as error:
                say(what, type(error).__name__)
        for info in self.get_publishers_info_by_topic("/ping"):
            say("hash", info.topic_type_hash)


def say(*what):
    print(*what, flush=True)


def until(holds):
    deadline = time.monotonic() + 30
    while not holds():
        if time.monotonic() > deadline:
            say("never")
            return
        time.sleep(0.01)


def main():
    rclpy.init(domain_id=int(sys.argv[1]))
    node = Genuine()
    executor = MultiThreadedExecutor(4)
    executor.add_node(node)

    def spin():
        with suppress(ExternalShutdownException):
            executor.spin()

    spinning = threading.Thread(target=spin)
    spinning.start()
    say("ready")
    for line in sys.stdin:
        match line.split():
            case ["add", count]:
                node.ask(int(count))
            case ["fibonacci", order, *cancel]:
                node.pursue(int(order), bool(cancel))
            case ["graph"]:
                node.look()
    rclpy.shutdown()
    spinning.join()


main()
