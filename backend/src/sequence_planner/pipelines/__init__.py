"""From messages to variables and back: a typed graph of topics, flows, stages and variables.

The graph is made once, when the station is loaded (`builder`, from `model.documents`), and every error of
types is found then. Its description (`graph`) is immutable; `runtime` carries incoming messages through it, and
makes messages of the state. Running is total: a message that means nothing to the model makes variables unknown,
and says why. Each stage (`model.stages`) can also be read backwards, which is what a simulated device does. `examples`
are the tests of a station's pipelines, in time that is only told.
"""
