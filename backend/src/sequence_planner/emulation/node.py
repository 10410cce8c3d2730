"""How emulated devices are known on the network; by itself, as the controller needs no more of them."""

from __future__ import annotations

from typing import Final

NODE: Final = "emulated_devices"
