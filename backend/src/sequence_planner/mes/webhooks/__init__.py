"""Events of orders, delivered to other systems at least once: signed, to hosts on a list, until they are taken."""
