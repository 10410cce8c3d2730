"""The example stations, as they are chosen and begun with."""
