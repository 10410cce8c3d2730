"""From messages to variables and back, in typed stages.

A topic's pipeline is made once, when the station is loaded (`building`), and every type error is found then. Reading
and writing (`stages`, `pipeline`) are then total: a message that means nothing to the model makes variables unknown,
and says why. Each stage can also be read backwards, which is what a device, or an emulated one, does.
"""
