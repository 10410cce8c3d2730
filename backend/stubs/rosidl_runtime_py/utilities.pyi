from typing import Protocol

def get_message(identifier: str) -> type: ...

class ServiceClass(Protocol):
    Request: type
    Response: type

class ActionImplementation:
    SendGoalService: ServiceClass
    GetResultService: ServiceClass
    FeedbackMessage: type

class ActionClass:
    Impl: ActionImplementation

def get_service(identifier: str) -> ServiceClass: ...
def get_action(identifier: str) -> ActionClass: ...
