from collections.abc import Callable

class RequestHeader: ...

class Service:
    # A method, which the executor calls with what the callback returned and the request's header.
    send_response: Callable[[object, RequestHeader], None]
